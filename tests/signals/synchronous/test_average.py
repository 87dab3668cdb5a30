"""The mean turn keeps what turns with the shaft; the rest falls with the root of the turns."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.recording import Tacho
from signals.series import FloatArray, Series
from signals.spectra import resample_in_angle
from signals.spectra.angle import constant_speed_angle
from signals.synchronous import average as module
from signals.synchronous import separate, synchronous_average
from sim.core.errors import SpecError

RATE, SPEED_HZ, PER_TURN = 12_800.0, 25.0, 512


def turning(turns: int, noise: float = 0.0, other: float = 0.0, seed: int = 0) -> tuple[Series, FloatArray]:
    """A mean turn of a few orders, white noise, and a line of a shaft at another speed (ratio 23/81)."""
    t = np.arange(turns * PER_TURN + 1) / RATE
    phase = 2 * np.pi * SPEED_HZ * t
    pattern = np.cos(23 * phase) + 0.3 * np.sin(46 * phase) + 0.2 * np.cos(2 * phase + 1)
    x = pattern + other * np.cos(phase * 23 / 81 * 5) + noise * np.random.default_rng(seed).standard_normal(t.size)
    return Series(samples=x, sampling_rate_hz=RATE, unit="m/s^2", name="a"), pattern[:PER_TURN]


def test_mean_turn_is_the_pattern() -> None:
    series, pattern = turning(20)
    mean = synchronous_average(series, shaft="input", rotation=SPEED_HZ)
    assert (mean.revolutions, mean.samples_per_revolution) == (20, PER_TURN)
    assert np.max(np.abs(mean.samples - pattern)) < 1e-3
    assert mean.scatter_rms < 1e-3


@pytest.mark.parametrize("turns", [16, 256])
def test_noise_falls_with_the_root_of_the_turns(turns: int) -> None:
    series, pattern = turning(turns, noise=1.0)
    mean = synchronous_average(series, shaft="input", rotation=SPEED_HZ)
    left = float(np.sqrt(np.mean((mean.samples - pattern) ** 2)))
    # an RMS over 512 samples scatters by 3 %; the interpolation takes no more than 2 % of white noise off
    assert left == pytest.approx(1 / np.sqrt(turns), rel=0.12)
    assert mean.noise_rms == pytest.approx(left, rel=0.12)
    assert mean.scatter_rms == pytest.approx(1.0, rel=0.05)


def test_another_shaft_averages_out_and_has_its_own_average() -> None:
    series, pattern = turning(23 * 12, other=2.0)
    mean = synchronous_average(series, shaft="input", rotation=SPEED_HZ, max_revolutions=81 * 3)
    assert mean.revolutions == 243
    assert np.max(np.abs(mean.samples - pattern)) < 5e-3
    slow = synchronous_average(series, shaft="output", rotation=SPEED_HZ, ratio=23 / 81, samples_per_revolution=4096)
    spectrum = np.abs(np.fft.rfft(slow.samples)) * 2 / 4096
    assert spectrum[5] == pytest.approx(2.0, rel=0.01)
    assert slow.mean_speed_hz == pytest.approx(SPEED_HZ * 23 / 81)
    assert spectrum[81] == pytest.approx(1.0, rel=0.01), "the mesh is order 81 of the slow shaft"


def test_run_up_with_a_tacho_keeps_the_pattern() -> None:
    t = np.arange(80_000) / 10_000.0
    angle = 2 * np.pi * (20 * t + 1.25 * t**2)
    turns = np.arange(int(angle[-1] / (2 * np.pi)))
    pulses = (-20 + np.sqrt(400 + 5 * turns)) / 2.5
    series = Series(samples=np.cos(23 * angle + 1), sampling_rate_hz=10_000.0, unit="m")
    mean = synchronous_average(series, shaft="input", rotation=Tacho(shaft="input", pulse_times_s=pulses))
    spectrum = np.fft.rfft(mean.samples) * 2 / mean.samples_per_revolution
    assert abs(spectrum[23]) == pytest.approx(1.0, rel=2e-3)
    assert np.angle(spectrum[23]) == pytest.approx(1.0, abs=0.01)


def test_blocks_give_what_the_whole_gives(monkeypatch: pytest.MonkeyPatch) -> None:
    """The streamed average equals the mean of the series resampled at once."""
    series, _ = turning(40, noise=0.3)
    monkeypatch.setattr(module, "BLOCK_SAMPLES", 3 * PER_TURN)
    streamed = synchronous_average(series, shaft="input", rotation=SPEED_HZ)
    level = float(np.mean(series.samples))
    centred = Series(samples=series.samples - level, sampling_rate_hz=RATE, unit="m")
    whole = level + resample_in_angle(centred, constant_speed_angle(series, SPEED_HZ), PER_TURN).reshape(-1, PER_TURN)
    assert np.max(np.abs(streamed.samples - np.mean(whole, axis=0))) < 1e-9
    scatter = float(np.sqrt(np.sum(np.var(whole, axis=0, ddof=1)) / PER_TURN))
    assert streamed.scatter_rms == pytest.approx(scatter, rel=1e-9)


@settings(max_examples=25)
@given(level=st.floats(-50, 50), scale=st.floats(0.01, 100))
def test_average_is_linear(level: float, scale: float) -> None:
    series, _ = turning(4, noise=0.2)
    plain = synchronous_average(series, shaft="s", rotation=SPEED_HZ)
    moved = Series(samples=level + scale * series.samples, sampling_rate_hz=RATE, unit="m")
    other = synchronous_average(moved, shaft="s", rotation=SPEED_HZ)
    assert np.max(np.abs(other.samples - (level + scale * plain.samples))) < 1e-9 * (abs(level) + scale)


def test_parts_add_up_and_hold_their_orders() -> None:
    series, _ = turning(30, noise=0.5)
    mean = synchronous_average(series, shaft="input", rotation=SPEED_HZ)
    parts = separate(mean, teeth=[23])
    assert np.max(np.abs(parts.regular + parts.difference - mean.samples)) < 1e-12
    residual, difference = np.abs(np.fft.rfft(parts.residual)), np.abs(np.fft.rfft(parts.difference))
    full = np.abs(np.fft.rfft(mean.samples))
    gone = {0, 1, 2, *range(23, 257, 23)}
    sidebands = {k + s for k in range(23, 257, 23) for s in (-1, 1)} & set(range(257))
    for order in range(257):
        expected = 0.0 if order in gone else full[order]
        assert residual[order] == pytest.approx(expected, abs=1e-9)
        assert difference[order] == pytest.approx(0.0 if order in sidebands else expected, abs=1e-9)


def test_two_gears_on_a_shaft_are_both_taken_out() -> None:
    series, _ = turning(5, noise=0.5)
    parts = separate(synchronous_average(series, shaft="input", rotation=SPEED_HZ), teeth=[23, 31])
    assert np.max(np.abs(np.fft.rfft(parts.residual)[[23, 31, 46, 62, 93]])) < 1e-9


def test_bad_requests_are_refused_with_the_field() -> None:
    series, _ = turning(5)
    mean = synchronous_average(series, shaft="input", rotation=SPEED_HZ)
    for teeth in ([], [1], [400]):
        with pytest.raises(SpecError, match="teeth"):
            separate(mean, teeth=teeth)
    with pytest.raises(SpecError, match="too few turns"):
        synchronous_average(series, shaft="input", rotation=3.0)
    with pytest.raises(SpecError, match="ratio"):
        synchronous_average(series, shaft="input", rotation=SPEED_HZ, ratio=0.0)
    broken = constant_speed_angle(series, SPEED_HZ)
    broken[100] = np.nan
    with pytest.raises(SpecError, match="without gaps"):
        synchronous_average(series, shaft="input", rotation=broken)
