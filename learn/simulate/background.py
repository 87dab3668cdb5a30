"""What sounds beside simulated gear pairs: the ingredients of `signals.background`, drawn for each hearing."""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from learn.orders import FaultOrders
from signals.background import Carrier, Train, trains
from signals.background import knocks as random_knocks
from signals.background import rolling_noise as noise_following
from signals.background.axis import smooth_walk
from signals.series import FloatArray


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A number between the two, even on a logarithmic scale."""
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def rolling_noise(rng: np.random.Generator, angle_rad: FloatArray, orders: FaultOrders) -> FloatArray:
    """Rolling noise of a bearing, and of one line of something else, RMS 1, (2, n)."""
    depths = (
        (log_uniform(rng, 0.5, 12.0), 0.3),
        (1.0, 0.6),
        (2.0, 0.4),
        (orders.outer, 0.5),
        (orders.inner, 0.4),
        (orders.ball, 0.3),
        (orders.cage, 0.4),
    )
    carriers = [
        Carrier(phase_rad=order * angle_rad + rng.uniform(0, 2 * np.pi), depth=log_uniform(rng, 0.01, most))
        for order, most in depths
    ]
    return noise_following(rng, angle_rad.size, carriers)


def knocks(rng: np.random.Generator, samples: int, rate_hz: float) -> FloatArray:
    """Impulses at random times, up to 500 a second, RMS 1, (2, n); in three of five machines."""
    if rng.random() < 0.4:
        return np.zeros((2, samples))
    return random_knocks(rng, samples, rate_hz, log_uniform(rng, 0.2, 500.0))


def neighbours(
    rng: np.random.Generator, samples: int, rate_hz: float, speed_hz: float, share: float = 0.4
) -> FloatArray:
    """One to three trains of regular impulses, RMS 1, (2, n); in `share` of the machines, sound or not."""
    if rng.random() >= share:
        return np.zeros((2, samples))
    found = [
        Train(
            per_s=speed_hz * log_uniform(rng, 0.3, 13.0),
            slip=log_uniform(rng, 1e-4, 0.02),
            swing=rng.uniform(0.0, 0.5),
            slow=rng.uniform(0.02, 0.5),
            size=log_uniform(rng, 0.1, 1.0),
        )
        for _ in range(int(rng.integers(1, 4)))
    ]
    return trains(rng, samples, rate_hz, found)


def warped(samples: FloatArray, rate_hz: float, share: float, step_s: float, seed: int) -> FloatArray:
    """Samples (c, n) of a machine whose speed wanders by the RMS `share`, with knots every `step_s`."""
    count = samples.shape[1]
    speed = share * smooth_walk(np.random.default_rng(seed), count, rate_hz, step_s)
    at = np.clip(np.arange(count) + np.cumsum(speed - np.mean(speed)), 0, count - 1)
    return np.asarray(CubicSpline(np.arange(count), samples, axis=1)(at), dtype=np.float64)
