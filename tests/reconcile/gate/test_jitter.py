"""A speed that wanders is no jitter of the pulses; errors of single pulses are, beside a wander too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, lfilter

from reconcile.gate.timing import tacho_findings
from signals.recording import Tacho
from tests.strategies.impulses import recorded

SPEED_HZ, SECONDS, STEPS_HZ = 24.7, 8.0, 4096


def found(seed: int, *, wander: float = 0.0, jitter: float = 0.0, per_turn: int = 1, teeth: float = 0.0, lost=()):  # type: ignore[no-untyped-def]
    """What is told of pulses of a speed that wanders (share of it, RMS), each off by a share of its interval."""
    rng = np.random.default_rng(seed)
    n = int(SECONDS * STEPS_HZ)
    torque = lfilter(*butter(1, 0.8, fs=STEPS_HZ), rng.standard_normal(n))
    turns = np.cumsum(SPEED_HZ * (1 + wander * torque / np.std(torque))) / STEPS_HZ * per_turn
    place = np.arange(1, int(turns[-1]))
    uneven = teeth * rng.standard_normal(per_turn)[place % per_turn]
    times = np.interp(place + uneven, turns, np.arange(n) / STEPS_HZ)
    times = np.delete(times + jitter / SPEED_HZ / per_turn * rng.standard_normal(times.size), lost)
    tacho = Tacho(shaft="shaft", pulse_times_s=times, pulses_per_revolution=per_turn)
    return tacho_findings(replace(recorded(np.zeros((1, 100))), tacho=tacho), "test 1")


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("wander", [0.03, 0.1])
@pytest.mark.parametrize("per_turn", [1, 16])
def test_a_wander_of_the_speed_is_no_jitter(seed: int, wander: float, per_turn: int) -> None:
    assert found(seed, wander=wander, per_turn=per_turn, teeth=0.02 * (per_turn > 1)) == ()


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(("wander", "jitter"), [(0.0, 0.006), (0.0, 0.05), (0.03, 0.015), (0.1, 0.05)])
def test_errors_of_single_pulses_are(seed: int, wander: float, jitter: float) -> None:
    (one,) = found(seed, wander=wander, jitter=jitter)
    said = float(one.detail.split("off by ")[1].split(" %")[0]) / 100
    assert one.kind == "tacho_jitter" and one.fault and said == pytest.approx(jitter, rel=0.4)


def test_missing_pulses_are_told_beside_a_wander_and_no_jitter_is_claimed() -> None:
    (one,) = found(1, wander=0.03, lost=[20, 71])
    assert one.detail == "2 of 191 intervals are of missed or doubled pulses" and one.fault


def test_pulses_of_which_few_are_whole_are_read_one_by_one() -> None:
    (one,) = found(1, jitter=0.05, lost=list(range(3, 190, 3)))
    assert "missed or doubled pulses" in one.detail
