"""Distance between changes: whitened by what scatters within one effect, so that what differs between effects counts.

Changes are whitened by measurement, drift and 1 dB, pooled by family and compressed (sign(z) log(1 + |z|)): a line that
rises by 40 dB out of nothing tells the pattern of an effect, not forty times its probability. The within-effect scatter
(other parameters, other machines, noise) is estimated from each draw against its neighbours in size, pooled over all
effects: Fisher's discriminant (Fisher 1936, Annals of Eugenics 7, 179-188), regularised as by Friedman 1989, J. Am.
Stat. Assoc. 84, 165-175.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from signals.series import FloatArray

LEAST_DB = 1.0
"""No feature is trusted better than this: interpolated gains, leakage, the atlas' own step."""
LEAST_VARIANCE = 0.1
"""Variance of a pooled feature that no simulation knows of: forms of laws, sensors, assembly."""
RIDGE = 0.005
"""Share of the mean variance added in every direction."""


@dataclass(frozen=True, kw_only=True)
class Whitening:
    """`sigma` (F,) whitens; infinite where a feature was not measured or could not be simulated."""

    sigma: FloatArray

    def __call__(self, changes: FloatArray) -> FloatArray:
        """(..., F) in dB -> (..., F), zero where nothing is known."""
        return np.asarray(np.where(np.isfinite(changes), changes, 0.0) / self.sigma)

    def only(self, columns: np.ndarray) -> Whitening:
        """Of some features, (k,) places."""
        return Whitening(sigma=self.sigma[columns])


def whitening(observed: FloatArray, measured: FloatArray, null: FloatArray, drawn: FloatArray) -> Whitening:
    """From the recordings' own deviations `measured` (F,) and simulated changes `null` (n, F), `drawn` (m, F)."""
    simulated = (np.isfinite(drawn).mean(axis=0) > 0.97) & (np.isfinite(null).mean(axis=0) > 0.97)
    used = np.isfinite(observed) & np.isfinite(measured) & simulated
    return Whitening(sigma=np.where(used, drift_sigma(measured, null), np.inf))


def drift_sigma(measured: FloatArray, null: FloatArray) -> FloatArray:
    """(F,): deviation of a healthy machine's changes, dB."""
    drift = np.std(np.nan_to_num(null), axis=0)
    return np.asarray(np.sqrt(np.nan_to_num(measured) ** 2 + drift**2 + LEAST_DB**2))


@dataclass(frozen=True, kw_only=True)
class Metric:
    """Linear map (D, D) after which Euclidean distances are those of the metric; `centre` (D,) is no change."""

    centre: FloatArray
    turn: FloatArray

    def __call__(self, pooled: FloatArray) -> FloatArray:
        """(n, D) -> (n, D)."""
        return np.asarray((pooled - self.centre) @ self.turn)


def neighbour_scatter(points: FloatArray, shares: FloatArray) -> FloatArray:
    """Residual of each draw from the line between its neighbours in size, (n - 2, D), scaled to one draw's scatter."""
    order = np.argsort(shares)
    p, u = points[order], shares[order]
    if p.shape[0] < 3:
        return np.zeros((0, p.shape[1]))
    w = ((u[1:-1] - u[:-2]) / (u[2:] - u[:-2] + 1e-9))[:, None]
    return np.asarray((p[1:-1] - (1 - w) * p[:-2] - w * p[2:]) / np.sqrt(1 + w**2 + (1 - w) ** 2))


def fit_metric(centre: FloatArray, scatter: Sequence[FloatArray]) -> Metric:
    """From rows of scatter (n_i, D)."""
    rows = np.concatenate(scatter)
    pooled = rows.T @ rows / rows.shape[0]
    size = pooled.shape[0]
    ridge = LEAST_VARIANCE + RIDGE * max(1.0, 4.0 * size / rows.shape[0]) * max(float(np.trace(pooled)) / size, 1e-9)
    root = cholesky(pooled + ridge * np.eye(size))
    return Metric(centre=centre, turn=np.asarray(solve_triangular(root, np.eye(size)), dtype=np.float64))
