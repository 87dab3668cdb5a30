"""What a rigid-contact model leaves out and a real bearing has: rolling noise, a ball's free axis, chance knocks.

All of it is added to, or done to, the simulated motion before the measurement chain.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.interpolate import CubicSpline

from learn.orders import FaultOrders
from signals.series import FloatArray


def log_uniform(rng: np.random.Generator, low: float, high: float) -> float:
    """A number between the two, even on a logarithmic scale."""
    return float(np.exp(rng.uniform(math.log(low), math.log(high))))


def smooth_walk(rng: np.random.Generator, samples: int, rate_hz: float, step_s: float) -> FloatArray:
    """Standard normal knots every `step_s`, linear between, shape (samples,)."""
    knots = rng.standard_normal(int(samples / rate_hz / step_s) + 3)
    return np.interp(np.arange(samples) / (rate_hz * step_s), np.arange(knots.size), knots)


def rolling_noise(rng: np.random.Generator, angle_rad: FloatArray, orders: FaultOrders) -> FloatArray:
    """Noise of rough surfaces in rolling, RMS 1, (2, n): its level follows load and passing balls.

    Rough contact gives noise whose power is periodic (J. Antoni and R. B. Randall, J. Vib. Acoust. 125 (2003)
    282-289), so sound bearings show weak lines at their own orders too; one line of something else beside them.
    """
    level = np.ones(angle_rad.size)
    foreign = (log_uniform(rng, 0.5, 12.0), 0.3)
    for order, most in (
        foreign,
        (1.0, 0.6),
        (2.0, 0.4),
        (orders.outer, 0.5),
        (orders.inner, 0.4),
        (orders.ball, 0.3),
        (orders.cage, 0.4),
    ):
        phase = rng.uniform(0, 2 * np.pi)
        depth = log_uniform(rng, 0.01, most)
        level += depth * np.cos(order * angle_rad + phase) + 0.3 * depth * np.cos(2 * (order * angle_rad + phase))
    noise = rng.standard_normal((2, angle_rad.size)) * np.sqrt(np.maximum(level, 0.0))
    return np.asarray(noise / np.std(noise), dtype=np.float64)


def knocks(rng: np.random.Generator, samples: int, rate_hz: float) -> FloatArray:
    """Impulses at random times, up to 500 a second, of exponential height, RMS 1, (2, n); in three of five machines.

    Dirt, rough lubrication, play and neighbours: sound machines are seldom Gaussian.
    """
    values = np.zeros((2, samples))
    if rng.random() < 0.4:
        return values
    count = rng.poisson(log_uniform(rng, 0.2, 500.0) * samples / rate_hz)
    if count:
        at = rng.integers(0, samples, count)
        angle = rng.uniform(0, 2 * np.pi)
        heights = rng.exponential(1.0, count) * rng.choice([-1.0, 1.0], count)
        values[0, at], values[1, at] = heights * np.cos(angle), heights * np.sin(angle)
        values /= np.sqrt(np.mean(values**2))
    return values


def neighbours(
    rng: np.random.Generator, samples: int, rate_hz: float, speed_hz: float, share: float = 0.4
) -> FloatArray:
    """Regular impulses of something else (another bearing, a gear, a belt, an inverter), RMS 1, (2, n).

    One to three trains at any rate between 0.3 and 13 a turn, steady or slipping, each impulse as high as the last or
    up to three times as high once a turn of a slower part; in `share` of the machines, sound or not.
    """
    values = np.zeros((2, samples))
    if rng.random() >= share:
        return values
    for _ in range(int(rng.integers(1, 4))):
        period = rate_hz / (speed_hz * log_uniform(rng, 0.3, 13.0))
        count = int(samples / period) - 1
        slip = log_uniform(rng, 1e-4, 0.02) * np.cumsum(rng.standard_normal(count))
        at = np.rint((np.arange(count) + rng.uniform(0.0, 1.0) + slip) * period).astype(np.int64)
        inside = (at >= 0) & (at < samples)
        slow = rng.uniform(0.02, 0.5) * np.arange(count) + rng.uniform(0.0, 1.0)
        heights = 1 + rng.uniform(0.0, 0.5) * np.cos(2 * np.pi * slow) + 0.2 * rng.standard_normal(count)
        angle, size = rng.uniform(0, 2 * np.pi), log_uniform(rng, 0.1, 1.0)
        for row, part in enumerate((np.cos(angle), np.sin(angle))):
            np.add.at(values[row], at[inside], size * part * heights[inside])
    return np.asarray(values / max(float(np.sqrt(np.mean(values**2))), 1e-30), dtype=np.float64)


def free_axis(
    rng: np.random.Generator, fault: FloatArray, rate_hz: float, spin_hz: float, cage_hz: float
) -> FloatArray:
    """What a spall on a ball adds, (2, n), when the ball's axis is free.

    The simulated ball turns about one axis in step with the cage. A real one is held by friction only: in the unloaded
    zone its spin slips, so the phase of the impacts changes from one turn of the cage to the next, and its axis
    wanders, so the spall lies in the rolling track for some time and beside it for some.
    """
    samples = fault.shape[1]
    inside = 3.0 * smooth_walk(rng, samples, rate_hz, log_uniform(rng, 0.02, 1.0)) + rng.uniform(-2.0, 5.0)
    shift_s = log_uniform(rng, 0.01, 1.0) / spin_hz * smooth_walk(rng, samples, rate_hz, 1.0 / cage_hz)
    at = np.arange(samples) + shift_s * rate_hz
    moved = np.stack([np.interp(at, np.arange(samples), row) for row in fault])
    return np.asarray(moved / (1.0 + np.exp(-inside)), dtype=np.float64)


def warped(samples: FloatArray, rate_hz: float, share: float, step_s: float, seed: int) -> FloatArray:
    """Samples (c, n) of a machine whose speed wanders by the RMS `share`, with knots every `step_s`."""
    count = samples.shape[1]
    speed = share * smooth_walk(np.random.default_rng(seed), count, rate_hz, step_s)
    at = np.clip(np.arange(count) + np.cumsum(speed - np.mean(speed)), 0, count - 1)
    return np.asarray(CubicSpline(np.arange(count), samples, axis=1)(at), dtype=np.float64)
