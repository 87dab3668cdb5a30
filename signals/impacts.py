"""Impacts in the time signal: when a contact closes, opens and is struck, and where in the revolution that is.

A contact is read from its state (1 touching, 0 free) and its force, both sampled at the rate of the record: what is
shorter than a sample may be missed. `touch` and `release` are changes of state. A force peak that stands out by
`PROMINENCE` of the force's range is an `impact` when it is the first after a flight, and a `surge` while the contact
lasts: a ring that its load holds against the wall is pressed by every tooth, but does not strike.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import scipy

from signals.series import BoolArray, FloatArray, IntArray

EventKind = Literal["touch", "release", "impact", "surge"]
KINDS: tuple[EventKind, ...] = ("touch", "release", "impact", "surge")
PROMINENCE = 0.25
"""Share of the force's range (0.5 to 99.5 %) by which a peak must stand above both sides."""
BINS = 36
MAX_EVENTS = 1000
"""Events listed of one contact, the strongest; counts and histograms hold all."""
LOCKED = 1e-3
"""Chance below which events are said to keep time with a period (Rayleigh test)."""


@dataclass(frozen=True, kw_only=True)
class Contact:
    """State (n,) and force (n,) N of one contact; `periods_hz` are the bases that its events are folded on."""

    name: str
    site: str
    touching: FloatArray
    force_n: FloatArray
    periods_hz: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Event:
    """One event. `force_n` is the peak for impacts and surges; `angle_deg` by shaft base, 0..360 from t = 0."""

    time_s: float
    contact: str
    kind: EventKind
    force_n: float | None
    angle_deg: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class Fold:
    """Force peaks over one period: `counts` in equal parts of it and the mean of the peaks there, N (None where
    there is none); `per_period` on average.

    `coherence` is the mean resultant length of the phases, 0 spread to 1 all at one place; `chance` that of as much in
    unrelated events, exp(-n R^2) (Rayleigh test; K. V. Mardia and P. E. Jupp, Directional Statistics, 2000, 6.3).
    """

    base: str
    frequency_hz: float
    counts: tuple[int, ...]
    mean_force_n: tuple[float | None, ...]
    per_period: float
    coherence: float
    chance: float
    mean_phase: float
    """Where in the period the events gather, 0..1."""

    @property
    def locked(self) -> bool:
        """Whether the events keep time with the period."""
        return self.chance < LOCKED


@dataclass(frozen=True, kw_only=True)
class ContactImpacts:
    """What one contact went through in `duration_s`."""

    contact: str
    site: str
    counts: Mapping[EventKind, int]
    contact_share: float
    largest_force_n: float
    rate_hz: float
    """Impacts and surges a second."""
    folds: tuple[Fold, ...]
    events: tuple[Event, ...]
    truncated: int
    """Events not listed."""


def find_impacts(
    contact: Contact, *, sampling_rate_hz: float, start_s: float, shafts_hz: Mapping[str, float]
) -> ContactImpacts:
    """Events of a contact whose first sample is at `start_s`; shaft angles count from t = 0 at the mean speeds."""
    touching = contact.touching > 0.5
    edges = np.diff(touching.astype(np.int8))
    touch, release = np.flatnonzero(edges > 0) + 1, np.flatnonzero(edges < 0) + 1
    peaks = _force_peaks(contact.force_n, touching)
    impact = _first_of_episode(peaks, touch)
    marks: dict[EventKind, IntArray] = {
        "touch": touch,
        "release": release,
        "impact": peaks[impact],
        "surge": peaks[~impact],
    }
    duration_s = touching.size / sampling_rate_hz
    times = start_s + peaks / sampling_rate_hz
    events = [
        _event(contact, kind, int(i), sampling_rate_hz, start_s, shafts_hz) for kind in KINDS for i in marks[kind]
    ]
    listed = sorted(events, key=lambda e: (-(e.force_n or 0.0), e.time_s))[:MAX_EVENTS]
    return ContactImpacts(
        contact=contact.name,
        site=contact.site,
        counts={kind: int(marks[kind].size) for kind in KINDS},
        contact_share=float(np.mean(touching)),
        largest_force_n=float(np.max(contact.force_n, initial=0.0)),
        rate_hz=peaks.size / duration_s,
        folds=tuple(
            fold(times, contact.force_n[peaks], base, hz, duration_s) for base, hz in contact.periods_hz.items()
        ),
        events=tuple(sorted(listed, key=lambda e: (e.time_s, e.kind))),
        truncated=len(events) - len(listed),
    )


def fold(
    times_s: FloatArray, force_n: FloatArray, base: str, frequency_hz: float, duration_s: float, bins: int = BINS
) -> Fold:
    """Events (events,) and their forces folded on the period 1 / `frequency_hz`, phase 0 at t = 0."""
    phase = np.mod(times_s * frequency_hz, 1.0)
    place = np.minimum((phase * bins).astype(np.int64), bins - 1)
    counts = np.bincount(place, minlength=bins)
    sums = np.bincount(place, weights=force_n, minlength=bins)
    mean = complex(np.mean(np.exp(2j * np.pi * phase))) if phase.size else 0j
    return Fold(
        base=base,
        frequency_hz=frequency_hz,
        counts=tuple(int(n) for n in counts),
        mean_force_n=tuple(float(total / n) if n else None for total, n in zip(sums, counts, strict=True)),
        per_period=phase.size / (duration_s * frequency_hz),
        coherence=abs(mean),
        chance=float(np.exp(-phase.size * abs(mean) ** 2)),
        mean_phase=float(np.mod(np.angle(mean) / (2 * np.pi), 1.0)),
    )


def _force_peaks(force_n: FloatArray, touching: BoolArray) -> IntArray:
    """Samples of the force peaks that stand out, while touching."""
    low, high = np.percentile(force_n, (0.5, 99.5))
    largest = float(np.max(np.abs(force_n), initial=0.0))
    if high - low <= 1e-6 * largest:
        high = largest  # rare impacts in a long flight leave the percentiles at zero
    if high - low <= 1e-6 * largest or largest == 0.0:
        return np.zeros(0, dtype=np.int64)
    # a filtered force rings below zero around an impact: that is no force
    found, _ = scipy.signal.find_peaks(np.maximum(force_n, 0.0), prominence=PROMINENCE * (high - max(low, 0.0)))
    # the filter may move a short impact's peak by a sample from where the state was seen
    wide = np.convolve(np.asarray(touching, dtype=np.float64), np.ones(3), mode="same") > 0
    return np.asarray(found[wide[found]], dtype=np.int64)


def _first_of_episode(peaks: IntArray, touch: IntArray) -> BoolArray:
    """Whether each peak is the first since the contact closed, shape (peaks,)."""
    episode = np.searchsorted(touch, peaks + 1, side="right")
    return np.asarray((episode > 0) & (np.diff(episode, prepend=0) > 0), dtype=np.bool_)


def _event(
    contact: Contact, kind: EventKind, sample: int, rate_hz: float, start_s: float, shafts_hz: Mapping[str, float]
) -> Event:
    time_s = start_s + sample / rate_hz
    return Event(
        time_s=time_s,
        contact=contact.name,
        kind=kind,
        force_n=float(contact.force_n[sample]) if kind in ("impact", "surge") else None,
        angle_deg={base: float(np.mod(360.0 * hz * time_s, 360.0)) for base, hz in shafts_hz.items()},
    )
