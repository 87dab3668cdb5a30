"""Does the speed change during a recording without pulses? Lines that a run-up smears come back when it is undone.

The samples are read as if the speed rose or fell evenly by a share `c` of its mean, for several c. At the right one the
lines of shafts, teeth and bearings, in the plain spectrum and in envelopes, are narrow; at c = 0 they are, where the
speed holds. Resonances, noise and irregular impacts have no narrow lines at any c.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import scipy
from scipy.fft import prev_fast_len, rfft

from reconcile.compiled.speeds import narrow_lines, read_at
from reconcile.speed.excess import mains_bins
from signals.recording import Recording
from signals.series import FloatArray

TOP_HZ = 800.0
"""Highest frequency looked at, of signals and of envelopes."""
WINDOW_S = 5.0
"""Length of the stretches that are looked at: the first, and of longer recordings the last."""
MOST_CHANNELS = 3
LARGEST, STEP = 1.2, 0.005
HELD = 0.03
"""Change up to which a speed counts as held: a machine's wander over a short recording looks like it."""
LEAST = 0.06
LINES = 3
"""Narrow lines that must come back, more than a held speed has."""
SURE = 0.1
"""Change from which both halves must rise, or both fall: a speed that swings to and fro does neither."""
STRONG = 60.0
"""Power of a narrow line over the median around it: noise and irregular impacts, whose bins are exponential or fewer
than this many impacts, do not reach it."""
NARROW, BESIDE = 3, 8.0
"""Bins to either side beyond which a narrow line has fallen to a share of one in `BESIDE`."""
BLOCK = 64
MIN_SAMPLES = 1024
FAINT = 1e-4
"""Share of the mean power below which nothing is a line: of a noiseless signal, rounding would be."""
COVERED = 0.8
"""Share of a recording that its pulses must cover to follow the speed by them."""


def speed_change(recording: Recording) -> float | None:
    """Rise (or fall, negative) of the speed over its mean, from the beginning to the end of the first or the last 5 s
    (the larger); None where it holds, nothing tells, or pulses do. Values of `LARGEST` mean as much or more."""
    if _followed(recording) or not np.all(np.isfinite(recording.samples)):
        return None
    size = int(WINDOW_S * recording.sampling_rate_hz)
    rows = recording.samples[:MOST_CHANNELS]
    stretches = [rows[:, :size]] if rows.shape[1] < 2 * size else [rows[:, :size], rows[:, -size:]]
    found = [c for s in stretches if (c := _change(s, recording.sampling_rate_hz)) is not None]
    return max(found, key=abs, default=None)


def _followed(recording: Recording) -> bool:
    """Whether there are pulses nearly all along."""
    if recording.tacho is None:
        return False
    times = recording.tacho.pulse_times_s
    return bool(np.ptp(times) >= COVERED * recording.duration_s)


def _change(rows: FloatArray, rate_hz: float) -> float | None:
    changes = np.arange(-LARGEST, LARGEST + STEP / 2, STEP)
    parts = [p for row in rows for p in _parts(row - np.mean(row), rate_hz)]
    parts = [p for p in parts if p.size >= MIN_SAMPLES and np.ptp(p) > 0]
    if not parts:
        return None
    count = _most_lines(parts, rate_hz, changes)
    moved = np.where(np.abs(changes) >= LEAST, count, 0)
    if np.max(moved) < LINES + np.max(count[np.abs(changes) <= HELD]):
        return None
    best = float(np.median(changes[moved == np.max(moved)]))
    half = min(p.size for p in parts) // 2
    if abs(best) < SURE or half < MIN_SAMPLES:
        return best
    same = best * np.linspace(0.25, 0.75, 21)
    for part in ([p[:half] for p in parts], [p[-half:] for p in parts]):
        if np.max(_most_lines(part, rate_hz, same)) <= np.max(_most_lines(part, rate_hz, -same)):
            return None
    return best


def _most_lines(parts: Sequence[FloatArray], rate_hz: float, changes: FloatArray) -> FloatArray:
    """Narrow lines of the part that has most of them, at each of `changes`."""
    sizes = {p.size for p in parts}
    alike = [np.stack([p for p in parts if p.size == size]) for size in sizes]
    found = [_narrow_lines(some, rate_hz / _every(rate_hz), changes) for some in alike]
    return np.asarray(np.max(np.concatenate(found), axis=0), dtype=np.float64)


def _every(rate_hz: float) -> int:
    return max(1, int(rate_hz // (2.56 * TOP_HZ)))


def _parts(row: FloatArray, rate_hz: float) -> list[FloatArray]:
    """The signal below `TOP_HZ` and the squared envelopes' of bands above it, thinned out."""
    low = scipy.signal.butter(6, min(TOP_HZ, 0.45 * rate_hz), fs=rate_hz, output="sos")
    if row.size < MIN_SAMPLES:
        return []
    parts = [row]
    lower, top = TOP_HZ, 0.45 * rate_hz
    while 2 * lower < top:
        upper = min(2.5 * lower, top)
        band = scipy.signal.sosfiltfilt(
            scipy.signal.butter(4, [lower, upper], btype="band", fs=rate_hz, output="sos"), row
        )
        parts.append(band**2)
        lower = upper
    return [np.asarray(_centred(scipy.signal.sosfiltfilt(low, p)[:: _every(rate_hz)])) for p in parts]


def _centred(values: FloatArray) -> FloatArray:
    return np.asarray(values - np.mean(values), dtype=np.float64)


def _narrow_lines(parts: FloatArray, rate_hz: float, changes: FloatArray) -> FloatArray:
    """Narrow lines of the spectra of `parts` (parts, n), read with each of `changes`, shape (parts, changes); those of
    the mains left out."""
    parts = np.ascontiguousarray(parts[:, : prev_fast_len(parts.shape[1], real=True)])
    size = parts.shape[1]
    time = np.arange(size) / rate_hz
    length = size / rate_hz
    window = np.hanning(size)
    top = max(int(min(TOP_HZ, 0.4 * rate_hz) * length), BLOCK)
    found = np.empty((parts.shape[0], changes.size))
    bow = time**2 / length - time
    mains = mains_bins(top, 1.0 / length)
    nothing = np.zeros(top, dtype=np.bool_)
    read = np.empty_like(parts)
    for k, c in enumerate(changes):
        turns = time + c / 2 * bow  # of a speed from 1 - c/2 to 1 + c/2: even steps of these are even angles
        read_at(parts, time, turns, window, read)
        spectra = rfft(read)[:, :top]
        power = spectra.real**2 + spectra.imag**2
        power += FAINT * np.mean(power, axis=1, keepdims=True)
        out = mains if abs(c) < STEP else nothing
        found[:, k] = [narrow_lines(row, out, BLOCK, STRONG, NARROW, BESIDE) for row in power]
    return found
