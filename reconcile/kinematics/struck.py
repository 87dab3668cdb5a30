"""What looks like a loose sensor where a defect strikes, and baselines of tests that are cut off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.findings import Finding, Gate, worst
from reconcile.gate.loose import transferred
from reconcile.kinematics.candidate import ALONE_DEPTH, DEFECTS, LEAST_Z, Candidate
from reconcile.kinematics.evidence import comb_depth
from reconcile.kinematics.lines import SAME_SPEED
from reconcile.kinematics.observe import Observation
from signals.recording import Recording

NARROW = 0.25
"""Of half the sampling rate, the widest band in which a place of a spectrum is looked at."""


def without_struck(
    gate: Gate, tests: Sequence[Observation], every: Sequence[Candidate]
) -> tuple[Gate, list[Observation]]:
    """Gate and tests without loose sensors that are a defect's doing: bands rose that a family, present and risen,
    modulates on that channel, so the impacts there are the machine's. The tests have their recordings as they came."""
    risen = [c for c in every if c.family.kind in DEFECTS and c.present and c.risen]
    gone = [f for f in gate.findings if f.kind == "loose_sensor" and any(_strikes(c, f, tests) for c in risen)]
    if not gone:
        return gate, [*tests]
    left = tuple(f for f in gate.findings if f not in gone)
    undone = [f for f in gone if f.fault]
    came = [replace(t, recording=transferred(t.recording, undone, 1)) for t in tests]
    return replace(gate, findings=left, fault=worst(left)), came


def _strikes(one: Candidate, loose: Finding, tests: Sequence[Observation]) -> bool:
    """Whether the family modulates the place of the largest change, which is a rise, in the test that shows it best."""
    hz, change_db = max(loose.transfer_db, key=lambda row: abs(row[1]))
    e, test = one.best, tests[one.strongest]
    like = test.channel(loose.channel)
    if change_db <= 0.0 or like is None or e.channel_z.get(loose.channel, 0.0) < LEAST_Z:
        return False
    wide = NARROW * test.recording.sampling_rate_hz / 2
    at = [k for k, (low, high) in enumerate(like.bands_hz) if low <= hz <= high and high - low <= wide]
    return max((comb_depth(like, k, one.family, e.order) for k in at), default=0.0) >= ALONE_DEPTH


def cut_alike(gate: Gate) -> Gate:
    """The gate with baselines that are cut off as far as the tests are that are held against them, those of their own
    speed where there are any: where the highest of what a sound shaft does is cut off, the rest is modulated once a
    turn. A test that is not cut off says nothing of where the baselines should be."""
    cut = [f for f in gate.findings if f.kind == "clipped" and f.fault and f.recording.startswith(("test", "all"))]
    if not cut:
        return gate
    return replace(gate, baselines=tuple(_cut_as(base, _held_against(base, gate), cut) for base in gate.baselines))


def _held_against(base: Recording, gate: Gate) -> list[tuple[str, Recording]]:
    """Tests by the names under which findings tell them."""
    named = [(f"test {k}", test) for k, test in enumerate(gate.tests, 1)]
    speed_hz = base.operating.speed_hz if base.operating is not None else None
    if speed_hz is None:
        return named
    stated = [(name, t) for name, t in named if t.operating is not None]
    alike = [(n, t) for n, t in stated if t.operating and abs(t.operating.speed_hz / speed_hz - 1.0) <= SAME_SPEED]
    return alike or named


def _cut_as(base: Recording, held: Sequence[tuple[str, Recording]], cut: Sequence[Finding]) -> Recording:
    samples = base.samples.copy()
    for row, name in enumerate(base.names):
        told = {f.recording for f in cut if f.channel == name}
        tests = [t for n, t in held if name in t.names and (n in told or "all tests" in told)]
        if tests:
            rows = [t.series(name).samples for t in tests]
            low, high = max(float(np.min(x)) for x in rows), min(float(np.max(x)) for x in rows)
            samples[row] = np.clip(samples[row], low, high)
    return replace(base, samples=samples)
