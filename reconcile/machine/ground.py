"""The recorded baseline as the ground to which is added what an effect adds to the motion, as sensors would hear it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from scipy import fft

from reconcile.atlas.run import RATE_HZ, SPAN_S
from reconcile.machine.motion import path_gain
from reconcile.machine.setting import Setting
from reconcile.observe.impact_bands import ComplexArray, density, envelope_power
from signals.series import FloatArray


@dataclass(frozen=True, kw_only=True)
class Ground:
    """At one point: transforms `white` (C, n // 2 + 1) of `count` samples of the baseline over the roots of its floors'
    densities, and factors (C, n // 2 + 1) from a machine's motion to them."""

    white: ComplexArray
    factor: FloatArray
    count: int
    rate_hz: float

    @property
    def seconds(self) -> float:
        """Length."""
        return self.count / self.rate_hz

    def added(self, motion: FloatArray) -> ComplexArray:
        """What motion (C, n) at the simulations' rate adds to the transforms (C, n // 2 + 1)."""
        return np.asarray(self.factor * np.array([self.on_grid(row) for row in motion]))

    def on_grid(self, motion: FloatArray) -> ComplexArray:
        """Transform (n // 2 + 1,) of a simulated channel as that of the baseline's samples."""
        span = max(round(motion.size * self.rate_hz / RATE_HZ), self.count)
        again = np.asarray(scipy.signal.resample(motion, span))
        return np.asarray(fft.rfft(again[: self.count]))

    def bands(self, white: ComplexArray) -> list[list[FloatArray]]:
        """Of each channel, powers of the lines of the squared envelope in each band; of several signals, `white`
        (C, signals, n // 2 + 1), as many rows of each."""
        return [envelope_power(np.asarray(row), self.count, self.rate_hz) for row in white]


def ground_of(setting: Setting, point: int) -> tuple[Ground, ComplexArray]:
    """The baseline at a point, and the test's transforms over the same floors."""
    test, baseline = setting.data[point].spectra
    if baseline is None:
        raise ValueError("nothing to add to without a baseline")
    rate_hz = baseline.rate_hz
    count = min(round(SPAN_S * rate_hz), baseline.samples.shape[1], test.samples.shape[1])
    hz = np.arange(count // 2 + 1) * rate_hz / count
    floors = [np.interp(hz, *density(row, rate_hz)) for row in baseline.samples]
    over = 1.0 / np.sqrt(np.array(floors))
    ground = Ground(
        white=np.array([fft.rfft(x[:count]) * o for x, o in zip(baseline.samples, over, strict=True)]),
        factor=np.asarray(path_gain(setting.seen_through[point].chain, hz) * over),
        count=count,
        rate_hz=rate_hz,
    )
    return ground, np.array([fft.rfft(x[:count]) * o for x, o in zip(test.samples, over, strict=True)])
