"""Elementary functions against numpy's, as floats and in lanes."""

from __future__ import annotations

import numpy as np
import pytest

from sim.core.compiled import doubles, jit
from sim.core.elementary import exponential, hyperbolic_tangent, logarithm, ninth_root_power, sine_cosine
from sim.core.lanes import WIDTH, as_lanes

COUNT = 4000


@jit
def one_by_one(x, out):
    for i in range(x.shape[0]):
        s, c = sine_cosine(x[i])
        out[0, i] = s
        out[1, i] = c
        out[2, i] = exponential(x[i])
        out[3, i] = hyperbolic_tangent(x[i])
        out[4, i] = logarithm(x[i] * x[i] + 1e-9)
        out[5, i] = ninth_root_power(x[i] * x[i] + 1e-9)


@jit
def side_by_side(x, out, n):
    p = as_lanes(doubles(x.ctypes.data))
    q = as_lanes(doubles(out.ctypes.data))
    for i in range(n):
        s, c = sine_cosine(p[i])
        q[i] = s
        q[n + i] = c
        q[2 * n + i] = exponential(p[i])
        q[3 * n + i] = hyperbolic_tangent(p[i])
        q[4 * n + i] = logarithm(p[i] * p[i] + 1e-9)
        q[5 * n + i] = ninth_root_power(p[i] * p[i] + 1e-9)


def expected(x):
    a = x * x + 1e-9
    return np.array([np.sin(x), np.cos(x), np.exp(x), np.tanh(x), np.log(a), a ** (10 / 9)])


@pytest.mark.parametrize("reach", [1e-6, 0.5, 4.0, 100.0])
def test_against_numpy(reach):
    x = np.random.default_rng(1).uniform(-reach, reach, COUNT)
    out = np.zeros((6, COUNT))
    one_by_one(x, out)
    wanted = expected(x)
    absolute = np.abs(out - wanted)
    assert absolute[:2].max() < 4e-16 + 2.3e-16 * reach  # the angle's own rounding
    assert (absolute[2] / wanted[2]).max() < 1e-15 * max(1.0, reach / 8)
    assert absolute[3].max() < 4e-16
    assert (absolute[4] / np.maximum(np.abs(wanted[4]), 0.1)).max() < 1e-14
    assert (absolute[5] / wanted[5]).max() < 1e-14


def test_lanes_equal_floats():
    x = np.random.default_rng(2).uniform(-30, 30, COUNT)
    single, wide = np.zeros((6, COUNT)), np.zeros((6 * COUNT // WIDTH, WIDTH))
    one_by_one(x, single)
    side_by_side(np.ascontiguousarray(x.reshape(-1, WIDTH)), wide, COUNT // WIDTH)
    np.testing.assert_allclose(wide.reshape(6, COUNT), single, rtol=2e-15, atol=4e-16)


def test_sine_and_cosine_of_quarters():
    x = np.arange(-8, 9) * np.pi / 2
    out = np.zeros((6, x.size))
    one_by_one(x, out)
    np.testing.assert_allclose(out[0], np.sin(x), atol=1e-15)
    np.testing.assert_allclose(out[1], np.cos(x), atol=1e-15)


def test_exponential_at_its_limits():
    x = np.array([-1e4, -708.0, 0.0, 709.0, 1e4])
    out = np.zeros((6, x.size))
    one_by_one(x, out)
    assert np.all(np.isfinite(out[2]))
    assert out[2, 2] == 1.0
    assert out[3, 0] == -1.0
    assert out[3, -1] == 1.0


def test_not_a_number_stays_visible():
    x = np.array([np.nan, np.inf])
    out = np.zeros((6, 2))
    one_by_one(x, out)
    assert np.isnan(out[0, 0])
    assert np.isnan(out[3, 0])
