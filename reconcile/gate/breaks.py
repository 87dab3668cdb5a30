"""Places at which a record breaks off and goes on elsewhere in all channels at once: blocks that a recorder lost.

What follows a break is not what the signal before it foretells. A blow is not foretold either, so only breaks that
stand far out of all others of the record count, and they are a remark: single knocks may do the same.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import LinAlgError, solve_toeplitz

from reconcile.gate.findings import Finding
from signals.recording import Recording
from signals.series import FloatArray

ORDER, AFTER = 48, 16
"""Samples that foretell the next, and over which the error is averaged."""
USUAL, STANDS_DB, LEAST_DB = 98.0, 6.0, 10.0
"""Percentile of the errors of a record, all channels' least of each place; by which a break stands over it, and over
the middle error."""
LEAST, APART, LEAST_SAMPLES = 2, 256, 8192
FEW, PARTS, EVENLY = 4, 3, 0.08
"""Steps from which on they can be even, parts of the shortest that their period may be, and by how much of it they may
miss its multiples: in the mean 0.25 by chance."""
LOW_DB, HIGH_DB = -12.0, 4.5
"""By which the error at breaks, their median on each channel, may differ from the channel's own power over its middle
error: what follows a break is as large as the signal, a blow as large as it pleases. With the rest above one of 208
records of two sensors and more is told, one with a broken tooth (20 are measured, the others a rig's, gearboxes', made
ones); cut at 12 places all four of a measured motor and 18 of gearboxes are, and none whose signal is mostly noise."""


def breaks(recording: Recording) -> tuple[int, ...]:
    """First samples after the breaks, in order; none where there are fewer than two channels that move."""
    rows = [row for row in recording.samples if np.all(np.isfinite(row)) and np.ptp(row) > 0.0]
    if len(rows) < LEAST or recording.samples.shape[1] < LEAST_SAMPLES:
        return ()
    found = [one for one in map(_error_db, rows) if one is not None]
    if len(found) < len(rows):
        return ()
    errors = np.stack([error for error, _ in found])[:, ORDER:-AFTER]
    least = np.min(errors, axis=0)
    high = np.flatnonzero(least > max(float(np.percentile(least, USUAL)) + STANDS_DB, LEAST_DB))
    if not high.size:
        return ()
    groups = np.split(high, np.flatnonzero(np.diff(high) > APART) + 1)
    tops = [int(g[int(np.argmax(least[g]))]) for g in groups]
    over = np.median(errors[:, tops], axis=1) - np.array([gain for _, gain in found])
    alike = bool(np.all((over >= LOW_DB) & (over <= HIGH_DB)))
    return tuple(k + ORDER for k in tops) if alike and len(tops) >= LEAST and not _regular(tops) else ()


def _regular(places: Sequence[int]) -> bool:
    """Whether places come at multiples of one period, as a damaged tooth strikes; few tell nothing."""
    steps = np.diff(np.asarray(places, dtype=np.float64))
    periods = float(np.min(steps)) / np.arange(1, PARTS + 1)
    longer = np.delete(steps, int(np.argmin(steps)))
    return (
        longer.size + 1 >= FEW
        and min(float(np.mean(np.abs(longer / p - np.rint(longer / p)))) for p in periods) < EVENLY
    )


def break_findings(recording: Recording, label: str) -> tuple[Finding, ...]:
    """A remark of the recording where it breaks off at two places or more."""
    found = breaks(recording)
    if not found:
        return ()
    rate = recording.sampling_rate_hz
    places = ", ".join(f"{recording.start_s + k / rate:.4g}" for k in found[:3])
    return (
        Finding(
            kind="breaks",
            channel="",
            recording=label,
            detail=f"all channels break off at {len(found)} places and go on otherwise, at {places} s"
            f"{' and more' if len(found) > 3 else ''}: blocks that the recorder lost, or single knocks; what was lost "
            "makes lines less sharp",
            severity=0.0,
        ),
    )


def _error_db(samples: FloatArray) -> tuple[FloatArray, float] | None:
    """Mean error over the next samples of what the last ones foretell, dB over its median, shape (n,), and the power of
    the signal over that; None where nothing is foretold."""
    x = samples - np.mean(samples)
    # so few lags are sooner summed than transformed, at lengths with large prime factors a hundred times
    correlation = np.array([x[: x.size - lag] @ x[lag:] for lag in range(ORDER + 1)])
    correlation[0] *= 1.0 + 1e-9
    try:
        taps = np.concatenate(([1.0], -solve_toeplitz(correlation[:-1], correlation[1:])))
    except (LinAlgError, ValueError):
        return None
    error = np.convolve(x, taps)[: x.size] ** 2
    total = np.concatenate(([0.0], np.cumsum(error), np.full(AFTER, np.sum(error))))
    mean = (total[AFTER : AFTER + x.size] - total[: x.size]) / AFTER
    middle = float(np.median(mean))
    if not middle > 0.0:
        return None
    gain_db = 10.0 * float(np.log10(np.mean(x**2) / middle + 1e-12))
    return np.asarray(10.0 * np.log10(mean / middle + 1e-12)), gain_db
