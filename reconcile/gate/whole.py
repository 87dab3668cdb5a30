"""What is left of recordings whose channels were stuck or away for a good part: the longest whole stretch of each.

The edges of a held stretch strike like a defect and stop the strikes of one. Few and short ones change no answer, so
they stay; beyond that only what lies between two of them is read, if it holds enough turns.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.gate.findings import Gate
from reconcile.gate.samples import away
from reconcile.gate.spoiled import GONE
from reconcile.shares import percent
from reconcile.verdict import SensorFault
from signals.checks import held
from signals.recording import Recording
from signals.series import BoolArray

TOLERATED = 0.05
"""Share of held samples up to which a channel is read as it is: of made records with a fifth of them, in 60 stretches,
half of the sound ones were taken for a machine that strikes, with 5 % none."""
LEAST_TURNS = 24.0
"""Turns of the shaft that a stretch must hold: twice of what any recording must."""
LEAST_S = 1.0
"""The same where no speed is known."""


@dataclass(frozen=True)
class _Part:
    """The samples first <= i < stop of a recording that are read, of these channels."""

    first: int
    stop: int
    names: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Whole:
    """The gate with its recordings cut; what is `told` of each; labels (`test 1`) of those that are `lost`, since no
    stretch of theirs is long enough. Where every test is lost the gate is not usable, with the fault."""

    gate: Gate
    told: tuple[str, ...]
    lost: frozenset[str]


def whole_stretches(
    gate: Gate, tests: Sequence[Recording], baselines: Sequence[Recording], nominal_hz: float | None
) -> Whole:
    """The longest whole stretch of every recording whose channels, those that are left, were held for a good part.

    `tests`, `baselines`: as they came, since cleaning hides what was held; `nominal_hz`: where none states a speed.
    """
    names = gate.tests[0].names
    masks = [[_held(r.select(channels=names)) for r in several] for several in (tests, baselines)]
    if not any(np.any(np.mean(m, axis=1) > TOLERATED) for several in masks for m in several):
        return Whole(gate=gate, told=(), lost=frozenset())
    cleaned = (gate.tests, gate.baselines)
    best = max(
        (_choice(masks, cleaned, rows, nominal_hz) for rows in _choices(len(names))),
        key=lambda parts: (sum(p is not None for p in parts[0]), _shortest(parts[0])),
    )
    told: list[str] = []
    lost: set[str] = set()
    left = []
    for kind, several, parts, held_there in zip(("test", "baseline"), cleaned, best, masks, strict=True):
        for i, (one, part, mask) in enumerate(zip(several, parts, held_there, strict=True), 1):
            told += _told(f"{kind} {i}", one, part, mask)
            lost |= {f"{kind} {i}"} if part is None else set()
        left.append(tuple(r if p is None else _cut(r, p) for r, p in zip(several, parts, strict=True)))
    gate = replace(gate, tests=left[0], baselines=left[1])
    if all(part is None for part in best[0]):
        gate = replace(gate, fault=_fault(gate, masks[0][0], told[0]), usable=False)
    return Whole(gate=gate, told=tuple(told), lost=frozenset(lost))


def _held(recording: Recording) -> BoolArray:
    """Samples in which nothing was measured, shape (channels, n)."""
    rate = recording.sampling_rate_hz
    return np.stack([held(row) | away(row, rate) for row in recording.samples])


def _choices(channels: int) -> list[list[int]]:
    """All channels together, then each alone."""
    return [list(range(channels)), *([row] for row in range(channels) if channels > 1)]


Parts = tuple[list[_Part | None], list[_Part | None]]


def _choice(
    masks: Sequence[Sequence[BoolArray]],
    cleaned: Sequence[Sequence[Recording]],
    rows: Sequence[int],
    nominal_hz: float | None,
) -> Parts:
    """The part of each test and baseline that these channels allow."""
    found = [
        [_part(mask[rows], one, [one.names[r] for r in rows], nominal_hz) for mask, one in zip(m, several, strict=True)]
        for m, several in zip(masks, cleaned, strict=True)
    ]
    return found[0], found[1]


def _part(mask: BoolArray, one: Recording, names: Sequence[str], nominal_hz: float | None) -> _Part | None:
    size = mask.shape[1]
    if np.all(np.mean(mask, axis=1) <= TOLERATED):
        return _Part(0, size, tuple(names))
    edges = np.flatnonzero(np.concatenate(([True], np.any(mask, axis=0), [True])))
    longest = int(np.argmax(np.diff(edges)))
    first, stop = int(edges[longest]), int(edges[longest + 1]) - 1
    enough = (stop - first) / one.sampling_rate_hz >= _needed_s(one, nominal_hz)
    return _Part(first, stop, tuple(names)) if enough else None


def _needed_s(one: Recording, nominal_hz: float | None) -> float:
    stated = one.operating.speed_hz if one.operating is not None else 0.0
    speed = stated if stated > 0 else nominal_hz
    return LEAST_TURNS / speed if speed else LEAST_S


def _shortest(parts: Sequence[_Part | None]) -> int:
    return min((p.stop - p.first for p in parts if p is not None), default=0)


def _cut(one: Recording, part: _Part) -> Recording:
    rows = [one.names.index(name) for name in part.names]
    return replace(
        one,
        channels=tuple(one.channels[r] for r in rows),
        samples=one.samples[rows, part.first : part.stop],
        start_s=one.start_s + part.first / one.sampling_rate_hz,
    )


def _told(label: str, one: Recording, part: _Part | None, mask: BoolArray) -> list[str]:
    share = float(np.max(np.mean(mask, axis=1)))
    if part is not None and part.stop - part.first == mask.shape[1]:
        return []
    what = f"{label}: {percent(share, 0)} of the samples were held, zero or away"
    if part is None:
        return [f"{what}, and no whole stretch is long enough to be read"]
    first, stop = (one.start_s + k / one.sampling_rate_hz for k in (part.first, part.stop))
    return [f"{what}: only {first:.4g} to {stop:.4g} s of {', '.join(part.names)} were read"]


def _fault(gate: Gate, mask: BoolArray, told: str) -> SensorFault:
    channel = gate.tests[0].names[int(np.argmax(np.mean(mask, axis=1)))]
    kind = gate.fault.kind if gate.fault is not None and gate.fault.kind in GONE else "stuck"
    return SensorFault(kind=kind, channel=channel, detail=told)
