"""Impacts at an order of no part of the drawing are told as such, also where the same order sounds in another band."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import fftconvolve

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
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
