"""Linear stages against their analytic frequency and time responses."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError
from scipy import signal

from signals.sensors.antialias import AntiAlias, through_filter
from signals.sensors.linear import butterworth, high_pass, resonance
from signals.sensors.mounting import Mounting, through_mounting
from signals.sensors.path import MeasuredPath, ModalPath, gain_of, measured_gain, through_path
from signals.sensors.transducer import Transducer, linear_part, sensed
from tests.signals.sensors.motions import RATE_HZ, gain_at, tone

N = 40_000
MODES = {
    "kind": "modes",
    "direct": 0.3,
    "modes": [
        {"frequency_hz": 700.0, "damping_ratio": 0.03, "gain": 0.5},
        {"frequency_hz": 2500.0, "damping_ratio": 0.01, "gain": -0.2},
    ],
}


@pytest.mark.parametrize("frequency", [50.0, 690.0, 700.0, 2500.0, 6000.0])
def test_a_tone_through_modes_has_the_analytic_gain_and_phase(frequency: float) -> None:
    path = ModalPath.model_validate(MODES)
    s = 2j * math.pi * frequency
    expected = 0.3 + 0j
    for f_n, zeta, gain in ((700.0, 0.03, 0.5), (2500.0, 0.01, -0.2)):
        w = 2 * math.pi * f_n
        expected += gain * w**2 / (s**2 + 2 * zeta * w * s + w**2)
    measured = gain_at(through_path(tone(frequency, N), RATE_HZ, path), frequency)
    assert measured == pytest.approx(expected, rel=2e-5)


def test_the_knock_response_of_a_mode_is_the_decaying_sine() -> None:
    f_n, zeta = 400.0, 0.02
    path = ModalPath.model_validate({"modes": [{"frequency_hz": f_n, "damping_ratio": zeta, "gain": 1.0}]})
    # A smooth knock, short against the period: the response behind it is the closed form times its area.
    t = (np.arange(N) - 200) / RATE_HZ
    width = 2e-4
    knock = np.exp(-0.5 * (t / width) ** 2)
    response = through_path(knock, RATE_HZ, path)
    w, wd = 2 * math.pi * f_n, 2 * math.pi * f_n * math.sqrt(1 - zeta**2)
    pole = -zeta * w + 1j * wd
    area = width * math.sqrt(2 * math.pi) * np.exp(0.5 * (pole * width) ** 2)
    behind = t > 3e-3
    expected = np.imag(w**2 / wd * area * np.exp(pole * t[behind]))
    assert np.max(np.abs(response[behind] - expected)) < 1e-5 * np.max(np.abs(expected))
    assert np.max(np.abs(response[t < -3e-3])) < 1e-6 * np.max(np.abs(response)), "nothing comes before its cause"


def test_resonance_peak_and_static_gain() -> None:
    gain = resonance(np.array([0.0, 1000.0]), 1000.0, 0.05)
    assert gain[0] == 1 and abs(gain[1]) == pytest.approx(10.0)
    mounting = Mounting(frequency_hz=3000.0, damping_ratio=0.05)
    assert abs(gain_at(through_mounting(tone(3000.0, N), RATE_HZ, mounting), 3000.0)) == pytest.approx(10.0, rel=1e-4)


@given(order=st.integers(1, 12), ratio=st.floats(0.01, 4.0))
def test_butterworth_magnitude(order: int, ratio: float) -> None:
    gain = butterworth(np.array([ratio * 1234.0]), 1234.0, order)
    assert abs(gain[0]) == pytest.approx(1 / math.sqrt(1 + ratio ** (2 * order)), rel=1e-9)


def test_anti_alias_filter_equals_the_analogue_one_of_scipy() -> None:
    b, a = signal.butter(5, 2 * math.pi * 4000.0, analog=True)
    for frequency in (500.0, 4000.0, 7000.0):
        _, expected = signal.freqs(b, a, [2 * math.pi * frequency])
        found = gain_at(through_filter(tone(frequency, N), RATE_HZ, AntiAlias(cutoff_hz=4000.0, order=5)), frequency)
        assert found == pytest.approx(expected[0], abs=3e-5)


def test_a_constant_passes_a_filter_from_the_first_sample_on() -> None:
    out = through_filter(np.full(500, 3.0), RATE_HZ, AntiAlias(cutoff_hz=50.0, order=4))
    np.testing.assert_allclose(out, 3.0, rtol=1e-12)


def test_taps_of_another_rate_give_their_own_spectrum() -> None:
    rng = np.random.default_rng(3)
    taps = rng.standard_normal(400) * np.exp(-np.arange(400) / 60)
    path = MeasuredPath(sampling_rate_hz=12_800.0, taps=list(taps))
    frequency = np.array([0.0, 13.0, 700.3, 5000.0, 6399.0, 6500.0])
    expected = np.exp(-2j * math.pi * np.outer(frequency, np.arange(400)) / 12_800.0) @ taps
    expected[-1] = 0.0
    np.testing.assert_allclose(measured_gain(path, frequency), expected, atol=2e-6 * np.abs(taps).sum())
    found = gain_at(through_path(tone(700.0, N), RATE_HZ, path), 700.0)
    assert found == pytest.approx(gain_of(path, np.array([700.0]))[0], abs=1e-4)


def test_taps_at_the_own_rate_are_a_convolution() -> None:
    rng = np.random.default_rng(4)
    taps, x = rng.standard_normal(50), rng.standard_normal(3000)
    path = MeasuredPath(sampling_rate_hz=RATE_HZ, taps=list(taps))
    np.testing.assert_allclose(through_path(x, RATE_HZ, path), np.convolve(x, taps)[:3000], atol=1e-5)


@pytest.mark.parametrize(("order", "expected"), [(1, 1 / math.sqrt(2)), (2, 1 / math.sqrt(2))])
def test_the_lower_corner_is_3_db(order: int, expected: float) -> None:
    out = high_pass(tone(5.0, 200_000), RATE_HZ, 5.0, order)
    assert abs(gain_at(out, 5.0, last=0.2)) == pytest.approx(expected, rel=1e-6)
    assert abs(gain_at(high_pass(tone(500.0, N), RATE_HZ, 5.0, order), 500.0)) == pytest.approx(1.0, abs=1e-4)


def test_a_step_through_a_charge_amplifier_decays_with_its_time_constant() -> None:
    corner = 2.0
    out = high_pass(np.ones(20_000), RATE_HZ, corner, 1)
    t = np.arange(20_000) / RATE_HZ
    np.testing.assert_allclose(out[1:], np.exp(-2 * math.pi * corner * t[1:]), rtol=0, atol=5e-4)


def test_sensitivity_gain_error_and_limit() -> None:
    sensor = Transducer(sensitivity_v_per_unit=0.01, gain_error=0.05, limit_v=0.5)
    out = sensed(np.array([1.0, 100.0, -100.0, 47.0]), RATE_HZ, sensor)
    np.testing.assert_allclose(out.volts, [0.0105, 0.5, -0.5, 0.4935])
    assert out.saturated == 2


@pytest.mark.slow
@given(a=st.floats(-5, 5), b=st.floats(-5, 5), seed=st.integers(0, 99))
def test_the_linear_part_is_linear(a: float, b: float, seed: int) -> None:
    x, y = np.random.default_rng(seed).standard_normal((2, 600))
    path = ModalPath.model_validate(MODES)
    sensor = Transducer(lower_corner_hz=3.0, lower_order=2, upper_corner_hz=2000.0, gain_error=-0.1)

    def through(z: np.ndarray) -> np.ndarray:
        mounted = through_mounting(through_path(z, RATE_HZ, path), RATE_HZ, Mounting(frequency_hz=6000.0))
        return through_filter(linear_part(mounted, RATE_HZ, sensor), RATE_HZ, AntiAlias(cutoff_hz=5000.0))

    np.testing.assert_allclose(through(a * x + b * y), a * through(x) + b * through(y), atol=1e-9)


@pytest.mark.parametrize(
    ("model", "data"),
    [
        (ModalPath, {"modes": []}),
        (ModalPath, {"modes": [{"frequency_hz": 2.0, "damping_ratio": 1e-3, "gain": 1.0}]}),
        (ModalPath, {"modes": [{"frequency_hz": 500.0, "damping_ratio": 0.0, "gain": 1.0}]}),
        (MeasuredPath, {"sampling_rate_hz": 1e4, "taps": [0.0] * 16_385}),
        (MeasuredPath, {"sampling_rate_hz": 100.0, "taps": [0.0] * 3000}),
        (MeasuredPath, {"sampling_rate_hz": 1e4, "taps": [float("nan")]}),
        (Mounting, {"frequency_hz": 10.0, "damping_ratio": 1e-3}),
        (AntiAlias, {"cutoff_hz": 0.0}),
        (AntiAlias, {"cutoff_hz": 100.0, "order": 13}),
        (Transducer, {"sensitivity_v_per_unit": 0.0}),
        (Transducer, {"lower_corner_hz": 1.0, "lower_order": 3}),
    ],
)
def test_what_cannot_be_is_refused(model: type, data: dict) -> None:
    with pytest.raises(ValidationError):
        model.model_validate(data)
