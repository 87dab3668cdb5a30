"""A strong new line off the shaft's multiples is told; load, wander, hum and lines of the baseline are none."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.families import ties
from reconcile.kinematics.new_lines import _whose
from reconcile.verdict import Report
from signals.recording import Recording
from signals.series import FloatArray
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)


def turning(seed: int, wander: float = 0.0005) -> FloatArray:
    """Turns of the shaft, (N,), whose speed wanders slowly by that share."""
    slow = gaussian_filter1d(np.random.default_rng(seed + 70).standard_normal(N // 100), 30.0, mode="wrap")
    speed = 1 + wander * np.interp(np.arange(N) / 100, np.arange(slow.size), slow / np.std(slow))
    return np.asarray(np.cumsum(speed) * SPEED_HZ / RATE_HZ, dtype=np.float64)


def made(
    seed: int,
    lines: dict[float, float] | None = None,
    *,
    hz: float = 0.0,
    load: float = 1.0,
    wander: float = 0.0005,
) -> Recording:
    """Lines of the shaft (times `load`) and at further orders, noise, and a tone of `hz`."""
    rng, turns = np.random.default_rng(seed), turning(seed, wander)
    parts = {1.0: 0.5 * load, 2.0: 0.3 * load, 3.0: 0.2 * load} | (lines or {})
    x = 0.3 * rng.standard_normal(N) + sum(a * np.sin(2 * np.pi * order * turns) for order, a in parts.items())
    return recorded(x + (1.5 * np.sin(2 * np.pi * hz * np.arange(N) / RATE_HZ) if hz else 0.0))


def told(test: Recording, base: Recording) -> Report:
    return reconcile_kinematics(SPEC, [test], [base], seed=0)


@pytest.mark.slow
def test_a_whirl_is_told_with_its_order() -> None:
    report = told(made(1, {0.46: 1.0}), made(2))
    assert report.verdict == "unknown_physics" and "Whirl" in report.sentence and "0.46 times" in report.sentence
    (line,) = report.where.lines
    assert abs(line.frequency_hz / (0.46 * SPEED_HZ) - 1) < 0.02


@pytest.mark.slow
def test_a_train_is_told_by_its_lowest_line_and_a_tone_by_its_frequency() -> None:
    report = told(made(3, {0.37: 0.6, 0.74: 1.0}), made(4))
    assert report.verdict == "unknown_physics" and "0.37 times" in report.sentence and "Whirl" not in report.sentence
    assert len(report.where.lines) == 2
    assert "at 407.7 Hz" in told(made(5, hz=407.7), made(6)).sentence


@pytest.mark.slow
@pytest.mark.parametrize(
    ("test", "base"),
    [
        (made(7, load=2.5), made(8)),
        (made(9, wander=0.01), made(10)),
        (made(11, {0.46: 1.0}), made(12, {0.46: 0.3})),
        (made(13, {0.46: 0.05}), made(14)),
    ],
    ids=["load", "wander", "in the baseline too", "weak"],
)
def test_what_is_not_new_or_not_strong_is_none(test: Recording, base: Recording) -> None:
    assert told(test, base).verdict == "nothing_missing"


@pytest.mark.slow
def test_hum_is_left_to_the_gate() -> None:
    assert "is new on" not in told(made(15, hz=150.0), made(16)).sentence


@pytest.mark.slow
@pytest.mark.parametrize(
    ("order", "verdict", "words"),
    [
        (7.0, "unknown_physics", "7 times the speed of shaft, is new on a0"),
        (4.5, "unknown_physics", "Looseness or a rub makes such half multiples"),
        (0.396, "not_decidable", "at the frequency of the cage of bearing1"),
        (3.57, "not_decidable", "at the frequency of the outer race of bearing1"),
        (10.71, "not_decidable", "at 3 times the frequency of the outer race of bearing1"),
    ],
)
def test_a_line_at_a_frequency_of_the_specification_says_whose_it_is(order: float, verdict: str, words: str) -> None:
    report = told(made(7, {order: 1.5}), made(8))
    assert report.verdict == verdict and words in report.sentence
    assert "No part of the specification" not in report.sentence and "Whirl" not in report.sentence


@pytest.mark.slow
def test_lines_of_teeth_are_another_matter() -> None:
    geared = {
        "shafts": [{"name": "in"}, {"name": "out"}],
        "gears": [{"name": "pinion", "shaft": "in", "teeth": 20}, {"name": "wheel", "shaft": "out", "teeth": 50}],
        "meshes": [{"name": "mesh1", "gears": ["pinion", "wheel"]}],
    }
    tie = ties(read_kinematic_spec({"kinematics": geared}))
    assert [_whose(order, 0.01, 1e-3, tie) for order in (20.0, 40.0, 19.0, 21.2, 2.0, 0.8)] == [None] * 6
    assert _whose(9.0, 0.01, 1e-3, tie) == (("in", 9.0), "") and _whose(9.3, 0.01, 1e-3, tie) == (None, "")


@pytest.mark.parametrize(("order", "number"), [(25.0, 25.0), (25.02, 25.0), (25.09, None), (24.91, None)])
def test_a_line_is_told_as_a_multiple_where_it_lies_on_it(order: float, number: float | None) -> None:
    """Seven times the outer race of a bearing that the drawing leaves out lies at 25.09 turns: no vanes make it."""
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "motor", "speed_hz": 29.95}]}})
    whose = _whose(order, 0.005, 0.0005, ties(spec, "motor"))
    assert whose is not None and whose[0] == (None if number is None else ("motor", number))
