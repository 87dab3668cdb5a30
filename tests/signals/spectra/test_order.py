"""Orders keep their place while the speed changes."""

import numpy as np
import pytest

from signals.recording import Tacho
from signals.series import FloatArray, Series
from signals.spectra import amplitude_spectrum, order_spectrum, spectrogram, tacho_angle
from sim.core.errors import SpecError

RATE = 10_000.0
DURATION_S = 8.0
START_HZ, RAMP_HZ_PER_S = 20.0, 2.5


def ramp() -> tuple[FloatArray, FloatArray]:
    """Times and the angle of a shaft running up from 20 to 40 Hz."""
    t = np.arange(int(RATE * DURATION_S)) / RATE
    return t, 2 * np.pi * (START_HZ * t + RAMP_HZ_PER_S * t**2 / 2)


def run_up() -> tuple[Series, FloatArray]:
    """Lines at order 1 (amplitude 2) and 23.5 (amplitude 1): up to 940 Hz, of 5000."""
    _, angle = ramp()
    samples = 2 * np.sin(angle) + np.sin(23.5 * angle + 1)
    return Series(samples=samples, sampling_rate_hz=RATE, unit="m/s^2", name="a"), angle


def tacho(pulses_per_revolution: int) -> Tacho:
    """Exact pulse times of the ramp: solve angle(t) = 2 pi k / p."""
    _, angle = ramp()
    turns = np.arange(int(angle[-1] / (2 * np.pi) * pulses_per_revolution)) / pulses_per_revolution
    times = (-START_HZ + np.sqrt(START_HZ**2 + 2 * RAMP_HZ_PER_S * turns)) / RAMP_HZ_PER_S
    return Tacho(shaft="input", pulse_times_s=times, pulses_per_revolution=pulses_per_revolution)


@pytest.mark.parametrize("pulses", [0, 1, 8])
def test_a_run_up_gives_sharp_orders(pulses: int) -> None:
    series, angle = run_up()
    spectrum = order_spectrum(series, shaft="input", rotation=tacho(pulses) if pulses else angle)
    for order, amplitude in ((1.0, 2.0), (23.5, 1.0)):
        near = np.abs(spectrum.order - order) < 0.2
        assert np.max(spectrum.values[near]) == pytest.approx(amplitude, rel=0.16)  # Hann dips 15 % between bins
        assert spectrum.order[near][np.argmax(spectrum.values[near])] == pytest.approx(
            order, abs=spectrum.resolution_order
        )
    rest = (np.abs(spectrum.order - 1) > 0.1) & (np.abs(spectrum.order - 23.5) > 0.1)
    assert np.max(spectrum.values[1:][rest[1:]]) < 0.01
    # the plain spectrum smears the same line over a third of the axis
    plain = amplitude_spectrum(series)
    assert np.max(plain.values[plain.frequency_hz > 400]) < 0.2
    assert spectrum.order[-1] <= RATE / 2 / 40.0 * 1.01


def test_constant_speed_orders_are_frequency_over_speed() -> None:
    t = np.arange(20_000) / RATE
    series = Series(samples=np.sin(2 * np.pi * 25 * 4000 / 25 * t), sampling_rate_hz=RATE, unit="m")
    spectrum = order_spectrum(series, shaft="input", rotation=25.0)
    peak = int(np.argmax(spectrum.values))
    assert spectrum.order[peak] == pytest.approx(160.0)
    # 4 kHz of 10 kHz: the worst case of the interpolation
    assert spectrum.values[peak] == pytest.approx(1.0, rel=2e-3)
    assert spectrum.at_speed(25.0).frequency_hz[peak] == pytest.approx(4000.0)


def test_tacho_angle_follows_a_ramp_and_is_unknown_outside() -> None:
    series, angle = run_up()
    found = tacho_angle(series, tacho(1))
    known = np.isfinite(found)
    assert not known[-1]
    assert np.max(np.abs(found[known] - angle[known])) < 1e-3


@pytest.mark.parametrize("times", [[0.0, 0.1], [0.0, 0.2, 0.1, 0.3, 0.4]])
def test_bad_tachos_are_refused(times: list[float]) -> None:
    series, _ = run_up()
    with pytest.raises(SpecError, match="pulse_times_s"):
        order_spectrum(series, shaft="input", rotation=Tacho(shaft="input", pulse_times_s=np.array(times)))


def test_a_shaft_that_turns_back_or_barely_turns_is_refused() -> None:
    series, angle = run_up()
    with pytest.raises(SpecError, match="forwards"):
        order_spectrum(series, shaft="input", rotation=angle[::-1].copy())
    with pytest.raises(SpecError, match="less than one revolution"):
        order_spectrum(series, shaft="input", rotation=0.1)
    with pytest.raises(SpecError, match="speed_hz"):
        order_spectrum(series, shaft="input", rotation=0.0)


def test_spectrogram_follows_the_speed() -> None:
    t, angle = ramp()
    series = Series(samples=3 * np.sin(40 * angle), sampling_rate_hz=RATE, unit="m", start_s=5.0)
    result = spectrogram(series, resolution_hz=20.0)
    ridge = result.frequency_hz[np.argmax(result.values, axis=0)]
    expected = 40 * (START_HZ + RAMP_HZ_PER_S * (result.time_s - 5.0))
    assert np.max(np.abs(ridge - expected)) <= 20.0
    assert np.median(np.max(result.values, axis=0)) == pytest.approx(3.0, rel=0.2)
    assert result.time_s[0] == pytest.approx(5.025)
    assert t.size == series.samples.size
    few = spectrogram(series, resolution_hz=20.0, max_frames=10)
    assert few.values.shape[1] <= 10
