"""Speed over time: exact integrals, the compiled curve equals the array one, profiles of the specification."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from sim.core.compiled import doubles, jit
from sim.core.spec import FluctuatingSpeed, MeasuredSpeed, RampSpeed
from sim.core.speed import mean_ratio, speed_table, warped, warped_times

RATIOS = st.lists(st.floats(0.0, 5.0), min_size=2, max_size=12)


@jit
def compiled(table, t):
    return warped(doubles(table.ctypes.data), t)


def curve(ratios, step, t):
    return np.interp(t, np.arange(len(ratios)) * step, ratios)


@pytest.mark.slow
@given(RATIOS, st.floats(0.01, 2.0), st.floats(0.0, 30.0))
@settings(max_examples=150, deadline=None)
def test_angle_is_the_integral_of_the_speed(ratios, step, t):
    table = speed_table(MeasuredSpeed(step_s=step, ratios=tuple(ratios)))
    gone, rate = (float(v) for v in compiled(table, t))
    knots = [k * step for k in range(len(ratios)) if k * step < t]
    pieces = [quad(lambda s: curve(ratios, step, s), a, b)[0] for a, b in zip(knots, [*knots, t][1:], strict=True)]
    assert gone == pytest.approx(sum(pieces), rel=1e-9, abs=1e-9)
    assert rate == pytest.approx(curve(ratios, step, t), rel=1e-9, abs=1e-9)
    arrays = warped_times(table, np.array([t]))
    assert (arrays[0][0], arrays[1][0]) == pytest.approx((gone, rate), rel=1e-13)


def test_constant_speed_is_time_itself():
    table = speed_table(None)
    assert compiled(table, 1.234) == (1.234, 1.0)
    assert mean_ratio(table, 0.0, 3.0) == 1.0


def test_ramp_ends_and_stays():
    table = speed_table(RampSpeed(start_ratio=1.0, end_ratio=0.4, duration_s=2.0))
    assert compiled(table, 1.0) == pytest.approx((0.85, 0.7))
    assert compiled(table, 5.0) == pytest.approx((1.4 + 3.0 * 0.4, 0.4))
    assert mean_ratio(table, 0.0, 2.0) == pytest.approx(0.7)


def test_sine_has_its_amplitude_and_frequency():
    table = speed_table(FluctuatingSpeed(amplitude=0.03, frequency_hz=4.0))
    t = np.linspace(0.0, 10.0, 5001)
    gone, rate = warped_times(table, t)
    np.testing.assert_allclose(rate, 1.0 + 0.03 * np.sin(8.0 * np.pi * t), atol=0.03 * 2e-4)
    exact = t + 0.03 / (8.0 * np.pi) * (1.0 - np.cos(8.0 * np.pi * t))
    np.testing.assert_allclose(gone, exact, atol=2e-7)


def test_random_part_has_its_size_and_correlation_and_depends_on_the_seed():
    spec = FluctuatingSpeed(random_rms=0.02, correlation_s=0.5)
    one, other = (speed_table(spec, seed) for seed in (1, 2))
    assert np.array_equal(one, speed_table(spec, 1))
    assert not np.array_equal(one, other)
    t = np.arange(0.0, 64.0, 0.01)
    deviation = warped_times(one, t)[1] - 1.0
    assert deviation.std() == pytest.approx(0.02, rel=0.02)
    lag = 50
    correlation = float(np.mean(deviation[lag:] * deviation[:-lag])) / deviation.var()
    # a spectrum exp(-(w tau)^2 / 2) has the correlation exp(-(t / tau)^2 / 2)
    assert correlation == pytest.approx(np.exp(-0.5), abs=0.15)


def test_the_shaft_never_turns_backwards():
    table = speed_table(FluctuatingSpeed(amplitude=0.5, random_rms=0.2, correlation_s=0.1, frequency_hz=2.0), 3)
    assert np.all(warped_times(table, np.linspace(0, 20, 20001))[1] >= 0.0)
