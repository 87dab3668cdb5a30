"""Shaft angle from the phase of its own harmonics, without a tacho.

The phase of a band around order k, divided by k, is the shaft angle: F. Bonnardot, M. El Badaoui, R. B. Randall,
J. Daniere and F. Guillet, "Use of the acceleration signal of a gearbox in order to perform angular resampling (with
limited speed fluctuation)", Mech. Syst. Signal Process. 19 (2005) 766-785. Large changes of speed are first followed
roughly, then by the phase, in two steps as in J. Urbanek, T. Barszcz and J. Antoni, "A two-step procedure for
estimation of instantaneous rotational speed with large fluctuations", Mech. Syst. Signal Process. 38 (2013) 96-102.
Several orders are averaged, each weighted with the inverse variance of the angle it gives.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.interpolate import CubicSpline

from signals.angle.tracking import SpeedTrack, track_speed
from signals.series import ComplexArray, FloatArray, Series

HALF_WIDTH = 0.4
"""Half width of a band, in turns per second of the slowest speed: the sidebands of the shaft itself stay outside."""
PASSES = 6
"""Each pass demodulates along the angle of the one before: what is faster than the coarse track comes in by and by."""


@dataclass(frozen=True, kw_only=True)
class AngleTrack:
    """Angle of the shaft at each sample, (n,), rad, from an unknown constant on; NaN where the filters lack a side.

    `speed_hz` (n,) is its derivative. `spread_rad` is the RMS by which the angles from single orders differ from the
    weighted mean, None for one order; `weights` sum to one.
    """

    angle_rad: FloatArray
    speed_hz: FloatArray
    orders: tuple[float, ...]
    weights: tuple[float, ...]
    spread_rad: float | None


def tacholess_angle(
    series: Series,
    *,
    orders: Sequence[float],
    low_hz: float,
    high_hz: float,
    max_slew_hz_per_s: float | None = None,
) -> AngleTrack:
    """Angle of a shaft that turns between `low_hz` and `high_hz`, by its lines at `orders` (cycles per revolution).

    Choose orders that surely belong to the shaft and stand well above what is beside them: the mesh harmonics of a
    gear on it are the usual ones. Without any such line the result is that of the noise: look at `spread_rad`.
    """
    track = track_speed(series, orders=orders, low_hz=low_hz, high_hz=high_hz, max_slew_hz_per_s=max_slew_hz_per_s)
    angle = _coarse_angle(series, track)
    slowest = float(np.min(track.speed_hz))
    half_width_hz = HALF_WIDTH * slowest
    for _ in range(PASSES):
        phases, weights = _phases(series, angle, orders, half_width_hz)
        correction = np.asarray(weights @ phases, dtype=np.float64)
        spread = float(np.sqrt(np.mean(weights @ (phases - correction) ** 2))) if len(orders) > 1 else None
        angle = angle + correction
    angle -= angle[0]
    speed = np.gradient(angle) * (series.sampling_rate_hz / (2 * np.pi))
    edge = int(series.sampling_rate_hz / half_width_hz)
    if 2 * edge < angle.size // 2:
        angle[:edge] = angle[angle.size - edge :] = np.nan
    return AngleTrack(
        angle_rad=angle,
        speed_hz=np.asarray(speed, dtype=np.float64),
        orders=tuple(float(k) for k in orders),
        weights=tuple(float(w) for w in weights),
        spread_rad=spread,
    )


def _coarse_angle(series: Series, track: SpeedTrack) -> FloatArray:
    """Angle (n,) of the track: its speed, held at both ends, as a spline through the frames and integrated."""
    t = series.start_s + np.arange(series.samples.size) / series.sampling_rate_hz
    if track.time_s.size < 4:
        speed = np.interp(t, track.time_s, track.speed_hz)
    else:
        inside = np.clip(t, track.time_s[0], track.time_s[-1])
        speed = CubicSpline(track.time_s, _smooth(track.speed_hz))(inside)
    step = np.concatenate(([0.0], (speed[1:] + speed[:-1]) / 2)) / series.sampling_rate_hz
    return np.asarray(2 * np.pi * np.cumsum(step), dtype=np.float64)


def _smooth(speed_hz: FloatArray) -> FloatArray:
    """Three-frame mean: the steps of the grid are not the shaft's."""
    padded = np.concatenate((speed_hz[:1], speed_hz, speed_hz[-1:]))
    return np.asarray((padded[:-2] + padded[1:-1] + padded[2:]) / 3, dtype=np.float64)


def _phases(
    series: Series, angle_rad: FloatArray, orders: Sequence[float], half_width_hz: float
) -> tuple[FloatArray, FloatArray]:
    """What each order adds to the angle, (orders, n), rad, without its mean, and the weights, (orders,).

    A line A in noise of variance s^2 in its band has a phase of variance s^2 / (2 A^2) and fluctuates in amplitude by
    as much, relatively; divided by k the angle's variance is that over k^2. The fluctuation is what is measured.
    """
    phases = np.empty((len(orders), series.samples.size))
    weights = np.empty(len(orders))
    for row, order in enumerate(orders):
        line = _low_pass(series.samples * np.exp(-1j * order * angle_rad), half_width_hz / series.sampling_rate_hz)
        phase = np.unwrap(np.angle(line)) / order
        phases[row] = phase - np.mean(phase)
        size = np.abs(line)
        fluctuation = float(np.var(size)) / max(float(np.mean(size)) ** 2, 1e-300)
        weights[row] = order**2 / max(fluctuation, 1e-12)
    return phases, weights / np.sum(weights)


def _low_pass(values: ComplexArray, cutoff: float) -> ComplexArray:
    """Zero-phase low-pass, flat to half the cutoff (cycles a sample), falling as a cosine to zero at the cutoff."""
    frequency = np.abs(fft.fftfreq(values.size))
    edge = np.clip((frequency - cutoff / 2) / (cutoff / 2), 0.0, 1.0)
    return np.asarray(fft.ifft(fft.fft(values) * (0.5 + 0.5 * np.cos(np.pi * edge))), dtype=np.complex128)
