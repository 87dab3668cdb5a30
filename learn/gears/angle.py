"""Angle of the driving shaft from the phases of the mesh's harmonics, in all channels together, to the very ends.

The phase of mesh harmonic k is k times the teeth times the angle (F. Bonnardot et al., Mech. Syst. Signal Process. 19
(2005) 766-785). Between short overlapping stretches each harmonic of each channel tells a phase increment; the one
increment of the angle that fits all of them best is taken, so a harmonic whose phase has gone round once more does no
harm. Ten turns are enough, which longer filters (`signals.angle`) are not made for.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from signals.series import ComplexArray, FloatArray

HARMONICS = 5
STRETCH_TURNS, HOP_TURNS = 3.0, 1.0
"""A Hann window of three turns keeps the shaft's own sidebands out."""
TOP = 0.42
"""Of the sampling rate: above, anti-alias filters and resampling leave little."""
SMOOTH = 5
"""Hops over which increments are averaged: speeds change slowly."""
PASSES = 2
GRID = 401
LARGEST = 50.0
"""Largest weight of one harmonic, as a ratio of line to noise."""


def mesh_angle(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, teeth: int, reach: float = 0.004
) -> FloatArray:
    """Angle at each sample, (n,), rad, of a shaft with `teeth` near `speed_hz`; `reach`: relative doubt of that."""
    n = min(c.size for c in channels)
    angle = np.asarray(2 * np.pi * speed_hz / rate_hz * np.arange(n), dtype=np.float64)
    for turn in range(PASSES):
        lines, orders, centres = _lines(channels, rate_hz, speed_hz, teeth, angle)
        if lines.shape[1] < 2:
            return angle
        steps = _increments(lines, orders, reach if turn == 0 else reach / 4)
        knots = np.concatenate(([0.0], np.cumsum(steps)))
        added = np.interp(np.arange(n), centres, knots)
        slope = rate_hz * HOP_TURNS / speed_hz
        before, after = np.arange(n) < centres[0], np.arange(n) > centres[-1]
        added[before] = (np.flatnonzero(before) - centres[0]) / slope * steps[0]
        added[after] = knots[-1] + (np.flatnonzero(after) - centres[-1]) / slope * steps[-1]
        angle = angle + added
    return np.asarray(angle, dtype=np.float64)


def _lines(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, teeth: int, angle: FloatArray
) -> tuple[ComplexArray, FloatArray, FloatArray]:
    """(amplitudes (lines, stretches), orders (lines,), middles of the stretches (stretches,) in samples)."""
    n = angle.size
    hop, size = int(HOP_TURNS * rate_hz / speed_hz), int(STRETCH_TURNS * rate_hz / speed_hz)
    starts = np.arange(0, n - size + 1, hop)
    window = np.hanning(size)
    most = max(1, min(HARMONICS, int(TOP * rate_hz / (teeth * speed_hz))))
    base = np.exp(-1j * teeth * angle)
    found, orders = [], []
    for samples in channels:
        turned = np.asarray(samples[:n] - np.mean(samples[:n]), dtype=np.complex128)
        for k in range(1, most + 1):
            turned = turned * base
            if starts.size:
                blocks = np.lib.stride_tricks.sliding_window_view(turned, size)[::hop][: starts.size]
                found.append(blocks @ window)
            else:
                found.append(np.zeros(0, dtype=np.complex128))
            orders.append(float(k * teeth))
    return np.asarray(found), np.asarray(orders), np.asarray(starts + size / 2, dtype=np.float64)


def _increments(lines: ComplexArray, orders: FloatArray, reach: float) -> FloatArray:
    """Increment of the angle from each stretch to the next, (stretches - 1,), rad."""
    product = lines[:, 1:] * np.conj(lines[:, :-1])
    power = np.maximum(np.sum(np.abs(product), axis=1), 1e-300)
    total = np.sum(product, axis=1)
    coherence = np.minimum(np.abs(total) / power, 1 - 1e-6)
    weight = np.minimum(coherence**2 / (1 - coherence**2), LARGEST)
    grid = 2 * np.pi * HOP_TURNS * reach * np.linspace(-1.0, 1.0, GRID)
    score = weight @ np.cos(np.outer(orders, grid) - np.angle(total)[:, np.newaxis])
    common = float(grid[np.argmax(score)])
    turned = product * np.exp(-1j * orders * common)[:, np.newaxis]
    width = min(SMOOTH, turned.shape[1])
    kernel = np.ones(width)
    smooth = np.stack([np.convolve(row, kernel, mode="same") for row in turned])
    phases = np.angle(smooth)
    share = weight * orders
    return np.asarray(common + share @ phases / np.sum(share * orders), dtype=np.float64)
