"""Pulse times of a recorded tacho channel."""

import numpy as np
import pytest

from signals.angle import pulse_times
from signals.angle.pulses import check_inside, covered, recorded_tacho
from signals.series import Series
from signals.spectra import order_spectrum
from sim.core.errors import SpecError

RATE = 20_000.0


def pulses(noise: float = 0.0, n: int = 40_000) -> Series:
    """A 3 V pulse over a tenth of each turn at 27.3 Hz; edges rise within five samples."""
    t = np.arange(n) / RATE
    phase = np.mod(27.3 * t, 1.0)
    edge = RATE / 27.3 / 5
    volts = 3 * np.clip(np.minimum((phase - 0.5) * edge, (0.6 - phase) * edge), 0, 1)
    return Series(
        samples=volts + noise * np.random.default_rng(1).standard_normal(n),
        sampling_rate_hz=RATE,
        unit="V",
        name="tacho",
    )


def test_crossings_are_found_between_samples() -> None:
    times = pulse_times(pulses())
    expected = (np.arange(times.size) + 0.5 + 0.5 / (RATE / 27.3 / 5)) / 27.3
    assert times.size == int(2 * 27.3 + 0.5)
    assert np.max(np.abs(times - expected)) < 1e-9


def test_noise_on_an_edge_makes_no_second_pulse() -> None:
    assert pulse_times(pulses(noise=0.1)).size == pulse_times(pulses()).size


def test_the_tacho_carries_orders() -> None:
    tacho = recorded_tacho(pulses(), shaft="input")
    t = np.arange(40_000) / RATE
    series = Series(samples=np.sin(2 * np.pi * 27.3 * 13 * t), sampling_rate_hz=RATE, unit="m")
    spectrum = order_spectrum(series, shaft="input", rotation=tacho)
    assert spectrum.order[np.argmax(spectrum.values)] == pytest.approx(13, abs=spectrum.resolution_order)


def test_a_channel_without_pulses_is_refused() -> None:
    with pytest.raises(SpecError, match="fewer than two pulses"):
        pulse_times(Series(samples=np.zeros(100), sampling_rate_hz=RATE, unit="V", name="tacho"))


def test_pulses_beside_a_recording_are_refused_and_the_rest_is_a_share_of_it() -> None:
    assert covered(np.array([0.5, 1.0, 1.5]), 0.0, 2.0) == pytest.approx(0.5)
    assert covered(np.array([-1.0, 5.0]), 0.0, 2.0) == 1.0
    check_inside(np.array([1.5, 2.5]), 0.0, 2.0)
    with pytest.raises(SpecError, match="pulse_times_s"):
        check_inside(np.array([2.5, 3.5]), 0.0, 2.0)
