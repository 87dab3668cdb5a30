"""Impulses at the rate of the supply: fixed tones that are all multiples of it, up to where the sensor ends.

A drive's commutation, a lamp's ballast, a welder on the same line. Each tone alone is small and only the largest are
found one by one; what is left of the others rings in the envelope like a pit, so all multiples are taken out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import reduce
from math import gcd

import numpy as np
import scipy

from reconcile.gate.mains import MAINS_HZ, SUPPLY
from signals.recording import Recording
from signals.series import FloatArray

FEWEST, SHARE = 6, 0.8
"""Tones that must be multiples of one supply's frequency, and their share of all that were found."""
MISSES_BINS = 1.5
"""By which a tone may miss its multiple: with 0.5 Hz a bin and 50 Hz one of seventeen does by chance."""
BLOCK_S = 1.0
"""Within which the supply's phase is taken as steady."""


def supply_comb(tones_hz: Sequence[float], step_hz: float) -> float | None:
    """Frequency, Hz, of which the tones are multiples, where it is a supply's or a multiple of one; else None.
    `step_hz`: distance of two bins."""
    found = np.asarray(tones_hz, dtype=np.float64)
    best: tuple[int, float] | None = None
    for mains in MAINS_HZ:
        number = np.rint(found / mains)
        near = (number > 0) & (np.abs(found - number * mains) <= SUPPLY * number * mains + step_hz)
        for highest in np.flatnonzero(near):
            base = found[highest] / number[highest]
            close = near & (np.abs(found - number * base) < MISSES_BINS * step_hz)
            if best is None or int(close.sum()) > best[0]:
                every = reduce(gcd, (int(n) for n in number[close]))
                fine = float(number[close] @ found[close] / (number[close] @ number[close]))
                best = int(close.sum()), every * fine
    return best[1] if best is not None and best[0] >= max(FEWEST, SHARE * found.size) else None


def without_comb(recording: Recording, channel: str, base_hz: float) -> Recording:
    """The recording without a channel's sines at all multiples of `base_hz`, fitted in blocks and subtracted."""
    samples = recording.samples.copy()
    row, rate = recording.names.index(channel), recording.sampling_rate_hz
    count = int(0.5 * rate / base_hz)
    fine = _refined(samples[row], base_hz, rate, count)
    blocks = max(1, int(recording.duration_s / BLOCK_S))
    parts = [part - _periodic(part, fine, rate, count) for part in np.array_split(samples[row], blocks)]
    samples[row] = np.concatenate(parts)
    return replace(recording, samples=samples)


def _refined(samples: FloatArray, base_hz: float, rate_hz: float, count: int) -> float:
    """The frequency near `base_hz` whose multiples hold most, Hz: none moves by more than a bin."""
    trial = base_hz + rate_hz / samples.size / count * np.linspace(-1.0, 1.0, 21)
    power = [float(np.sum(np.abs(_lines(samples, hz, rate_hz, count)) ** 2)) for hz in trial]
    return float(trial[int(np.argmax(power))])


def _lines(samples: FloatArray, base_hz: float, rate_hz: float, count: int) -> np.ndarray:
    """Complex amplitudes (count,) of the multiples of a frequency."""
    turn = np.exp(-2j * np.pi * base_hz / rate_hz)
    return np.asarray(2 / samples.size * scipy.signal.czt(samples - samples.mean(), m=count, w=turn, a=1 / turn))


def _periodic(samples: FloatArray, base_hz: float, rate_hz: float, count: int) -> FloatArray:
    """What of a block repeats with `base_hz`."""
    turn = np.exp(-2j * np.pi * base_hz / rate_hz)
    lines = np.concatenate([[0.0], _lines(samples, base_hz, rate_hz, count)])
    return np.asarray(np.real(scipy.signal.czt(lines, m=samples.size, w=1 / turn)))
