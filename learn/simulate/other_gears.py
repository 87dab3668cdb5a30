"""What a pair of gears on springs leaves out and a gearbox has: other meshes, modulation by paths and couplings."""

from __future__ import annotations

import numpy as np

from learn.simulate.background import log_uniform
from signals.series import FloatArray

LOW_ORDERS = 4
"""Sound shafts modulate at their first few orders."""
SHARE = 0.6
"""Of the machines have other meshes."""


def modulation(rng: np.random.Generator, angle_rad: FloatArray, ratio: float) -> FloatArray:
    """Gain of the way from the teeth to a sensor over both shafts' turns, mean about 1, (n,).

    Run-out, couplings with jaws, bearings and a load zone modulate what the teeth make at low orders (R. B. Randall,
    Vibration-based Condition Monitoring, 2nd ed. 2021, ch. 2), in sound gearboxes often strongly.
    """
    gain = np.ones(angle_rad.size)
    for shaft in (1.0, ratio):
        for order in range(1, LOW_ORDERS + 1):
            depth = log_uniform(rng, 0.005, 0.6) / np.sqrt(order)
            gain += depth * np.cos(order * shaft * angle_rad + rng.uniform(0, 2 * np.pi))
    return np.asarray(gain, dtype=np.float64)


def twist_rad(rng: np.random.Generator, angle_rad: FloatArray, ratio: float) -> FloatArray:
    """Angle by which the driving shaft is ahead over both shafts' turns, (n,): it modulates the teeth's phase."""
    ahead = np.zeros(angle_rad.size)
    for shaft in (1.0, ratio):
        for order in range(1, LOW_ORDERS + 1):
            size = log_uniform(rng, 5e-5, 1e-2) / order
            ahead += size * np.cos(order * shaft * angle_rad + rng.uniform(0, 2 * np.pi))
    return np.asarray(ahead, dtype=np.float64)


def other_mesh(rng: np.random.Generator, angle_rad: FloatArray, ratio: float, rate_hz: float) -> FloatArray:
    """One to three other stages, sound ones, RMS 1, (2, n): harmonics of their meshes with low sidebands.

    Some are driven by the output shaft, so their teeth stand still in its mean turn; others turn at any speed.
    """
    values = np.zeros((2, angle_rad.size))
    if rng.random() >= SHARE:
        return values
    top = 0.45 * rate_hz * 2 * np.pi / max(float(np.mean(np.diff(angle_rad))) * rate_hz, 1e-9)
    for _ in range(int(rng.integers(1, 4))):
        shaft = ratio if rng.random() < 0.5 else log_uniform(rng, 0.1, 3.0)
        teeth = int(rng.integers(14, 61))
        other = teeth / int(rng.integers(18, 111))
        size, direction = log_uniform(rng, 0.1, 1.0), rng.uniform(0, 2 * np.pi)
        train = np.zeros(angle_rad.size)
        for k in range(1, 6):
            if k * teeth * shaft > top:
                break
            phase = rng.uniform(0, 2 * np.pi)
            train += rng.exponential(1.0) / k * np.cos(k * teeth * shaft * angle_rad + phase)
        train *= modulation(rng, shaft * angle_rad, other)
        values[0] += size * np.cos(direction) * train
        values[1] += size * np.sin(direction) * train
    return np.asarray(values / max(float(np.sqrt(np.mean(values**2))), 1e-30), dtype=np.float64)
