"""Slow curves: one value a mesh period, and which line dominates them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from paper.measure.lines import line
from paper.measure.window import FloatArray

LOWEST_ORDER = 0.2
"""Lines below this multiple of the shaft speed are drift."""


@dataclass(frozen=True, kw_only=True)
class Slow:
    """Amplitude of the f_o1 line of a slow curve, and frequency and amplitude of its largest line."""

    at_f_o1: float
    largest: float
    largest_hz: float


def slow(curve: FloatArray, *, f_m_hz: float, f_r1_hz: float, f_o1_hz: float) -> Slow:
    """Lines of a curve sampled once a mesh period (shape (periods,)), up to half the mesh frequency."""
    n = curve.size
    window = 0.5 - 0.5 * np.cos(2 * np.pi * np.arange(n) / n)
    values = 2.0 * np.abs(np.fft.rfft((curve - curve.mean()) * window)) / window.sum()
    first = max(2, int(np.ceil(LOWEST_ORDER * f_r1_hz / f_m_hz * n)))
    top = first + int(np.argmax(values[first:]))
    return Slow(
        at_f_o1=abs(line(curve, f_m_hz, f_o1_hz)),
        largest=float(values[top]),
        largest_hz=top * f_m_hz / n,
    )


def turning_points(values: FloatArray, least: float) -> FloatArray:
    """Indices of local extremes between which the signal moves by more than `least` (zigzag), shape (points,)."""
    found: list[int] = []
    pivot, sign = 0, 0
    high = low = 0
    for i in range(1, values.size):
        high = i if values[i] > values[high] else high
        low = i if values[i] < values[low] else low
        if sign <= 0 and values[i] - values[low] > least:
            pivot, sign = low, 1
        elif sign >= 0 and values[high] - values[i] > least:
            pivot, sign = high, -1
        else:
            continue
        if pivot > 0:
            found.append(pivot)
        high = low = i
    return np.asarray(found, dtype=np.float64)
