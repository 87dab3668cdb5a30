"""Channels that were away for a part of a recording are heard where they were good: the longest whole run of all."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.findings import Gate, Kind, worst
from reconcile.gate.samples import away
from reconcile.gate.spoiled import GONE, without_spoiled
from reconcile.gate.whole import LEAST_S, LEAST_TURNS
from reconcile.shares import percent
from signals.checks import held
from signals.recording import Recording

PARTLY: tuple[Kind, ...] = ("not_finite", "silence", "stuck", "dropouts")
"""What may be so for a part of a recording only."""
KINDS = ("test", "baseline")
Run = tuple[int, int]
LEAST_SHARE = 0.5
"""Of every recording that the run holds: below, the other channels lose more than this one brings."""


def heard_gate(
    tests: Sequence[Recording],
    baselines: Sequence[Recording],
    inspect: Callable[[Sequence[Recording], Sequence[Recording]], Gate],
    nominal_hz: float | None,
) -> tuple[Gate, Sequence[Recording], Sequence[Recording], tuple[str, ...]]:
    """(the gate without the channels that were away, the recordings it is of, what is told): where a channel has a run
    that is long enough it stays, with its fault, and all recordings are cut to that. `inspect(tests, baselines)`: the
    gate of recordings; `nominal_hz`: speed where none is stated."""
    gate = inspect(tests, baselines)
    spoiled = [f for f in gate.findings if f.fault and f.kind in GONE and f.channel]
    lost = {f.channel for f in spoiled if f.kind not in PARTLY}
    partly = sorted({f.channel for f in spoiled} - lost)
    several = (tests, baselines)
    runs = [[_run(r, partly) for r in rows] for rows in several]
    if partly and all(_enough(r, run, nominal_hz) for r, run in _pairs(several, runs)):
        cut = [
            [_cut(r, run) for r, run in zip(rows, own, strict=True)] for rows, own in zip(several, runs, strict=True)
        ]
        again = inspect(cut[0], cut[1])
        left = without_spoiled(again, GONE) if again.usable else again
        if left.usable and set(partly) <= set(left.tests[0].names):
            shown = (*(f for f in spoiled if f.channel in partly), *left.findings)
            return replace(left, findings=shown, fault=worst(shown)), cut[0], cut[1], _told(several, runs, partly)
    return (without_spoiled(gate, GONE) if gate.usable else gate), tests, baselines, ()


def _pairs(several: Sequence[Sequence[Recording]], runs: Sequence[Sequence[Run]]) -> list[tuple[Recording, Run]]:
    return [pair for rows, own in zip(several, runs, strict=True) for pair in zip(rows, own, strict=True)]


def _told(
    several: Sequence[Sequence[Recording]], runs: Sequence[Sequence[Run]], names: Sequence[str]
) -> tuple[str, ...]:
    labels = [f"{kind} {i}" for kind, rows in zip(KINDS, several, strict=True) for i in range(1, len(rows) + 1)]
    return tuple(
        f"{label}: only {r.start_s + first / r.sampling_rate_hz:.4g} to {r.start_s + stop / r.sampling_rate_hz:.4g} s "
        f"were read, where {' and '.join(names)} {'were' if len(names) > 1 else 'was'} not away "
        f"({percent((stop - first) / r.samples.shape[1], 0)} of it)"
        for label, (r, (first, stop)) in zip(labels, _pairs(several, runs), strict=True)
        if stop - first < r.samples.shape[1]
    )


def _run(one: Recording, names: Sequence[str]) -> Run:
    """First and last (excluded) sample of the longest run in which all of these channels are good."""
    rows = [one.samples[one.names.index(name)] for name in names if name in one.names]
    bad = np.zeros(one.samples.shape[1], dtype=np.bool_)
    for row in rows:
        whole = np.nan_to_num(row, nan=0.0, posinf=0.0, neginf=0.0)
        bad |= ~np.isfinite(row) | held(whole) | away(whole, one.sampling_rate_hz)
    edges = np.flatnonzero(np.concatenate(([True], bad, [True])))
    longest = int(np.argmax(np.diff(edges)))
    return int(edges[longest]), int(edges[longest + 1]) - 1


def _enough(one: Recording, run: Run, nominal_hz: float | None) -> bool:
    speed = one.operating.speed_hz if one.operating is not None and one.operating.speed_hz > 0 else nominal_hz
    size = run[1] - run[0]
    needed_s = LEAST_TURNS / speed if speed else LEAST_S
    return size >= LEAST_SHARE * one.samples.shape[1] and size / one.sampling_rate_hz >= needed_s


def _cut(one: Recording, run: Run) -> Recording:
    first, stop = run
    return replace(one, samples=one.samples[:, first:stop], start_s=one.start_s + first / one.sampling_rate_hz)
