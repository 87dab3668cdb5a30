"""Forecasts of held-out features: by an effect's draws, and by its rivals on the same terms.

All of them are fitted to the same features (levels of lines and bands of what is not held out), weighted alike by noise
and drift, and the black box gets as many numbers as the effect's forecast uses.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import cycle

import numpy as np

from signals.series import FloatArray

NEAREST = 16
"""Draws a forecast is made of."""
MODEL_VARIANCE = 8.0
"""Of a feature, in squared deviations of measurement and drift: what no draw of the effect has. On sixteen development
cases 2, 8 and 25 gave much the same gains."""
FARTHEST = 25.0
"""Squared deviations of one feature that count at most."""
RETUNING = 3.0
"""Drifts by which numbers may be retuned: no plausible recording drifts so far."""


@dataclass(frozen=True, kw_only=True)
class Split:
    """One way to hold out: masks (F,) of the features fitted and scored, and the test's change in each part."""

    fit: np.ndarray
    score: np.ndarray
    fitted: FloatArray
    scored: FloatArray


def levels(split: Split, spectral: np.ndarray) -> Split:
    """Fitted to levels of lines and bands alone, which are what is scored, where the fitted part has any."""
    kept = split.fit & spectral & np.isfinite(split.fitted)
    return replace(split, fit=kept) if kept.any() else split


def forecast(changes: FloatArray, rows: Sequence[int], split: Split, sigma: FloatArray) -> tuple[FloatArray, float]:
    """Change (F,) that the draws forecast for all features from the fitted ones: their weighted mean, and their
    departures from it in the linear combination that the fitted part asks for (ensemble Kalman analysis in the space of
    the members, G. Evensen, Ocean Dynamics 53 (2003) 343-367, section 4). With the numbers it has used: one for the
    size, and the trace of the analysis' gain (G. Wahba, J. R. Stat. Soc. B 45 (1983) 133-150, section 4)."""
    drawn = changes[np.asarray(rows)]
    part = split.fit & np.isfinite(split.fitted) & np.isfinite(drawn).all(axis=0)
    away = (drawn[:, part] - split.fitted[part]) / sigma[part]
    distance = np.mean(np.minimum(away**2, FARTHEST), axis=1)
    best = np.argsort(distance)[:NEAREST]
    weights = 1.0 / np.maximum(distance[best], 1e-6)
    mean = weights @ drawn[best] / weights.sum()
    left = np.clip((split.fitted - mean)[part] / sigma[part], -(FARTHEST**0.5), FARTHEST**0.5)
    apart = drawn[best] - mean
    seen = apart[:, part] / sigma[part] / max(best.size - 1, 1) ** 0.5
    square, errors = seen @ seen.T, MODEL_VARIANCE * np.eye(best.size)
    gain = np.linalg.solve(square + errors, seen @ left)
    used = 1.0 + float(np.trace(np.linalg.solve(square + errors, square)))
    return np.asarray(mean + gain @ apart / max(best.size - 1, 1) ** 0.5), used


def retuned(null: FloatArray, split: Split, sigma: FloatArray) -> FloatArray:
    """What drift of the machine's numbers makes of the fitted features, by the analysis of `forecast`: healthy pairs
    around no change, `RETUNING` times as far as they drifted."""
    part = split.fit & np.isfinite(split.fitted) & np.isfinite(null).all(axis=0)
    apart = RETUNING * null / max(null.shape[0], 1) ** 0.5
    seen = apart[:, part] / sigma[part]
    left = np.clip(split.fitted[part] / sigma[part], -(FARTHEST**0.5), FARTHEST**0.5)
    gain = np.linalg.solve(seen @ seen.T + MODEL_VARIANCE * np.eye(null.shape[0]), seen @ left)
    return np.asarray(gain @ np.nan_to_num(apart))


def black_box(
    split: Split, frequency: FloatArray, count: int, sigma: FloatArray, channel: np.ndarray | None = None
) -> FloatArray:
    """`count` cosines over log frequency, fitted to the changes: a smooth spectral correction, the same for all sensors
    and points; or with `channel` (F,) one for each sensor, among which the numbers are dealt out."""
    x = (np.log(frequency) - np.log(frequency).min()) / max(float(np.ptp(np.log(frequency))), 1e-9)
    groups = [np.ones(x.size)] if channel is None else [channel == c for c in np.unique(channel)]
    basis = np.stack([g * np.cos(np.pi * (k // len(groups)) * x) for k, g in zip(range(count), cycle(groups))])
    part = split.fit & np.isfinite(split.fitted)
    weights, *_ = np.linalg.lstsq((basis[:, part] / sigma[part]).T, split.fitted[part] / sigma[part], rcond=None)
    return np.asarray(weights @ basis)
