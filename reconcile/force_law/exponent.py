"""The exponent of an odd law, free: coefficient * sgn z |z|^p beside a linear law."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from reconcile.force_law.samples import FloatArray, ForceSamples

LOWEST, HIGHEST = 1.2, 7.0
"""Near 1 the law cannot be told from the linear one."""
RESAMPLES = 60
MOST_SAMPLES = 6000


@dataclass(frozen=True, kw_only=True)
class Exponent:
    """Least-squares exponent with its 90 % interval over resampled blocks."""

    value: float
    low: float
    high: float


def _error(power: float, z: FloatArray, v: FloatArray, force: FloatArray, weight: FloatArray) -> float:
    top = float(np.abs(z).max()) or 1.0
    law = np.sign(z) * (np.abs(z) / top) ** power
    columns = np.column_stack([np.ones(z.size), z / top, v / (float(np.abs(v).max()) or 1.0), (z / top) ** 2, law])
    root = np.sqrt(weight)
    solution = np.linalg.lstsq(columns * root[:, None], force * root, rcond=None)[0]
    return float(np.sum(weight * (force - columns @ solution) ** 2))


def _best(z: FloatArray, v: FloatArray, force: FloatArray, weight: FloatArray) -> float:
    grid = np.linspace(LOWEST, HIGHEST, 12)
    errors = [_error(p, z, v, force, weight) for p in grid]
    k = int(np.argmin(errors))
    ends = (float(grid[max(k - 1, 0)]), float(grid[min(k + 1, grid.size - 1)]))
    found = minimize_scalar(_error, bounds=ends, args=(z, v, force, weight), method="bounded", options={"xatol": 1e-3})
    return float(found.x)


def odd_exponent(samples: ForceSamples, rng: np.random.Generator) -> Exponent:
    """Exponent of the odd part; beside it a constant, z, v and z^2 are free. At most `MOST_SAMPLES` are used."""
    step = max(1, samples.force_n.size // MOST_SAMPLES)
    z, v = samples.displacement_m[::step], samples.velocity_m_per_s[::step]
    force, blocks = samples.force_n[::step], samples.blocks[::step]
    value = _best(z, v, force, np.ones(z.size))
    found = []
    for _ in range(RESAMPLES):
        counts = np.bincount(rng.integers(0, samples.count, samples.count), minlength=samples.count)
        found.append(_best(z, v, force, counts[blocks].astype(np.float64)))
    low, high = np.quantile(found, (0.05, 0.95))
    return Exponent(value=value, low=float(low), high=float(high))
