"""The angle found in the vibration is the shaft's, up to a constant."""

import numpy as np
import pytest
from scipy.signal import hilbert

from signals.angle import AngleTrack, tacholess_angle, track_speed
from signals.series import FloatArray, Series
from signals.spectra import order_spectrum
from sim.core.errors import SpecError

RATE = 10_000.0
SECONDS = 8.0


def machine(speed_hz: FloatArray, noise: float, seed: int = 0) -> tuple[Series, FloatArray]:
    """Mesh of 23 teeth with a harmonic, sidebands and a first order, in white noise."""
    angle = 2 * np.pi * np.concatenate(([0.0], np.cumsum((speed_hz[1:] + speed_hz[:-1]) / 2))) / RATE
    x = np.cos(23 * angle + 0.4) * (1 + 0.2 * np.cos(angle)) + 0.5 * np.cos(46 * angle + 1) + 0.3 * np.cos(angle)
    x = x + noise * np.random.default_rng(seed).standard_normal(angle.size)
    return Series(samples=x, sampling_rate_hz=RATE, unit="m/s^2", name="a"), angle


def error_rad(track: AngleTrack, angle: FloatArray) -> float:
    known = np.isfinite(track.angle_rad)
    difference = track.angle_rad[known] - angle[known]
    return float(np.std(difference))


def times() -> FloatArray:
    return np.arange(int(RATE * SECONDS)) / RATE


SPEEDS = {
    "constant": lambda t: np.full(t.size, 27.3),
    "ramp": lambda t: 20 + 2.5 * t,
    "fluctuating": lambda t: 25 + 0.6 * np.sin(2 * np.pi * 0.7 * t) + 0.2 * np.sin(2 * np.pi * 2.1 * t),
}


@pytest.mark.slow
@pytest.mark.parametrize("course", SPEEDS)
@pytest.mark.parametrize("noise", [0.0, 0.5])
def test_angle_follows_the_shaft(course: str, noise: float) -> None:
    series, angle = machine(SPEEDS[course](times()), noise)
    track = tacholess_angle(series, orders=(23, 46), low_hz=18, high_hz=42)
    # a tooth is 0.27 rad
    assert error_rad(track, angle) < (0.001 if noise == 0 else 0.002)
    known = np.isfinite(track.angle_rad)
    assert np.max(np.abs(track.speed_hz[known] / (np.gradient(angle)[known] * RATE / 2 / np.pi) - 1)) < 0.05
    assert track.spread_rad is not None and track.spread_rad < 0.01


@pytest.mark.slow
def test_orders_are_sharp_in_the_angle_found() -> None:
    series, _ = machine(SPEEDS["ramp"](times()), 0.1)
    track = tacholess_angle(series, orders=(23, 46), low_hz=18, high_hz=42)
    spectrum = order_spectrum(series, shaft="input", rotation=track.angle_rad)
    near = np.abs(spectrum.order - 23) < 0.3
    assert spectrum.order[near][np.argmax(spectrum.values[near])] == pytest.approx(23, abs=spectrum.resolution_order)
    assert np.max(spectrum.values[near]) == pytest.approx(1.0, rel=0.16)


@pytest.mark.slow
def test_several_orders_are_better_than_the_worst_and_weighted() -> None:
    series, angle = machine(SPEEDS["fluctuating"](times()), 0.8, seed=3)
    both = tacholess_angle(series, orders=(1, 23, 46), low_hz=20, high_hz=30)
    assert sum(both.weights) == pytest.approx(1)
    assert both.weights[0] < 0.01, "order 1 tells 23 times less of the angle"
    one = tacholess_angle(series, orders=(23,), low_hz=20, high_hz=30)
    assert one.spread_rad is None
    assert error_rad(both, angle) < error_rad(one, angle) * 1.1


def test_phase_equals_that_of_the_analytic_signal() -> None:
    """Independent calculation for a single clean line: the unwrapped Hilbert phase over the order."""
    t = times()
    angle = 2 * np.pi * (25 * t + 0.1 * np.sin(2 * np.pi * 0.7 * t))
    x = np.cos(10 * angle)
    track = tacholess_angle(Series(samples=x, sampling_rate_hz=RATE, unit="m"), orders=(10,), low_hz=22, high_hz=28)
    other = np.unwrap(np.angle(hilbert(x))) / 10
    known = np.isfinite(track.angle_rad)
    assert np.std((track.angle_rad - other)[known]) < 1e-4


def test_coarse_track_stays_on_the_course() -> None:
    series, _ = machine(SPEEDS["ramp"](times()), 1.0)
    track = track_speed(series, orders=(23, 46), low_hz=15, high_hz=45)
    assert np.max(np.abs(track.speed_hz - SPEEDS["ramp"](track.time_s))) < 0.3


def test_bad_requests_say_what_is_allowed() -> None:
    series, _ = machine(SPEEDS["constant"](times()), 0.0)
    for options, field in (
        ({"orders": (), "low_hz": 20, "high_hz": 30}, "orders"),
        ({"orders": (1,), "low_hz": 30, "high_hz": 20}, "low_hz/high_hz"),
        ({"orders": (300,), "low_hz": 20, "high_hz": 30}, "orders"),
        ({"orders": (23,), "low_hz": 0.5, "high_hz": 30}, "low_hz"),
    ):
        with pytest.raises(SpecError) as error:
            tacholess_angle(series, **options)  # type: ignore[arg-type]
        assert error.value.problems[0].field == field
