"""Single samples far out of a channel: a switch, a plug or a lost bit. What a machine does rings on.

They are filled from the samples around and told; a few are no fault: left in, three of 200 deviations hid a pit in a
short record (made). Many, which the baseline has not, are one: of a contact, a cable or what sparks beside it. What
comes evenly is a machine's, however short: a contact of 40 us at 20 kHz is one sample where nothing rings on.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.gate.bridge import FILLED, bridged
from reconcile.gate.findings import Finding
from signals.recording import Recording
from signals.series import FloatArray, IntArray

FAR = 30.0
"""Robust deviations of what neighbours do not tell of a sample, from which it is a spike: noise stays below 6."""
ALONE = 5.0
"""Times as far out as all within `REACH` samples: a blow rings on, or comes with more than one sample."""
REACH = 12
FEW, FEWEST = 2e-4, 10
"""Share of the samples, and their number, up to which spikes are no fault."""
MOST_SHARE = 0.01
"""More than this share of the samples are no single ones, but how the signal is."""
MOST_FAR = 0.05
"""Share of the samples that may be far out, alone or not, for single ones to be looked for."""
BESIDE = 2
"""Samples within which another one far out is the same blow."""
LISTED = 5
EVEN, MULTIPLES, EVEN_SHARE = 0.08, 8, 0.75
"""Distances that lie within so much of a period of its first multiples, and the share of them from which blows are
even. Of 10 moments at random at most 0.67 do (400 tries), of more fewer; of even ones, half of them missed, 0.86."""
ASKED = 60
"""Distances that are tried as a period, or twice or three times one."""


def spike_findings(recording: Recording, label: str) -> tuple[Finding, ...]:
    """`spikes` of each channel, with the times of the first."""
    found = []
    for name, samples in zip(recording.names, recording.samples, strict=True):
        places = spikes(samples)
        if not places.size:
            continue
        times = ", ".join(f"{recording.start_s + p / recording.sampling_rate_hz:.6g}" for p in places[:LISTED])
        more = " and more" if places.size > LISTED else ""
        one = places.size == 1
        detail = (
            f"{places.size} single sample{'' if one else 's'} stand{'s' if one else ''} far out of the signal, "
            f"at {times} s{more}; no machine's, which rings on: {FILLED}"
        )
        share = float(places.size / samples.size)
        found.append(
            Finding(
                kind="spikes", channel=name, recording=label, detail=detail, severity=share,
                fault=places.size > FEWEST and share > FEW,
            )
        )  # fmt: skip
    return tuple(found)


def without_spikes(recording: Recording) -> Recording:
    """The recording with its spikes filled."""
    rows = recording.samples.copy()
    for row in rows:
        gone = np.zeros(row.size, dtype=np.bool_)
        gone[spikes(row)] = True
        row[:] = bridged(row, gone) if np.any(gone) else row
    return replace(recording, samples=rows)


def spikes(samples: FloatArray) -> IntArray:
    """Places (spikes,) of samples (n,) that stand far out alone; none where they are too many to be single ones, or
    come evenly."""
    if samples.size < 4 * REACH or not np.all(np.isfinite(samples)):
        return np.zeros(0, dtype=np.int64)
    off = np.zeros(samples.size)
    off[1:-1] = np.abs(samples[1:-1] - (samples[:-2] + samples[2:]) / 2)
    usual = 1.4826 * float(np.median(off))
    far = np.flatnonzero(off > FAR * usual) if usual > 0.0 else np.zeros(0, dtype=np.int64)
    if far.size > MOST_FAR * samples.size:
        return far[:0]
    found = np.array([p for p in far if _alone(samples, int(p), far)], dtype=np.int64)
    few = found.size <= max(1.0, MOST_SHARE * samples.size)
    return found if few and not even(found) else found[:0]


def even(places: IntArray) -> bool:
    """Whether most distances between neighbours are multiples of one: some blows may be missed, and balls slip."""
    if places.size < FEWEST:
        return False
    gaps = np.diff(places).astype(np.float64)
    tried = np.unique(np.quantile(gaps, np.linspace(0.0, 1.0, min(gaps.size, ASKED))))
    periods = np.concatenate([tried, tried / 2.0, tried / 3.0])
    times = gaps[None, :] / periods[periods >= 1.0 / EVEN][:, None]
    whole = np.round(times)
    met = (np.abs(times - whole) <= EVEN) & (whole >= 1) & (whole <= MULTIPLES)
    return bool(np.max(np.mean(met, axis=1), initial=0.0) >= EVEN_SHARE)


def _alone(samples: FloatArray, place: int, far: IntArray) -> bool:
    """Whether nothing within reach is nearly as far out, other spikes apart."""
    first, last = max(place - REACH, 0), min(place + REACH + 1, samples.size)
    others = far[np.searchsorted(far, first) : np.searchsorted(far, last)]
    kept = np.ones(last - first, dtype=np.bool_)
    kept[others[np.abs(others - place) > BESIDE] - first] = False
    kept[place - first] = False
    beside = samples[first:last][kept]
    middle = float(np.median(beside))
    return bool(abs(samples[place] - middle) > ALONE * float(np.max(np.abs(beside - middle))))
