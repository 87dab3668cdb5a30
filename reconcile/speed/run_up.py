"""Does the speed change during a recording without pulses? Lines that a run-up smears come back when it is undone.

The samples are read as if the speed rose or fell evenly by a share `c` of its mean, for several c. At the right one the
lines of shafts, teeth and bearings, in the plain spectrum and in envelopes, are sharp; at c = 0 they are, where the
speed holds. Resonances and noise have no sharp lines at any c.
"""

from __future__ import annotations

import numpy as np
from scipy.signal import butter, sosfiltfilt

from signals.recording import Recording
from signals.series import FloatArray

TOP_HZ = 800.0
"""Highest frequency looked at, of signals and of envelopes."""
LONGEST_S = 5.0
MOST_CHANNELS = 3
LARGEST, STEP = 0.8, 0.005
HELD = 0.05
"""Change up to which a speed counts as held: a machine's wander over a short recording looks like it."""
LEAST = 0.1
CLEAR = 6.0
"""Robust deviations of the sharpness over all c that a run-up must show, and `TIMES` what a held speed does. Simulated
run-ups show 17 to 28, a measured recording that was read ever faster 98, held speeds of 63 concealed machines at most
5.7, of measured ones up to 19 where a held speed shows 5 times as much."""
TIMES = 2.0
MIN_SAMPLES = 1024
FAINT = 1e-3
"""Share of the mean power below which nothing is a line: of a noiseless signal, rounding would be."""
BLOCK = 64
"""Bins."""


def speed_change(recording: Recording) -> float | None:
    """Rise (or fall, negative) of the speed from the beginning to the end of the first 5 s, over its mean; None where
    it holds, nothing tells, or pulses do."""
    if recording.tacho is not None or not np.all(np.isfinite(recording.samples)):
        return None
    changes = np.arange(-LARGEST, LARGEST + STEP / 2, STEP)
    rate = recording.sampling_rate_hz
    parts = [
        part
        for row in recording.samples[:MOST_CHANNELS, : int(LONGEST_S * rate)]
        for part in _parts(row - np.mean(row), rate)
    ]
    parts = [p for p in parts if p.size >= MIN_SAMPLES and np.ptp(p) > 0]
    if not parts:
        return None
    score = np.sum([_standard(_sharpness(p, rate / _every(rate), changes)) for p in parts], axis=0) / np.sqrt(
        len(parts)
    )
    held = float(np.max(score[np.abs(changes) <= HELD]))
    best = int(np.argmax(np.where(np.abs(changes) >= LEAST, score, -np.inf)))
    return float(changes[best]) if score[best] >= max(CLEAR, TIMES * held) else None


def _standard(values: FloatArray) -> FloatArray:
    """Robust deviations from the middle; nothing where all are alike."""
    off = values - np.median(values)
    spread = 1.4826 * float(np.median(np.abs(off)))
    return np.asarray(off / spread if spread > 0.0 else 0.0 * off, dtype=np.float64)


def _every(rate_hz: float) -> int:
    return max(1, int(rate_hz // (2.56 * TOP_HZ)))


def _parts(row: FloatArray, rate_hz: float) -> list[FloatArray]:
    """The signal below `TOP_HZ` and the squared envelopes' of bands above it, thinned out."""
    low = butter(6, min(TOP_HZ, 0.45 * rate_hz), fs=rate_hz, output="sos")
    if row.size < MIN_SAMPLES:
        return []
    parts = [row]
    lower, top = TOP_HZ, 0.45 * rate_hz
    while 2 * lower < top:
        upper = min(2.5 * lower, top)
        band = sosfiltfilt(butter(4, [lower, upper], btype="band", fs=rate_hz, output="sos"), row)
        parts.append(band**2)
        lower = upper
    return [np.asarray(_centred(sosfiltfilt(low, p)[:: _every(rate_hz)])) for p in parts]


def _centred(values: FloatArray) -> FloatArray:
    return np.asarray(values - np.mean(values), dtype=np.float64)


def _sharpness(part: FloatArray, rate_hz: float, changes: FloatArray) -> FloatArray:
    """How peaked the spectrum is, read with each of `changes`, shape (changes,): log of the mean square over the
    squared mean power of blocks of bins, summed; log 2 a block in noise."""
    time = np.arange(part.size) / rate_hz
    length = part.size / rate_hz
    window = np.hanning(part.size)
    top = int(min(0.7 * TOP_HZ, 0.4 * rate_hz) * length)
    found = np.empty(changes.size)
    bow = time**2 / length - time
    for k, c in enumerate(changes):
        turns = time + c / 2 * bow  # of a speed from 1 - c/2 to 1 + c/2: even steps of these are even angles
        even = np.interp(time, turns, part)
        power = np.abs(np.fft.rfft(even * window)[:top]) ** 2
        power += FAINT * np.mean(power)
        blocks = power[: power.size // BLOCK * BLOCK].reshape(-1, BLOCK)
        found[k] = np.sum(np.log(BLOCK * np.sum(blocks**2, axis=1) / np.sum(blocks, axis=1) ** 2))
    return found
