"""A recording as samples at constant speed: resampled over the shaft's angle where that is known better than even."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import fft
from scipy.interpolate import CubicSpline

from reconcile.speed import SpeedEstimate, estimate_speed, followed_angle, shaft_angle
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.response import Channel

EVEN_SHARE = 2e-4
"""An angle closer to even than this share of a revolution a revolution needs no resampling."""


@dataclass(frozen=True, kw_only=True)
class Steady:
    """`samples` (C, n) at `rate_hz`, as if the drive shaft had turned at `speed_hz` all the time.

    `start_turns`: its angle at the first sample, by the tacho; 0 without one.
    """

    samples: FloatArray
    rate_hz: float
    speed_hz: float
    estimate: SpeedEstimate
    start_turns: float = 0.0

    def peak_hz(self, channel: int, hz: float, reach_hz: float) -> float:
        """Where the spectrum of a channel is largest within `reach_hz` of a frequency, else that."""
        samples = self.samples[channel]
        step, half = self.rate_hz / samples.size, samples.size // 2
        low, high = (int(np.floor((hz + side * reach_hz) / step + 0.5)) for side in (-1.0, 1.0))
        bins = np.arange(max(low, 1), min(high, half) + 1)
        if not bins.size:
            return hz
        spectrum = np.abs(fft.rfft(samples * np.hanning(samples.size)))
        return float(step * bins[int(np.argmax(spectrum[bins]))])

    def recording(self, channels: Sequence[Channel]) -> Recording:
        """The samples as a recording at the speed they stand for."""
        return Recording(
            sampling_rate_hz=self.rate_hz,
            channels=tuple(channels),
            samples=self.samples,
            operating=Operating(shaft=self.estimate.shaft, speed_hz=self.speed_hz),
        )


def steady(recording: Recording, *, orders: Sequence[float], slowest: float = 1.0, seed: int = 0) -> Steady:
    """`orders`: cycles a revolution of the drive shaft that surely exist (teeth and their multiples).

    `slowest`: turns of the slowest shaft a revolution of the drive shaft.
    """
    estimate = estimate_speed(recording, orders=orders[:2], seed=seed)
    angle = _angle(recording, estimate, orders, slowest)
    known = np.isfinite(angle)
    samples, turns = recording.samples[:, known], angle[known] / (2 * np.pi)
    rate = recording.sampling_rate_hz
    speed = float((turns[-1] - turns[0]) / ((turns.size - 1) / rate))
    time = np.arange(turns.size) / rate
    wander = np.abs(turns - turns[0] - speed * time).max()
    start = float(turns[0]) % 1.0 if estimate.method == "tacho" else 0.0
    if wander < EVEN_SHARE:
        return Steady(samples=samples, rate_hz=rate, speed_hz=speed, estimate=estimate, start_turns=start)
    wanted = turns[0] + speed * time
    at = np.interp(wanted, turns, time)
    spline = CubicSpline(time, samples, axis=1)
    even = np.asarray(spline(at))
    return Steady(samples=even, rate_hz=rate, speed_hz=speed, estimate=estimate, start_turns=start)


def _angle(recording: Recording, estimate: SpeedEstimate, orders: Sequence[float], slowest: float) -> FloatArray:
    """Pulses where there are any; else all lines of the teeth together; else what single channels give."""
    if estimate.method != "tacho" and orders:
        angle = followed_angle(
            recording.samples, recording.sampling_rate_hz, estimate.speed_hz, orders=orders, slowest=slowest
        )
        if angle is not None:
            return angle
    return shaft_angle(recording, estimate, orders=orders[:2])
