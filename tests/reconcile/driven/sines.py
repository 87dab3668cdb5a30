"""Sums of many sines, which made forces are."""

from __future__ import annotations

import numpy as np

BLOCK = 512


def sines(frequency: np.ndarray, phase: np.ndarray, step: float, count: int) -> np.ndarray:
    """Sum of sin(2 pi f t + phase) at `count` times a step apart, (count,).

    Times are a block's beginning and what is passed of it: one product of two small tables instead of every sine.
    """
    blocks = -(-count // BLOCK)
    omega = 2j * np.pi * frequency
    begin = np.exp(np.outer(np.arange(blocks) * BLOCK * step, omega) + 1j * phase)
    passed = np.exp(np.outer(omega, np.arange(BLOCK) * step))
    return np.asarray((begin @ passed).imag.ravel()[:count])
