"""Impacts at an order of no part of the drawing are told as such, also where the same order sounds in another band."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import fftconvolve

from reconcile.kinematics import foreign_bands, read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.foreign import Foreign
from reconcile.kinematics.foreign_bands import foreign_in_a_band
from reconcile.kinematics.observe import Observation, observe
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded, shaft_lines

ORDER = 3.58
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "motor", "speed_hz": SPEED_HZ}],
            "bearings": [
                {"name": "drive", "shaft": "motor", "balls": 12, "ball_diameter_m": 0.005, "pitch_diameter_m": 0.06}
            ],
        }
    }
)
"""Of a bearing that is not the machine's: its races have orders 5.5 and 6.5."""
TIE = ties(SPEC, "motor")


def blows(rng: np.random.Generator, height: float, ring_hz: float, turned: float = 0.0) -> np.ndarray:
    """Blows at `ORDER`, each a ring, louder at one angle of the shaft by a share `turned`."""
    period = 1 / (ORDER * SPEED_HZ)
    times = np.cumsum(period * (1 + 0.003 * rng.standard_normal(int(N / RATE_HZ / period) + 10)))
    times = times[times < N / RATE_HZ - 0.02]
    force = np.zeros(N)
    np.add.at(force, (times * RATE_HZ).astype(int), height * (1 + turned * np.cos(2 * np.pi * SPEED_HZ * times)))
    ring = np.arange(int(0.01 * RATE_HZ)) / RATE_HZ
    return fftconvolve(force, np.exp(-ring * 1500) * np.sin(2 * np.pi * ring_hz * ring))[:N]


def machine(seed: int, *, low: float, high: float):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    noise = 0.1 * rng.standard_normal(N)
    made = shaft_lines(rng) + noise + blows(rng, low, 2000.0) + blows(rng, high, 7000.0, turned=0.5)
    return recorded(made, SPEED_HZ, shaft="motor")


@pytest.mark.parametrize("low", [0.0, 0.6])
def test_a_comb_of_no_part_is_told_whatever_band_it_is_firmest_in(low: float) -> None:
    report = reconcile_kinematics(SPEC, [machine(2, low=low, high=0.5)], [machine(1, low=0.8 * low, high=0.0)], seed=0)
    assert report.verdict == "unknown_physics" and "no part of the specification has that order" in report.sentence
    assert report.where.lines[0].frequency_hz == pytest.approx(ORDER * SPEED_HZ, rel=0.003)
    assert report.where.lines[0].label.startswith("1 x order 3.5") and report.where.lines[0].change_db > 10.0


def test_a_comb_of_no_part_that_is_as_deep_in_the_baseline_is_not_told() -> None:
    report = reconcile_kinematics(SPEC, [machine(2, low=0.6, high=0.5)], [machine(1, low=0.6, high=0.5)], seed=0)
    assert report.verdict == "nothing_missing"


@pytest.fixture(scope="module")
def heard_both() -> list[Observation]:
    """A test with a comb that has grown in the upper band, and its baseline."""
    both = ((2, 0.6, 0.5, "test"), (1, 0.6, 0.0, "baseline"))
    return [
        observe(machine(k, low=low, high=high), TIE, name, stated_hz=SPEED_HZ, seed=0) for k, low, high, name in both
    ]


def found_by(both: list[Observation]) -> Foreign | None:
    return foreign_in_a_band(both[0], both[1:], TIE, 0, heard=())


def test_a_band_in_which_a_comb_of_no_part_has_grown_tells_it(heard_both: list[Observation]) -> None:
    found = found_by(heard_both)
    assert found is not None and found.order == pytest.approx(ORDER, rel=0.003)
    assert found.growth_db > 10.0 and found.evidence.z >= 12.0 and found.evidence.depth >= 0.3
    assert foreign_in_a_band(heard_both[0], [], TIE, 0, heard=()) is None


@pytest.mark.parametrize(
    ("growth_db", "depth", "told"), [(10.0, 0.3, True), (9.9, 0.3, False), (10.0, 0.29, False), (None, 0.3, False)]
)
def test_it_must_have_grown_and_be_deep(
    growth_db: float | None, depth: float, told: bool, heard_both: list[Observation], monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = SimpleNamespace(growth_db=growth_db, depth=depth)
    monkeypatch.setattr(foreign_bands, "contrast", lambda *_: seen)
    assert (found_by(heard_both) is not None) is told


@pytest.mark.parametrize(("z", "told"), [(12.0, True), (11.9, False)])
def test_it_must_be_firm_as_a_family_and_in_its_band(
    z: float, told: bool, heard_both: list[Observation], monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = foreign_bands.family_evidence
    with monkeypatch.context() as patch:
        patch.setattr(foreign_bands, "family_evidence", lambda *a: replace(whole(*a), z=z))
        assert (found_by(heard_both) is not None) is told
    firm = foreign_bands.firmness

    def scaled(*given: object) -> tuple[np.ndarray, np.ndarray]:
        base, rows = firm(*given)  # type: ignore[arg-type]
        return base, rows * (z / rows.max(axis=1, keepdims=True))

    monkeypatch.setattr(foreign_bands, "firmness", scaled)
    assert (found_by(heard_both) is not None) is told
