"""The automatic end of the transient."""

from __future__ import annotations

import numpy as np
import pytest

from sim.solve.transient import transient_end_s

RATE, PERIOD = 10_000.0, 0.01


def ringing(decay_s, duration_s=1.0, level=1.0):
    t = np.arange(int(duration_s * RATE)) / RATE
    return (level * np.sin(2 * np.pi * 500 * t) + 20.0 * np.exp(-t / decay_s) * np.sin(2 * np.pi * 800 * t))[None]


def test_a_settled_signal_has_no_transient():
    t = np.arange(10_000) / RATE
    assert transient_end_s(np.sin(2 * np.pi * 500 * t)[None], RATE, PERIOD) == 0.0


@pytest.mark.parametrize("decay_s", [0.01, 0.03])
def test_it_ends_when_the_ringing_is_small(decay_s):
    end = transient_end_s(ringing(decay_s), RATE, PERIOD)
    left = 20.0 * np.exp(-end / decay_s)
    assert left < 1.0, "the transient is over although it is louder than the motion"
    assert end < 8 * decay_s + 0.05


def test_it_grows_with_the_decay():
    ends = [transient_end_s(ringing(d), RATE, PERIOD) for d in (0.01, 0.03, 0.06)]
    assert ends == sorted(ends)
    assert ends[0] < ends[-1]


def test_a_run_too_short_to_judge_is_all_transient():
    assert transient_end_s(np.ones((1, 30)), RATE, PERIOD) == pytest.approx(30 / RATE)


@pytest.mark.parametrize("growth", [3.0, -0.5])
def test_motion_that_keeps_growing_or_decaying_has_not_settled(growth):
    t = np.arange(0, 4.0, 1e-3)
    signal = np.exp(growth * t) * np.sin(2 * np.pi * 50 * t)
    assert transient_end_s(signal[None, :], 1000.0, 0.1) == pytest.approx(4.0)
