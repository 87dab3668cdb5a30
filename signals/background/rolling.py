"""Noise of rough surfaces in rolling: its level follows load and passing balls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.series import FloatArray

SECOND = 0.3
"""Depth of a carrier's second harmonic over that of its first."""


@dataclass(frozen=True, kw_only=True)
class Carrier:
    """What the noise's power follows: a phase, shape (n,), rad, and how far, 0 to 1."""

    phase_rad: FloatArray
    depth: float


def rolling_noise(rng: np.random.Generator, samples: int, carriers: Sequence[Carrier]) -> FloatArray:
    """White noise whose power follows the carriers, in x and y alike, RMS 1 of all, shape (2, samples).

    Rough contact gives noise whose power is periodic (J. Antoni and R. B. Randall, J. Vib. Acoust. 125 (2003)
    282-289), so sound bearings show weak lines at their own orders too.
    """
    power = np.ones(samples)
    for one in carriers:
        power += one.depth * (np.cos(one.phase_rad) + SECOND * np.cos(2 * one.phase_rad))
    noise = rng.standard_normal((2, samples)) * np.sqrt(np.maximum(power, 0.0))
    return np.asarray(noise / np.std(noise), dtype=np.float64)
