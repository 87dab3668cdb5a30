"""A tooth whose burst no sideband shows is told with its gear; wander, balls and uneven teeth are none."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.gears import gear_evidence
from reconcile.kinematics.observe import observe
from reconcile.kinematics.tooth_turn import tooth_turn
from tests.reconcile.kinematics.test_wander import turned
from tests.strategies.brief import recorded

TEETH, WHEEL, SPEED_HZ, SECONDS = 23, 81, 30.0, 2.0
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}, {"name": "out"}],
            "gears": [
                {"name": "pinion", "shaft": "shaft", "teeth": TEETH},
                {"name": "gear", "shaft": "out", "teeth": WHEEL},
            ],
            "meshes": [{"name": "mesh1", "gears": ["pinion", "gear"]}],
            "bearings": [{"name": "b", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
TIE = ties(SPEC, "shaft")


def seen(seed: int, label: str, size: float = 0.0, ratio: float = 1.0):  # type: ignore[no-untyped-def]
    """Three mesh lines, noise, and a ring of 3 kHz once in each turn of a shaft of `ratio`, at a third of it."""
    angle = turned(seed, SPEED_HZ, 0.002, SECONDS)
    mesh = sum(a * np.cos(k * TEETH * angle + k) for k, a in ((1, 1.0), (2, 0.5), (3, 0.3)))
    turn = angle * ratio / (2 * np.pi)
    after = (turn - 1.0 / 3.0) % 1.0 / (SPEED_HZ * ratio)
    ring = size * np.exp(-after * 1000.0) * np.sin(2 * np.pi * 3000.0 * after)
    noise = np.random.default_rng(seed).standard_normal((2, angle.size))
    return observe(recorded(list(mesh + ring + 0.3 * noise), SPEED_HZ), TIE, label, stated_hz=None, seed=0)


@pytest.mark.slow
@pytest.mark.parametrize(("gear", "ratio", "size"), [("pinion", 1.0, 0.5), ("gear", TEETH / WHEEL, 1.0)])
def test_a_burst_below_the_floor_of_its_sidebands_is_told(gear: str, ratio: float, size: float) -> None:
    now, before = seen(1, "test", size, ratio), seen(2, "baseline")
    assert not any(g.grown for g in gear_evidence([now], [before], TIE))
    found = tooth_turn([now], [before], TIE)
    assert found is not None and found.gear == gear
    report = reconcile_kinematics(SPEC, [now.recording], [before.recording], seed=0)
    assert report.verdict == "ambiguous" and f"local tooth fault on {gear}" in report.sentence
    assert {c.term for c in report.causes} == {"tooth_crack", "tooth_spall", "missing_tooth"}
    window = report.where.angle_window
    assert window is not None and window.centre_deg == pytest.approx(120.0 + 6.0, abs=10.0)


@pytest.mark.slow
def test_nothing_and_balls_are_no_tooth() -> None:
    before = seen(2, "baseline")
    for k in range(3, 9):
        assert tooth_turn([seen(k, "test")], [before], TIE) is None
    assert tooth_turn([seen(9, "test", 1.0, 3.572)], [before], TIE) is None


@pytest.mark.slow
def test_without_a_baseline_nothing_is_told() -> None:
    assert tooth_turn([seen(1, "test", 0.5)], [], TIE) is None


@pytest.mark.slow
def test_a_burst_that_the_baseline_has_too_is_none() -> None:
    assert tooth_turn([seen(1, "test", 0.5)], [seen(2, "baseline", 0.5)], TIE) is None
