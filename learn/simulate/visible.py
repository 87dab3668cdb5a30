"""Whether a fault shows at the sensor at all: the rule by which a simulated recording keeps its label."""

from __future__ import annotations

import numpy as np
from scipy import fft

from signals.series import FloatArray

BANDS = 16
SHOWS_DB = -5.0
"""Power that a fault must add in some band, over what the sound machine and the noise have there. An envelope's lines
grow with the number of impacts, so somewhat less than the background is still seen, and much less is not."""


def visible_db(sound: FloatArray, faulty: FloatArray) -> float:
    """Power the fault adds over the sound recording's (noise included), in the best of equal bands, dB.

    The two recordings share machine, chain and noise, so their difference is the fault's own.
    """
    own = np.abs(fft.rfft(faulty - sound)) ** 2
    ground = np.abs(fft.rfft(sound - np.mean(sound))) ** 2
    edges = np.linspace(1, own.size, BANDS + 1).astype(int)[:-1]
    ratio = np.add.reduceat(own, edges) / np.maximum(np.add.reduceat(ground, edges), 1e-300)
    return float(10 * np.log10(np.max(ratio) + 1e-12))
