"""Quantisation, clipping, and lost samples."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signals.checks import inspect
from signals.recording import Recording
from signals.sensors.converter import Converter, converted
from signals.sensors.dropouts import Dropouts, filled, lost
from sim.core.response import Channel


@pytest.mark.parametrize("bits", [8, 12, 16])
def test_quantisation_noise_is_step_squared_over_twelve(bits: int) -> None:
    x = np.random.default_rng(0).uniform(-0.9, 0.9, 200_000)
    found = converted(x, Converter(bits=bits, range_v=1.0))
    assert found.step_v == 2 / 2**bits
    error = found.volts - x
    assert np.abs(error).max() <= 0.5 * found.step_v * (1 + 1e-9)
    # The fourth moment of a uniform error: the mean of N squares scatters by sqrt(0.8 / N); 4 of them.
    assert np.mean(error**2) == pytest.approx(found.step_v**2 / 12, rel=4 * math.sqrt(0.8 / x.size))


def test_codes_beyond_the_range_are_held_and_counted() -> None:
    found = converted(np.array([-1.2, -1.0, 0.0, 0.99, 1.0, 5.0]), Converter(bits=4, range_v=1.0))
    np.testing.assert_allclose(found.volts, [-1.0, -1.0, 0.0, 0.875, 0.875, 0.875])
    # 0.99 rounds to a code that is not there.
    assert found.clipped == 4


@pytest.mark.slow
@given(bits=st.integers(2, 32), offset=st.floats(-0.5, 0.5), seed=st.integers(0, 50))
def test_every_value_is_on_the_grid(bits: int, offset: float, seed: int) -> None:
    x = np.random.default_rng(seed).standard_normal(200)
    found = converted(x, Converter(bits=bits, range_v=2.0, offset_v=offset))
    codes = found.volts / found.step_v
    assert np.array_equal(codes, np.rint(codes))
    assert codes.min() >= -(2 ** (bits - 1)) and codes.max() <= 2 ** (bits - 1) - 1


def test_clipping_is_found_by_the_checks_of_recordings() -> None:
    x = np.sin(2 * np.pi * 3.1 * np.arange(4000) / 1000)
    volts = converted(x, Converter(bits=16, range_v=0.5)).volts
    channel = Channel(name="a", quantity="acceleration", unit="V", location="")
    findings = inspect(Recording(sampling_rate_hz=1000.0, channels=(channel,), samples=volts[None]))
    assert [f.kind for f in findings] == ["clipping"]


@pytest.mark.slow
def test_the_share_of_random_gaps() -> None:
    spec = Dropouts(rate_per_s=5.0, mean_duration_s=0.02)
    shares = [lost(spec, 100_000, 1000.0, np.random.default_rng(k)).mean() for k in range(40)]
    expected = 1 - math.exp(-5.0 * 0.02)
    # 4000 s with gaps that last 0.02 s: the mean scatters by 1 % of itself.
    assert np.mean(shares) == pytest.approx(expected, rel=0.04)


def test_given_gaps_cover_exactly_their_samples() -> None:
    spec = Dropouts(gaps=[{"start_s": 0.1, "duration_s": 0.05}, {"start_s": 0.9, "duration_s": 5.0}])
    mask = lost(spec, 1000, 1000.0, np.random.default_rng(0))
    assert np.flatnonzero(mask).tolist() == [*range(100, 150), *range(900, 1000)]


def test_fills() -> None:
    x, mask = np.arange(1.0, 7.0), np.array([True, False, True, True, False, True])
    np.testing.assert_array_equal(filled(x, mask, "hold"), [0, 2, 2, 2, 5, 5])
    np.testing.assert_array_equal(filled(x, mask, "zero"), [0, 2, 0, 0, 5, 0])
    np.testing.assert_array_equal(np.isnan(filled(x, mask, "nan")), mask)
