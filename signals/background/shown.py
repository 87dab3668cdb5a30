"""How much of a fault a recording shows over the same machine without it."""

from __future__ import annotations

import numpy as np
from scipy import fft

from signals.series import FloatArray

BANDS = 16


def shown_db(sound: FloatArray, faulty: FloatArray) -> float:
    """Power the fault adds over the sound recording's (noise included), in the best of 16 equal bands, dB.

    Both have shape (n,). They share machine, chain and noise, so that their difference is the fault's own.
    """
    own = np.abs(fft.rfft(faulty - sound)) ** 2
    ground = np.abs(fft.rfft(sound - np.mean(sound))) ** 2
    edges = np.linspace(1, own.size, BANDS + 1).astype(int)[:-1]
    ratio = np.add.reduceat(own, edges) / np.maximum(np.add.reduceat(ground, edges), 1e-300)
    return float(10 * np.log10(np.max(ratio) + 1e-12))
