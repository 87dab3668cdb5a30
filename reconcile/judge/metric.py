"""Distance between changes: whitened by what scatters within one effect, so that what differs between effects counts.

Changes are whitened by measurement, drift and 1 dB, then compressed (sign(z) log(1 + |z|)): a line that rises by 40 dB
out of nothing tells the pattern of an effect, not forty times its probability. The within-effect scatter (other
parameters, other machines) is estimated from each draw against its neighbours in size, pooled over all effects, and
added to a ridge: Fisher's discriminant with a pooled covariance (Fisher 1936, Annals of Eugenics 7, 179-188),
regularised as by Friedman 1989, J. Am. Stat. Assoc. 84, 165-175.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray

LEAST_DB = 1.0
"""No feature is trusted better than this: interpolated gains, leakage, the atlas' own step."""
RIDGE = 0.2
"""Variance added in every direction of the compressed space."""
KEPT = 1e-3
"""Scatter directions below this share of the largest are left to the ridge."""


@dataclass(frozen=True, kw_only=True)
class Whitening:
    """`used` (F,) marks features that count, `sigma` (D,) whitens them."""

    used: np.ndarray
    sigma: FloatArray

    def __call__(self, changes: FloatArray) -> FloatArray:
        """(..., F) in dB -> (..., D), compressed."""
        z = np.nan_to_num(changes[..., self.used]) / self.sigma
        return np.asarray(np.sign(z) * np.log1p(np.abs(z)))


def whitening(observed: FloatArray, measured: FloatArray, null: FloatArray, drawn: FloatArray) -> Whitening:
    """From the recordings' own deviations `measured` (F,) and simulated changes `null` (n, F), `drawn` (m, F)."""
    simulated = (np.isfinite(drawn).mean(axis=0) > 0.97) & (np.isfinite(null).mean(axis=0) > 0.97)
    used = np.isfinite(observed) & np.isfinite(measured) & simulated
    drift = np.nanstd(null[:, used], axis=0)
    return Whitening(used=used, sigma=np.sqrt(measured[used] ** 2 + drift**2 + LEAST_DB**2))


@dataclass(frozen=True, kw_only=True)
class Metric:
    """`basis` (D, r) orthonormal directions of scatter, `shrink` (r,): their weight relative to the rest."""

    basis: FloatArray
    shrink: FloatArray

    def __call__(self, compressed: FloatArray) -> FloatArray:
        """(n, D) -> (n, D) whose Euclidean distances are those of the metric."""
        inside = compressed @ self.basis
        return np.asarray((compressed + (inside * (self.shrink - 1.0)) @ self.basis.T) / np.sqrt(RIDGE))


def neighbour_scatter(points: FloatArray, shares: FloatArray) -> FloatArray:
    """Residual of each draw from the line between its neighbours in size, (n - 2, D), scaled to one draw's scatter."""
    order = np.argsort(shares)
    p, u = points[order], shares[order]
    if p.shape[0] < 3:
        return np.zeros((0, p.shape[1]))
    w = ((u[1:-1] - u[:-2]) / (u[2:] - u[:-2] + 1e-9))[:, None]
    return np.asarray((p[1:-1] - (1 - w) * p[:-2] - w * p[2:]) / np.sqrt(1 + w**2 + (1 - w) ** 2))


def fit_metric(scatter: Sequence[FloatArray]) -> Metric:
    """From rows of scatter (n_i, D)."""
    rows = np.concatenate([np.asarray(s, dtype=np.float32) for s in scatter])
    values, vectors = np.linalg.eigh((rows @ rows.T / rows.shape[0]).astype(np.float64))
    kept = values > KEPT * values[-1]
    values, vectors = values[kept], vectors[:, kept]
    basis = rows.T @ vectors / np.sqrt(values * rows.shape[0])
    return Metric(basis=basis, shrink=np.sqrt(RIDGE / (values + RIDGE)))
