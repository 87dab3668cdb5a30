"""Whether a damaged tooth shows at a sensor at all: the rule by which a simulated recording keeps its label."""

from __future__ import annotations

import numpy as np
from scipy import fft

from learn.gears.features import WINDOW_TEETH, kept
from learn.gears.turns import Turns
from signals.series import FloatArray

SHOWS_DB = 6.0
"""Errors of all teeth make windows of two to three times the mean: a tooth that is not above those is not told."""
PARTS = 3
LOCKED = 0.05
"""Least share of the change that is locked to the gear; a pair that rattles changes everywhere by anything."""


def tooth_db(sound: Turns, faulty: Turns) -> float:
    """Power that the fault adds to the mean turn in the best window of a tooth, over the mean of what the sound
    machine and the noise leave there beside mesh harmonics with low sidebands; in the best third of the orders, dB.

    The two recordings share machine, chain and noise, so their difference is the fault's own.
    """
    added = faulty.samples - sound.samples
    whole = float(np.mean(added**2))
    mean = np.mean(added, axis=0)
    if whole == 0.0 or float(np.mean(mean**2)) < LOCKED * whole:
        return -np.inf
    n = mean.size
    own, ground = fft.rfft(mean), fft.rfft(np.mean(sound.samples, axis=0))
    scatter = fft.rfft(sound.samples - np.mean(sound.samples, axis=0), axis=1)
    noise = np.mean(np.abs(scatter) ** 2, axis=0) / sound.count
    keep = kept(own.size, sound.teeth)
    best = -np.inf
    for i in range(PARTS):
        inside = keep & (np.arange(own.size) * PARTS // own.size == i)
        below = float(2 * np.sum(np.abs(ground[inside]) ** 2 + noise[inside])) / n**2
        local = _window_power(np.asarray(fft.irfft(np.where(inside, own, 0), n)), sound.teeth)
        best = max(best, float(10 * np.log10(max(local, 1e-300) / max(below, 1e-300))))
    return best


def _window_power(values: FloatArray, teeth: int) -> float:
    width = max(1, round(WINDOW_TEETH * values.size / teeth))
    total = np.cumsum(np.concatenate([[0.0], np.tile(values**2, 2)]))
    return float(np.max(total[width : width + values.size] - total[: values.size])) / width
