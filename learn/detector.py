"""The classical way, for comparison: a kinematic envelope detector with a fixed rule.

Band by search, squared envelope, mean over three harmonics of the peak over its neighbourhood's median in dB, within
2 % of BPFO, BPFI and twice the ball spin; the largest of the three names the fault if it reaches 30 dB.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from scipy import fft

from learn.bank import even_length
from learn.orders import FaultOrders
from signals.series import FloatArray

RULE_DB = 30.0
SEARCH, NEIGHBOURHOOD = 0.02, 0.3
HARMONICS = 3
BANDS = 10


def kinematic_detector(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, orders: FaultOrders
) -> tuple[str, dict[str, float]]:
    """(class, level of each family in dB) at the true speed and geometry."""
    best = {"outer": -np.inf, "inner": -np.inf, "ball": -np.inf}
    wanted = {"outer": orders.outer, "inner": orders.inner, "ball": orders.ball}
    for samples in channels:
        x = even_length(samples)
        for i in range(BANDS):
            edges = (max(i / BANDS, 0.02), min((i + 1) / BANDS, 0.98))
            band = scipy.signal.sosfiltfilt(scipy.signal.butter(4, edges, btype="bandpass", output="sos"), x)
            square = np.abs(_analytic(band)) ** 2
            spectrum = np.abs(fft.rfft((square - np.mean(square)) * np.hanning(square.size)))
            step = rate_hz / square.size
            for name, order in wanted.items():
                levels = [_level(spectrum, step, k * order * speed_hz) for k in range(1, HARMONICS + 1)]
                best[name] = max(best[name], float(np.mean(levels)))
    top = max(best, key=lambda name: best[name])
    return (top if best[top] >= RULE_DB else "healthy"), best


def _analytic(values: FloatArray) -> np.ndarray[tuple[int, ...], np.dtype[np.complex128]]:
    half = np.zeros(values.size, dtype=np.complex128)
    lines = fft.rfft(values)
    half[: lines.size] = 2 * lines
    return np.asarray(fft.ifft(half), dtype=np.complex128)


def _level(spectrum: FloatArray, step: float, frequency: float) -> float:
    near = _part(spectrum, step, frequency, max(SEARCH * frequency, step))
    around = _part(spectrum, step, frequency, max(NEIGHBOURHOOD * frequency, 3 * step))
    if near.size == 0 or around.size == 0:
        return 0.0
    return float(20 * np.log10(np.max(near) / max(float(np.median(around)), 1e-300)))


def _part(spectrum: FloatArray, step: float, frequency: float, reach: float) -> FloatArray:
    low, high = round((frequency - reach) / step), round((frequency + reach) / step)
    return spectrum[max(low, 1) : high + 1]
