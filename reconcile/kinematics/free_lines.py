"""The black box beside a comb: as many numbers spent on lines wherever they help most, fitted by least squares."""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares

from reconcile.kinematics.combs import MAIN_LOBE, PARAMETERS, SMOOTH, Stretch, rescaled
from signals.series import FloatArray

WIDE = (4.0, 16.0, 64.0)
"""Bins from which on a hump's width begins to be fitted; the best fit counts."""
WIDTHS = (1.0, 400.0)
HEIGHTS = (-30.0, 10.0)
"""Natural logarithm of power."""


def black_boxes(fit: Stretch, before: FloatArray) -> tuple[FloatArray, ...]:
    """Log powers (bins,) of the expected spectrum `before`, smoothly re-scaled, with PARAMETERS free numbers in place
    of the comb: narrow lines, place and height of each, or humps with their width too."""
    lines = _fitted(fit, before, PARAMETERS // 2, MAIN_LOBE, False)
    humps = [_fitted(fit, before, PARAMETERS // 3, width, True) for width in WIDE]
    return lines, min(humps, key=lambda made: float(np.sum((made - fit.log_power) ** 2)))


def _fitted(fit: Stretch, before: FloatArray, count: int, width: float, free: bool) -> FloatArray:
    """`count` lines, begun at the strongest of what the re-scaling leaves, then all numbers together."""
    retuned, smooth = rescaled(fit, before)
    bins = np.arange(retuned.size, dtype=np.float64)
    places, heights = _strongest(fit.log_power - retuned, fit.log_power, count, width)
    size = 3 if free else 2
    lines = np.column_stack((places, heights, np.full(count, width)))[:, :size]
    low = np.array([0.0, HEIGHTS[0], WIDTHS[0]])[:size]
    high = np.array([max(bins[-1], 1.0), HEIGHTS[1], WIDTHS[1]])[:size]

    def told(p: FloatArray) -> FloatArray:
        power = np.exp(np.clip(before + fit.basis @ p[-SMOOTH:], -60.0, 60.0))
        power += np.exp(p[-SMOOTH - 1])
        for line in p[: -SMOOTH - 1].reshape(count, size):
            away = (bins - line[0]) / (line[2] if free else width)
            power += np.exp(line[1] - 0.5 * np.minimum(away**2, 1e3))
        return np.asarray(np.log(power), dtype=np.float64)

    def residual(p: FloatArray) -> FloatArray:
        return np.asarray(told(p) - fit.log_power, dtype=np.float64)

    bounds = (
        np.append(np.tile(low, count), np.array([HEIGHTS[0], *[-20.0] * SMOOTH])),
        np.append(np.tile(high, count), [HEIGHTS[1], *[20.0] * SMOOTH]),
    )
    start = np.clip(
        np.append(lines.ravel(), [np.percentile(fit.log_power, 10), *smooth]), bounds[0] + 1e-9, bounds[1] - 1e-9
    )
    found = least_squares(residual, start, bounds=bounds, x_scale="jac", max_nfev=200)
    return told(found.x)


def _strongest(left: FloatArray, log_power: FloatArray, count: int, width: float) -> tuple[FloatArray, FloatArray]:
    """Places (count,), bins, and log heights of where most is left over a line's width, each beyond the last's."""
    window = max(1, round(width))
    over = np.convolve(left, np.ones(window) / window, mode="same")
    places = []
    for _ in range(count):
        peak = int(np.argmax(over))
        places.append(peak)
        over[max(0, peak - 2 * window) : peak + 2 * window + 1] = -np.inf
    return np.array(places, dtype=np.float64), np.asarray(log_power[places], dtype=np.float64)
