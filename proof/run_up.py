"""Speed that is never quite the stated one, and the motion at it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from proof.machine import SETTLE_S, Arrays, FloatArray
from proof.model.layout import DOFS, PINION, STATES, G
from proof.model.motion import march

RATE_HZ = 20_000
OVERSAMPLING = 6
"""Integration steps a sample; halving the step changes accelerations below 8 kHz by less than 1e-4."""
Y_DOFS = (5, 13, 18, 26)
"""Resonators 1 to 4 along y: the end caps where accelerometers stand."""
X_DOFS = (3, 11, 16, 24)
"""Outer rings 1 to 4 along x."""


@dataclass(frozen=True, kw_only=True)
class Speed:
    """Mean speed, Hz, and its slow wander: relative amplitudes, frequencies (Hz) and phases of some sines."""

    mean_hz: float
    amplitudes: FloatArray
    frequencies_hz: FloatArray
    phases: FloatArray

    def angle(self, t: FloatArray) -> FloatArray:
        """Turned angle, rad; 0 at t = 0."""
        w = 2.0 * math.pi * self.mean_hz
        phi = w * t
        for a, f, p in zip(self.amplitudes, self.frequencies_hz, self.phases, strict=True):
            phi = phi + w * a * (math.cos(p) - np.cos(2.0 * math.pi * f * t + p)) / (2.0 * math.pi * f)
        return phi

    def rate(self, t: FloatArray) -> FloatArray:
        """Speed, rad/s."""
        w = 2.0 * math.pi * self.mean_hz
        waves = zip(self.amplitudes, self.frequencies_hz, self.phases, strict=True)
        return w * (1.0 + sum((a * np.sin(2.0 * math.pi * f * t + p) for a, f, p in waves), np.zeros_like(t)))


def steady(mean_hz: float) -> Speed:
    """A perfect drive."""
    nothing = np.zeros(0)
    return Speed(mean_hz=mean_hz, amplitudes=nothing, frequencies_hz=nothing, phases=nothing)


def wandering(mean_hz: float, rms: float, rng: np.random.Generator) -> Speed:
    """A drive whose speed wanders by `rms` (a share of the mean) at 0.3 to 6 Hz."""
    n = 6
    weights = rng.uniform(0.3, 1.0, n)
    return Speed(
        mean_hz=mean_hz,
        amplitudes=rms * math.sqrt(2.0) * weights / float(np.linalg.norm(weights)),
        frequencies_hz=np.geomspace(0.3, 6.0, n) * rng.uniform(0.85, 1.15, n),
        phases=rng.uniform(0.0, 2.0 * math.pi, n),
    )


class Diverged(ValueError):
    """The motion left every bound: the case must be made milder."""


def accelerations(
    machine: Arrays,
    speed: Speed,
    *,
    duration_s: float,
    settle_s: float = SETTLE_S,
    oversampling: int = OVERSAMPLING,
    rate_hz: int = RATE_HZ,
    start_rad: float = 0.0,
    dofs: tuple[int, ...] = (*Y_DOFS, *X_DOFS),
) -> FloatArray:
    """Accelerations of `dofs` after settling, m/s^2, shape (dofs, n) at `oversampling` times `rate_hz`."""
    fine = oversampling * rate_hz
    steps = round((settle_s + duration_s) * fine)
    t = np.arange(2 * steps + 1) / (2.0 * fine)
    q, v, z = np.zeros(DOFS), np.zeros(DOFS), np.zeros(STATES)
    if machine.g[G.RAMP] > 0.0:  # flanks just touch
        q[: PINION + 1 : PINION] = machine.g[G.E0] / machine.g[G.RB1]
    kept = np.empty((steps, len(dofs)))
    phi = start_rad + speed.angle(t)
    done = march(*machine.all(), 1.0 / fine, phi, speed.rate(t), q, v, z, np.array(dofs), kept)
    if done < steps:
        raise Diverged(f"the motion diverged after {done / fine:.4f} s")
    return np.ascontiguousarray(kept[round(settle_s * fine) :].T)
