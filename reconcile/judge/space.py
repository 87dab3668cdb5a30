"""The space in which changes are compared: whitened by what is not the effect, reduced to where effects differ."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray

LEAST_DB = 1.0
"""No feature is trusted better than this: interpolation of gains, leakage, the atlas' own step."""
MOST_AXES = 120
CLIP = 60.0
"""Whitened changes beyond this count as this: one line out of nothing must not outvote all others."""


@dataclass(frozen=True, kw_only=True)
class Space:
    """`sigma` (D,) whitens a change; `axes` (D, q) are orthonormal; `used` (D,) marks features that count."""

    used: np.ndarray
    sigma: FloatArray
    axes: FloatArray

    def whiten(self, changes: FloatArray) -> FloatArray:
        """(..., all features) -> (..., D), soft-clipped."""
        z = changes[..., self.used] / self.sigma
        return np.asarray(CLIP * np.tanh(z / CLIP))

    def coordinates(self, changes: FloatArray) -> FloatArray:
        """(..., all features) -> (..., q)."""
        return np.asarray(self.whiten(changes) @ self.axes)


def build_space(measured_db: FloatArray, null: FloatArray, signatures: FloatArray, observed: FloatArray) -> Space:
    """`measured_db` (F,) standard deviation by measurement; `null` (n, F), `signatures` (m, F) simulated changes.

    A feature counts when it is finite in the recordings and in nearly all simulations.
    """
    finite = np.isfinite(signatures).mean(axis=0) > 0.98
    used = np.isfinite(observed) & np.isfinite(measured_db) & finite & (np.isfinite(null).mean(axis=0) > 0.98)
    drift = np.nanstd(null[:, used], axis=0)
    sigma = np.sqrt(measured_db[used] ** 2 + drift**2 + LEAST_DB**2)
    bare = Space(used=used, sigma=sigma, axes=np.eye(1))
    z = bare.whiten(np.nan_to_num(signatures))
    z = z / (1.0 + np.linalg.norm(z, axis=1, keepdims=True)) ** 0.5
    _, _, right = np.linalg.svd(z, full_matrices=False)
    return Space(used=used, sigma=sigma, axes=right[:MOST_AXES].T)
