"""The exponent of an odd law, free: coefficient * sgn z |z|^p beside a linear law."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from reconcile.force_law.samples import FloatArray, ForceSamples

LOWEST, HIGHEST = 1.2, 7.0
"""Near 1 the law cannot be told from the linear one."""
POWERS = np.linspace(LOWEST, HIGHEST, 12)
RESAMPLES = 60
MOST_SAMPLES = 6000


@dataclass(frozen=True, kw_only=True)
class Exponent:
    """Least-squares exponent with its 90 % interval over resampled blocks."""

    value: float
    low: float
    high: float


def _columns(power: float, z: FloatArray, v: FloatArray) -> FloatArray:
    """What is fitted to the force, (n, 5), each of about one size."""
    share = z / (float(np.abs(z).max()) or 1.0)
    law = np.sign(z) * np.abs(share) ** power
    return np.column_stack([np.ones(z.size), share, v / (float(np.abs(v).max()) or 1.0), share**2, law])


def _left(columns: FloatArray, force: FloatArray, weight: FloatArray) -> float:
    """Weighted square of what the columns leave of the force, by the normal equations: few columns of one size."""
    weighted = columns.T * weight
    solution = np.linalg.lstsq(weighted @ columns, weighted @ force, rcond=None)[0]
    return float(weight @ (force - columns @ solution) ** 2)


def _best(grid: Sequence[FloatArray], z: FloatArray, v: FloatArray, force: FloatArray, weight: FloatArray) -> float:
    """The exponent that leaves least; `grid` holds the columns of `POWERS`."""
    k = int(np.argmin([_left(columns, force, weight) for columns in grid]))
    ends = (float(POWERS[max(k - 1, 0)]), float(POWERS[min(k + 1, POWERS.size - 1)]))
    found = minimize_scalar(
        lambda power: _left(_columns(power, z, v), force, weight),
        bounds=ends,
        method="bounded",
        options={"xatol": 1e-3},
    )
    return float(found.x)


def odd_exponent(samples: ForceSamples, rng: np.random.Generator) -> Exponent:
    """Exponent of the odd part; beside it a constant, z, v and z^2 are free. At most `MOST_SAMPLES` are used."""
    step = max(1, samples.force_n.size // MOST_SAMPLES)
    z, v = samples.displacement_m[::step], samples.velocity_m_per_s[::step]
    force, blocks = samples.force_n[::step], samples.blocks[::step]
    grid = [_columns(power, z, v) for power in POWERS]
    value = _best(grid, z, v, force, np.ones(z.size))
    found = []
    for _ in range(RESAMPLES):
        counts = np.bincount(rng.integers(0, samples.count, samples.count), minlength=samples.count)
        found.append(_best(grid, z, v, force, counts[blocks].astype(np.float64)))
    low, high = np.quantile(found, (0.05, 0.95))
    return Exponent(value=value, low=float(low), high=float(high))
