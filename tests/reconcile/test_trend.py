"""Amplitudes of families: lines of known size, defects of one race, and nothing else moving."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec
from reconcile.kinematics.trend import Levels, family_levels
from sim.core.errors import SpecError
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded, sound, train

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "output"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
            "gears": [
                {"name": "pinion", "shaft": "shaft", "teeth": 20},
                {"name": "wheel", "shaft": "output", "teeth": 50},
            ],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "wheel"]}],
        }
    }
)
OUTER, INNER = 3.5848, 5.4152
"""Of a 6205, over the speed of its shaft."""


def values(levels: Levels) -> dict[str, float]:
    return {family.key: family.value for family in levels.families}


@pytest.mark.slow
def test_lines_of_shafts_and_meshes_read_their_rms() -> None:
    t = np.arange(N) / RATE_HZ
    mesh = sum(a * np.sin(2 * np.pi * 20 * k * SPEED_HZ * t) for k, a in ((1, 2.0), (2, 1.0)))
    found = family_levels(SPEC, recorded(sound(3) + mesh))
    kept = values(found)
    assert kept["shaft.shaft"] == pytest.approx(np.sqrt((0.5**2 + 0.3**2 + 0.2**2) / 2), rel=0.02)
    assert kept["mesh1.mesh"] == pytest.approx(np.sqrt((2.0**2 + 1.0**2) / 2), rel=0.02)
    lines = {line.label: line for f in found.families if f.key == "mesh1.mesh" for line in f.lines}
    assert lines["2*f_m"].amplitude == pytest.approx(1 / np.sqrt(2), rel=0.02)
    assert lines["2*f_m"].frequency_hz == pytest.approx(40 * SPEED_HZ, rel=1e-4)
    assert found.speed.speed_hz == pytest.approx(SPEED_HZ, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "order", "load"), [("outer", OUTER, 0.0), ("inner", INNER, 0.6)])
def test_a_defect_raises_its_own_race_and_no_other(kind: str, order: float, load: float) -> None:
    before = values(family_levels(SPEC, recorded(sound(5))))
    fault = train(np.random.default_rng(5), order * 0.992, 1.0, load=load)
    after = values(family_levels(SPEC, recorded(sound(5) + fault)))
    rises = {k: 20 * np.log10(after[f"bearing1.{k}"] / before[f"bearing1.{k}"]) for k in ("outer", "inner", "ball")}
    assert rises.pop(kind) > 12.0
    assert all(abs(rise) < 5.0 for rise in rises.values()), rises
    assert after["shaft.shaft"] == pytest.approx(before["shaft.shaft"], rel=0.01)


@pytest.mark.slow
def test_a_line_beside_a_clearer_one_is_told_as_its_sideband() -> None:
    """Of a 6306, f_i less one shaft order lies within the slip of f_b; a sound bearing has none such."""
    bearing = {"name": "de", "shaft": "shaft", "catalogue": "6306"}
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [bearing]}})
    fault = train(np.random.default_rng(5), 4.426, 1.0, load=0.8, jitter=0.005)
    found = {f.key: f for f in family_levels(spec, recorded(sound(5) + fault)).families}
    assert found["de.ball"].sideband_of == "de.inner" and found["de.inner"].sideband_of is None
    balls = train(np.random.default_rng(5), 3.515, 1.0, jitter=0.005)
    assert {f.sideband_of for f in family_levels(spec, recorded(sound(5) + balls)).families if f.kind == "ball"} == {
        None
    }


@pytest.mark.slow
def test_a_gain_does_not_move_a_bearing_and_moves_a_shaft() -> None:
    one, other = (values(family_levels(SPEC, recorded(gain * sound(2)))) for gain in (1.0, 10.0))
    assert other["bearing1.outer"] == pytest.approx(one["bearing1.outer"], rel=1e-6)
    assert other["shaft.shaft"] == pytest.approx(10 * one["shaft.shaft"], rel=1e-6)


def test_what_cannot_be_done_is_told() -> None:
    with pytest.raises(SpecError, match=r"operating\.shaft"):
        family_levels(SPEC, recorded(sound(1), shaft="nothing"))
