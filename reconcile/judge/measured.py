"""How well a feature of one recording is known: standard deviations by the noise and the length of the record."""

from __future__ import annotations

import numpy as np

from reconcile.calibrate.chain import Chain
from reconcile.observe.features import SHAPE_DB, SOFT
from reconcile.observe.statistics import SHAPE_BANDS_HZ, Statistics, third_octaves
from signals.series import FloatArray

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
