"""Shaft angle over time, and resampling of a series at equal steps of that angle."""

from __future__ import annotations

import numpy as np
import scipy
from scipy.interpolate import CubicSpline, PchipInterpolator
from scipy.ndimage import map_coordinates

from signals.recording import Tacho
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError

UPSAMPLING = 4
"""Band-limited oversampling before the spline: keeps the quintic's error below 1e-3 up to 0.4 of the sampling rate."""


def constant_speed_angle(series: Series, speed_hz: float) -> FloatArray:
    """Angle of a shaft at constant speed at the sample times, shape (n,), rad."""
    if not (np.isfinite(speed_hz) and speed_hz > 0):
        problem = Problem(field="speed_hz", message="must be positive", given=speed_hz, allowed="above 0", unit="Hz")
        raise SpecError(problem)
    return np.arange(series.samples.size, dtype=np.float64) * (2 * np.pi * speed_hz / series.sampling_rate_hz)


def tacho_angle(series: Series, tacho: Tacho) -> FloatArray:
    """Angle of the tacho's shaft at the sample times, shape (n,), rad; NaN before the first and after the last pulse.

    Cubic spline through the pulses (exact for constant and linearly changing speed up to the end intervals);
    where jitter would make that spline run backwards, a monotone cubic is taken instead.
    """
    pulses = np.asarray(tacho.pulse_times_s, dtype=np.float64)
    if pulses.size < 4 or tacho.pulses_per_revolution < 1 or not np.all(np.diff(pulses) > 0):
        raise SpecError(
            Problem(
                field="tacho.pulse_times_s",
                message="must rise strictly and hold enough pulses to follow the speed",
                given=f"{pulses.size} pulses, {tacho.pulses_per_revolution} a revolution",
                allowed="at least 4 rising times and 1 pulse a revolution",
                unit="s",
            )
        )
    angles = np.arange(pulses.size) * (2 * np.pi / tacho.pulses_per_revolution)
    times = series.start_s + np.arange(series.samples.size) / series.sampling_rate_hz
    inside = (times >= pulses[0]) & (times <= pulses[-1])
    values = CubicSpline(pulses, angles)(times)
    if np.any(np.diff(values[inside]) <= 0):
        values = PchipInterpolator(pulses, angles)(times)
    return np.where(inside, values, np.nan)


def resample_in_angle(series: Series, angle_rad: FloatArray, samples_per_revolution: int) -> FloatArray:
    """Samples at equal steps of angle, shape (m,), over the whole revolutions that `angle_rad` covers.

    `angle_rad` has shape (n,), rises strictly where finite, and may be NaN at both ends.
    """
    known = np.flatnonzero(np.isfinite(angle_rad))
    if angle_rad.shape != series.samples.shape or known.size < 2 or np.any(np.diff(angle_rad[known]) <= 0):
        raise SpecError(
            Problem(
                field="angle_rad",
                message="must give a strictly rising angle for the samples",
                given=f"shape {angle_rad.shape}, {known.size} finite",
                allowed=f"shape {series.samples.shape}",
                unit="rad",
            )
        )
    first, last = angle_rad[known[0]], angle_rad[known[-1]]
    revolutions = int((last - first) / (2 * np.pi) * (1 + 1e-12))
    if revolutions < 1:
        message = "covers less than one revolution"
        raise SpecError(Problem(field="angle_rad", message=message, given=float(last - first), unit="rad"))
    targets = first + np.arange(revolutions * samples_per_revolution) * (2 * np.pi / samples_per_revolution)
    index = CubicSpline(angle_rad[known], known.astype(np.float64))(targets)
    return samples_at(series.samples, np.asarray(index, dtype=np.float64))


def samples_at(samples: FloatArray, index: FloatArray) -> FloatArray:
    """Values (m,) at fractional indices (m,) of samples (n,): band-limited oversampling, then a quintic."""
    fine = scipy.signal.resample_poly(samples, UPSAMPLING, 1, padtype="line")
    place = np.asarray(index[np.newaxis] * UPSAMPLING, dtype=np.float64)
    resampled = map_coordinates(np.asarray(fine, dtype=np.float64), place, order=5, mode="mirror")
    return np.asarray(resampled, dtype=np.float64)
