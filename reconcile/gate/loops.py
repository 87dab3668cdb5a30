"""One buffer that a recorder wrote again and again: the samples repeat exactly, noise and all.

No machine does that, since its sensor has noise. Its lines stand at multiples of the buffer's rate, some of them near
the mains', which they are not.
"""

from __future__ import annotations

import numpy as np

from reconcile.gate.findings import Finding
from signals.recording import Recording
from signals.series import FloatArray

MATCH = 48
"""Samples in a row, all different from their neighbours, that must come again first."""
LEAST_LAG = 64
SHARE, OFTENER = 0.8, 0.4
"""Of the samples that move, that must come again after one lag, and by how much oftener than after the lag beside it:
of 27 recordings of machines and 4 of a damper at most 0.07 come again after the lag that fits them best."""


def repeated(samples: FloatArray) -> int:
    """The lag, in samples, after which a channel (n,) repeats itself throughout; 0 where it does not."""
    moves = np.flatnonzero(np.diff(samples) != 0.0)
    if samples.size < 4 * LEAST_LAG or moves.size < samples.size // 4:
        return 0
    start = int(moves[moves.size // 4])
    block = samples[start : start + MATCH]
    places = np.arange(start + LEAST_LAG, samples.size - MATCH)
    for k, value in enumerate(block):
        places = places[samples[places + k] == value]
    for place in places[:1]:
        lag = int(place) - start
        if 2 * lag <= samples.size and _again(samples, lag) >= SHARE > OFTENER + _again(samples, lag + 1):
            return lag
    return 0


def loop_findings(recording: Recording, label: str) -> tuple[Finding, ...]:
    """`repeated` for each such channel."""
    rate = recording.sampling_rate_hz
    lags = {name: repeated(row) for name, row in zip(recording.names, recording.samples, strict=True)}
    return tuple(
        Finding(
            kind="repeated",
            channel=name,
            recording=label,
            detail=f"the samples repeat exactly every {lag} ({lag / rate:.4g} s): one buffer, written again and again",
            severity=1.0,
            fault=True,
        )
        for name, lag in lags.items()
        if lag
    )


def _again(samples: FloatArray, lag: int) -> float:
    """Share of the samples that move which come again after a lag."""
    moving = np.diff(samples[: samples.size - lag], prepend=np.nan) != 0.0
    same = samples[: samples.size - lag] == samples[lag:]
    return float(np.mean(same[moving])) if np.any(moving) else 0.0
