"""How well a feature of one recording is known: standard deviations by the noise and the length of the record."""

from __future__ import annotations

import numpy as np

from reconcile.calibrate.chain import Chain
from reconcile.observe.features import SHAPE_DB, SOFT
from reconcile.observe.statistics import SHAPE_BANDS_HZ, Statistics, third_octaves
from reconcile.observe.watch import WatchList
from signals.series import FloatArray

UNSTEADY_DB = {"line": 1.0, "floor": 0.7, "total": 0.7, "depth": 1.0, "kurtosis": 5.0, "skewness": 4.0}
"""What repeated recordings of a sound machine differ by beside noise and drift: speed wander left after tracking,
phases of balls, which moments of few impacts feel most. Set on the development nulls."""
SIDEBAND_DB = 4.0
WANDER_DB = 4.0
"""Sidebands of the mesh at a shaft's multiples rise and fall together with slow wander of the speed."""
DB = 10.0 / np.log(10.0)
MEDIAN_LOSS = 1.44
"""Standard deviation of the logarithm of a median of exponentials over that of their mean: 1/ln 2."""


def measured_db(seen: Statistics, chain: Chain, lines_hz: FloatArray) -> FloatArray:
    """(C, F): deviations of the soft features. A line of power P in noise n varies by sqrt(2 P n + n^2)."""
    noise = chain.line_noise(lines_hz) * seen.resolution_hz
    power = np.maximum(seen.line - noise, 0.0)
    line = DB * np.sqrt(2.0 * power * noise + noise**2) / (seen.line + SOFT * noise)
    widths = np.diff(third_octaves())
    band = np.broadcast_to(DB / np.sqrt(widths * seen.duration_s), seen.floor.shape)
    shapes = np.array([high - low for low, high in SHAPE_BANDS_HZ])
    deep = np.broadcast_to((2.0 * seen.resolution_hz / shapes)[None, :, None], seen.depth.shape)
    depth = DB * np.sqrt(2.0 * seen.depth * deep + deep**2) / (seen.depth + SOFT * deep)
    moment = np.broadcast_to(SHAPE_DB * np.sqrt(12.0 / (shapes * seen.duration_s)), seen.kurtosis.shape)
    parts = [line, MEDIAN_LOSS * band, band, depth.reshape(depth.shape[0], -1), moment, moment]
    return np.concatenate(parts, axis=-1)


def unsteady_db(seen: Statistics, watched: WatchList) -> FloatArray:
    """(F,): deviation of one channel's features between repeated recordings, beside noise and drift."""
    sidebands = np.array([w.family == "sideband" for w in watched.lines])
    sizes = {
        "line": seen.line.shape[1],
        "floor": seen.floor.shape[1],
        "total": seen.total.shape[1],
        "depth": seen.depth.shape[1] * seen.depth.shape[2],
        "kurtosis": seen.kurtosis.shape[1],
        "skewness": seen.skewness.shape[1],
    }
    rows = {name: np.full(n, UNSTEADY_DB[name]) for name, n in sizes.items()}
    rows["line"][sidebands] = SIDEBAND_DB
    return np.concatenate(list(rows.values()))


def wander_patterns(watched: WatchList, features: int) -> FloatArray:
    """(shafts, F): what one deviation of wander of each shaft does to one channel's features, dB."""
    shafts = sorted({b for w in watched.lines if w.family == "sideband" for b in w.orders if b.startswith("f_r")})
    patterns = np.zeros((len(shafts), features))
    for row, shaft in enumerate(shafts):
        for i, line in enumerate(watched.lines):
            if line.family == "sideband" and shaft in line.orders:
                patterns[row, i] = WANDER_DB
    return patterns
