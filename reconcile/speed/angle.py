"""Angle of a shaft at every sample: pulses, else its own strongest lines where that sharpens other lines, else even."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import fft
from scipy.interpolate import UnivariateSpline

from reconcile.speed.estimate import HARMONICS, SpeedEstimate
from reconcile.speed.excess import power_over_floor
from signals.angle.tacholess import tacholess_angle
from signals.recording import Recording
from signals.series import FloatArray, Series
from signals.spectra.angle import constant_speed_angle, tacho_angle
from sim.core.errors import SpecError

TRACK_RANGE = 0.01
"""Share of the speed within which it may wander when followed by its lines."""
MIN_LINE_DB = 20.0
MIN_GAIN_DB = 1.0
"""A tracked angle is taken only if lines it was not made from gain this much."""
LINES = 3
FEW_PULSES, MANY_PULSES = 8, 20_000


def shaft_angle(recording: Recording, speed: SpeedEstimate, *, orders: Sequence[float] = ()) -> FloatArray:
    """Angle of the shaft, shape (n,), rad; NaN before the first and after the last pulse of a tacho.

    `orders`: cycles per revolution that surely belong to the shaft besides its first harmonics.
    """
    if speed.method == "tacho":
        assert recording.tacho is not None
        try:
            return smooth_angle(tacho_angle(recording.series(recording.names[0]), recording.tacho), recording)
        except SpecError:
            pass  # too few pulses to follow: the mean speed remains
    best = recording.series(recording.names[0])
    even = constant_speed_angle(best, speed.speed_hz)
    if speed.method != "harmonics":
        return even
    candidates = (*HARMONICS, *orders)
    gain, chosen = 0.0, even
    for name in recording.names:
        series = recording.series(name)
        tracked = _tracked(series, even, speed.speed_hz, candidates)
        if tracked is not None and tracked[0] > gain:
            gain, chosen = tracked
    return chosen


def smooth_angle(angle_rad: FloatArray, recording: Recording) -> FloatArray:
    """The angle (n,), rad, as smooth as its pulses allow, which are known to a sample: through every one of few pulses
    a turn, that half sample would shake the fifth harmonic of the teeth by half a radian. A cubic spline with the
    fewest knots whose squared deviations are those of the clock (Reinsch 1967, Numer. Math. 10, 177-183)."""
    tacho = recording.tacho
    assert tacho is not None
    times = tacho.pulse_times_s - recording.start_s
    if not FEW_PULSES <= times.size <= MANY_PULSES:
        return angle_rad
    turns = np.arange(times.size) / tacho.pulses_per_revolution
    speed = (turns[-1] - turns[0]) / (times[-1] - times[0])
    clock = speed / (recording.sampling_rate_hz * np.sqrt(12.0))
    smooth = UnivariateSpline(times, turns - speed * times, w=np.full(times.size, 1.0 / clock), s=times.size)
    known = np.isfinite(angle_rad)
    time = np.flatnonzero(known) / recording.sampling_rate_hz
    offset = angle_rad[known][0] - 2 * np.pi * np.interp(time[0], times, turns)
    result = np.full(angle_rad.size, np.nan)
    result[known] = 2 * np.pi * (speed * time + smooth(time)) + offset
    return result if np.all(np.diff(result[known]) > 0) else angle_rad


def order_levels(series: Series, angle_rad: FloatArray, orders: Sequence[float]) -> FloatArray:
    """Power over the local floor at `orders`, dB, shape (orders,), of a series resampled by `angle_rad`."""
    known = np.isfinite(angle_rad)
    turns = (angle_rad[known] - angle_rad[known][0]) / (2 * np.pi)
    per_turn = int(2.5 * max(orders)) + 8
    count = int(turns[-1]) * per_turn
    values = np.interp(np.arange(count) / per_turn, turns, series.samples[known])
    power = np.abs(fft.rfft((values - np.mean(values)) * np.hanning(count))) ** 2
    ratio = power_over_floor(power)
    place = np.rint(np.asarray(orders) * int(turns[-1])).astype(np.int64)
    near = np.stack([ratio[np.clip(place + k, 0, ratio.size - 1)] for k in (-1, 0, 1)])
    return np.asarray(10 * np.log10(np.max(near, axis=0) + 1e-12), dtype=np.float64)


def _tracked(
    series: Series, even: FloatArray, speed_hz: float, orders: Sequence[float]
) -> tuple[float, FloatArray] | None:
    """(gain in dB on lines not used, angle) by the strongest lines of a channel; None where there are too few."""
    inside = [k for k in orders if k * speed_hz * (1 + TRACK_RANGE) < 0.45 * series.sampling_rate_hz]
    levels = order_levels(series, even, inside) if inside else np.zeros(0)
    strong = [inside[i] for i in np.argsort(-levels) if levels[i] > MIN_LINE_DB]
    used, held = strong[:LINES], strong[LINES:]
    if len(used) < 2 or len(held) < 2:
        return None
    try:
        track = tacholess_angle(
            series, orders=used, low_hz=speed_hz * (1 - TRACK_RANGE), high_hz=speed_hz * (1 + TRACK_RANGE)
        )
    except SpecError:
        return None
    angle = np.where(np.isfinite(track.angle_rad), track.angle_rad, np.nan)
    known = np.flatnonzero(np.isfinite(angle))
    if known.size < even.size // 2 or np.any(np.diff(angle[known]) <= 0):
        return None
    gain = float(np.mean(order_levels(series, angle, held) - order_levels(series, even, held)))
    return (gain, angle) if gain > MIN_GAIN_DB else None
