"""What is wrong with a recording's samples, with the place: found and reported, never repaired silently."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from signals.recording import Recording
from signals.series import BoolArray, FloatArray, IntArray

FindingKind = Literal["not_finite", "constant", "stuck", "dropout", "clipping", "silent", "noise"]
"""`silent` and `noise` are told where channels are held against each other, not by `inspect`."""
_Found = tuple[FindingKind, str, IntArray]
STUCK_SAMPLES = 32
"""A converter repeats a value a few times near an extreme; 32 equal values in a moving signal is a fault."""
CLIPPED_RUN = 3
OVERSHOOT_SHARE = 0.02
"""A run at the extreme is clipping when the slope before it would have carried the signal 2 % of its range beyond."""
FARTHEST = 50.0
"""Ranges beyond which no clipped signal goes, however high its gain: one that would was not there."""
MAX_PLACES = 20


@dataclass(frozen=True, kw_only=True)
class Place:
    """Samples `first` up to and without `stop`, at `start_s` <= t < `stop_s`."""

    first: int
    stop: int
    start_s: float
    stop_s: float


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One defect of one channel: `places` lists the first stretches, `count` and `samples` cover all."""

    channel: str
    kind: FindingKind
    message: str
    count: int
    samples: int
    places: tuple[Place, ...]


def inspect(recording: Recording) -> tuple[Finding, ...]:
    """Defects of every channel: samples that are not finite, constant channels, stuck stretches, dropouts, clipping.

    dropout: at least 32 zeros in a row; stuck: 32 equal other values; clipping: runs of at least 3 samples
    at the largest or smallest value that the signal enters too steeply to be turning there.
    """
    return tuple(
        _finding(recording, name, kind, message, runs)
        for name, samples in zip(recording.names, recording.samples, strict=True)
        for kind, message, runs in defects(samples)
    )


def defects(samples: FloatArray) -> tuple[_Found, ...]:
    """Kind, words and stretches (first, stop), (runs, 2), of every defect of one channel (n,); see `inspect`."""
    finite = np.isfinite(samples)
    found: list[_Found] = [("not_finite", "samples are not finite numbers", _runs(~finite))]
    if samples.size > 1 and np.any(finite) and np.ptp(samples[finite]) == 0:
        found.append(("constant", "the channel never changes", np.array([[0, samples.size]])))
    else:
        found += _stretches(samples)
    return tuple(one for one in found if len(one[2]))


def held(samples: FloatArray) -> BoolArray:
    """Samples (n,) of stuck stretches, dropouts and constant channels: where nothing was measured, shape (n,)."""
    if samples.size > 1 and np.all(samples == samples[0]):
        return np.ones(samples.size, dtype=np.bool_)
    mask = np.zeros(samples.size + 1, dtype=np.int64)
    for kind, _, runs in _stretches(samples):
        if kind in ("stuck", "dropout"):
            mask[runs[:, 0]] += 1
            mask[runs[:, 1]] -= 1
    return np.asarray(np.cumsum(mask)[:-1] > 0, dtype=np.bool_)


def _stretches(samples: FloatArray) -> list[_Found]:
    """Equal-value runs of a channel that moves, told apart by value and length; what is not finite equals nothing."""
    samples = np.where(np.isfinite(samples), samples, np.nan)
    equal = _runs(np.concatenate(([False], np.diff(samples) == 0)))
    if not len(equal):
        return []
    equal[:, 0] -= 1  # the first of equal samples differs from the one before it
    length, value = equal[:, 1] - equal[:, 0], samples[equal[:, 0]]
    clipped = _clipped(samples, equal, value)
    still = (length >= STUCK_SAMPLES) & ~clipped
    return [
        ("clipping", "the signal is cut off at its extreme value", equal[clipped]),
        ("dropout", "the signal is zero for a while", equal[still & (value == 0)]),
        ("stuck", "the signal holds one value", equal[still & (value != 0)]),
    ]


def _clipped(samples: FloatArray, runs: IntArray, value: FloatArray) -> BoolArray:
    """Runs at an extreme value that the slope before (or after) them would have overshot, shape (runs,)."""
    finite = samples[np.isfinite(samples)]
    low, high = float(np.min(finite)), float(np.max(finite))
    length = runs[:, 1] - runs[:, 0]
    extreme = ((value == high) | (value == low)) & (length >= CLIPPED_RUN)
    before = np.abs(_difference(samples, runs[:, 0] - 1, runs[:, 0] - 2))
    after = np.abs(_difference(samples, runs[:, 1], runs[:, 1] + 1))
    overshoot = np.maximum(before, after) * length / 2
    cut = (overshoot > OVERSHOOT_SHARE * (high - low)) & (overshoot <= FARTHEST * (high - low))
    return np.asarray(extreme & cut, dtype=np.bool_)


def _difference(samples: FloatArray, a: IntArray, b: IntArray) -> FloatArray:
    """Return samples[a] - samples[b], 0 where either lies outside or is not finite."""
    inside = (a >= 0) & (b >= 0) & (a < samples.size) & (b < samples.size)
    step = np.where(inside, samples[np.where(inside, a, 0)] - samples[np.where(inside, b, 0)], 0.0)
    return np.nan_to_num(step, nan=0.0, posinf=0.0, neginf=0.0)


def _runs(mask: BoolArray) -> IntArray:
    """Stretches of True as rows (first, stop), shape (runs, 2), int."""
    edges = np.diff(np.concatenate(([0], mask.astype(np.int8), [0])))
    return np.stack([np.flatnonzero(edges == 1), np.flatnonzero(edges == -1)], axis=1)


def _finding(recording: Recording, channel: str, kind: FindingKind, message: str, runs: IntArray) -> Finding:
    rate = recording.sampling_rate_hz
    places = tuple(
        Place(
            first=int(a),
            stop=int(b),
            start_s=recording.start_s + float(a) / rate,
            stop_s=recording.start_s + float(b) / rate,
        )
        for a, b in runs[:MAX_PLACES]
    )
    total = int(np.sum(runs[:, 1] - runs[:, 0]))
    return Finding(channel=channel, kind=kind, message=message, count=len(runs), samples=total, places=places)
