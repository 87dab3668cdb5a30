"""Pictures of a force: over one argument with a band, over displacement and velocity, its work, its firing angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from reconcile.force_law.samples import FloatArray, ForceSamples, IntArray, block_sums
from reconcile.verdict import AngleWindow

RESAMPLES = 400
LEAST_IN_BIN = 8
FULL_TURN_DEG = 360.0


@dataclass(frozen=True, kw_only=True)
class Curve:
    """Mean force in bins of one argument with a 90 % band over resampled blocks; NaN where too little data fell."""

    argument: FloatArray
    force_n: FloatArray
    low_n: FloatArray
    high_n: FloatArray


def _binned(values: FloatArray, bins: int) -> tuple[FloatArray, IntArray]:
    edges = np.linspace(float(values.min()), float(values.max()), bins + 1)
    place = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, bins - 1)
    return 0.5 * (edges[1:] + edges[:-1]), place.astype(np.int64)


def curve(samples: ForceSamples, argument: FloatArray, rng: np.random.Generator, *, bins: int = 40) -> Curve:
    """Force over `argument` (n,): displacement, velocity or shaft angle within a turn."""
    centres, place = _binned(argument, bins)
    count = samples.count
    key = samples.blocks * bins + place
    sums = np.bincount(key, weights=samples.force_n, minlength=count * bins).reshape(count, bins)
    numbers = np.bincount(key, minlength=count * bins).reshape(count, bins).astype(np.float64)
    picks = rng.integers(0, count, (RESAMPLES, count))
    weights = np.stack([np.bincount(row, minlength=count) for row in picks]).astype(np.float64)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = sums.sum(axis=0) / numbers.sum(axis=0)
        again = (weights @ sums) / (weights @ numbers)
    enough = (numbers.sum(axis=0) >= LEAST_IN_BIN) & (np.sum(numbers > 0, axis=0) >= 2)
    again = np.where(np.isfinite(again), again, mean)
    low, high = np.quantile(again, (0.05, 0.95), axis=0)
    hidden = np.where(enough, 0.0, np.nan)
    return Curve(argument=centres, force_n=mean + hidden, low_n=low + hidden, high_n=high + hidden)


@dataclass(frozen=True, kw_only=True)
class Surface:
    """Mean force over displacement (columns) and velocity (rows), NaN where too little data fell."""

    displacement_m: FloatArray
    velocity_m_per_s: FloatArray
    force_n: FloatArray


def surface(samples: ForceSamples, *, bins: int = 32) -> Surface:
    """Force over the state."""
    x, i = _binned(samples.displacement_m, bins)
    y, j = _binned(samples.velocity_m_per_s, bins)
    key = j * bins + i
    numbers = np.bincount(key, minlength=bins * bins).reshape(bins, bins)
    sums = np.bincount(key, weights=samples.force_n, minlength=bins * bins).reshape(bins, bins)
    mean = np.where(numbers >= LEAST_IN_BIN, sums / np.maximum(numbers, 1), np.nan)
    return Surface(displacement_m=x, velocity_m_per_s=y, force_n=mean)


@dataclass(frozen=True, kw_only=True)
class Work:
    """Mean work of the force per block (revolution), J, with a 90 % interval; positive: it takes energy."""

    mean_j: float
    low_j: float
    high_j: float


def work_per_cycle(samples: ForceSamples, rng: np.random.Generator) -> Work:
    """Work against a resistance in each block, averaged."""
    done = block_sums(samples.force_n * samples.velocity_m_per_s * samples.step_s, samples.blocks, samples.count)
    again = done[rng.integers(0, done.size, (RESAMPLES, done.size))].mean(axis=1)
    low, high = np.quantile(again, (0.05, 0.95))
    return Work(mean_j=float(done.mean()), low_j=float(low), high_j=float(high))


def firing_angle(samples: ForceSamples, shaft: str, rng: np.random.Generator) -> AngleWindow | None:
    """Where in a turn the force is strong: direction of its power's first harmonic with a 90 % interval.

    None without an angle, or where the power does not favour any direction (Hotelling's T^2 over blocks at 1 %).
    """
    if samples.angle_rad is None:
        return None
    power = (samples.force_n - samples.force_n.mean()) ** 2
    cosine = block_sums(power * np.cos(samples.angle_rad), samples.blocks, samples.count)
    sine = block_sums(power * np.sin(samples.angle_rad), samples.blocks, samples.count)
    centre = float(np.arctan2(sine.sum(), cosine.sum()))
    pairs = np.column_stack([cosine, sine])
    mean, spread = pairs.mean(axis=0), np.cov(pairs.T) + 1e-300 * np.eye(2)
    if samples.count * float(mean @ np.linalg.solve(spread, mean)) < float(scipy.stats.chi2.ppf(0.99, 2)):
        return None
    picks = rng.integers(0, samples.count, (RESAMPLES, samples.count))
    again = np.arctan2(sine[picks].sum(axis=1), cosine[picks].sum(axis=1))
    away = np.angle(np.exp(1j * (again - centre)))
    low, high = np.degrees(np.quantile(away, (0.05, 0.95)))
    middle = float(np.degrees(centre)) % FULL_TURN_DEG
    ends = ((middle + float(low)) % FULL_TURN_DEG, (middle + float(high)) % FULL_TURN_DEG)
    return AngleWindow(shaft=shaft, centre_deg=middle, low_deg=ends[0], high_deg=ends[1])
