"""The pilot: a short stretch with a step and with half of it, and the difference between the two."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sim.core.response import FloatArray

AT_REST = 0.01
"""Level of an output in the second half of the pilot, over its level in all of it, below which it has come to rest."""
SUFFIX = ".acceleration"


def pilot_channels(names: Sequence[str]) -> tuple[str, ...]:
    """The outputs that are judged, then the displacement of each that is an acceleration, else itself once more."""
    return (*names, *(n.removesuffix(SUFFIX) + ".displacement" if n.endswith(SUFFIX) else n for n in names))


def _rms(signals: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt(np.mean(signals**2, axis=1)))


def step_difference(coarse: FloatArray, fine: FloatArray) -> float:
    """Worst relative L2 difference of (channels, samples) with a step and with half of it, over the second half.

    The difference of an output is taken over what it moves in that half. One that has come to rest (a mass that sticks,
    a ring-down that is over) moves by rounding and tolerance only: there the difference is taken over its level in the
    whole pilot, of the output and of its displacement, whichever is worse. Channels as `pilot_channels` gives them.
    """
    half, judged = coarse.shape[1] // 2, coarse.shape[0] // 2
    difference = _rms(coarse[:, half:] - fine[:, half:])
    size = _rms(fine[:, half:] - fine[:, half:].mean(axis=1, keepdims=True))[:judged]
    whole = np.maximum(_rms(fine), 1e-300)
    level = float(size.max(initial=0.0))
    kept = size > 1e-9 * level if level > 0 else size > 0
    by_itself = difference[:judged] / np.maximum(size, 1e-300)
    by_level = np.maximum(difference[:judged] / whole[:judged], difference[judged:] / whole[judged:])
    found = np.where(size < AT_REST * whole[:judged], np.minimum(by_itself, by_level), by_itself)
    return float(np.max(found[kept])) if np.any(kept) else 0.0
