"""What looks like a loose sensor where a defect strikes, and baselines of tests that are cut off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.gate.findings import Finding, Gate, worst
from reconcile.gate.loose import transferred
from reconcile.kinematics.candidate import ALONE_DEPTH, DEFECTS, LEAST_Z, Candidate
from reconcile.kinematics.evidence import comb_depth
from reconcile.kinematics.observe import Observation

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
    """The gate with baselines that are cut off as far as the tests are: where the highest of what a sound shaft does is
    cut off, the rest is modulated once a turn."""
    names = {f.channel for f in gate.findings if f.kind == "clipped" and f.fault and f.recording.startswith("test")}
    baselines = []
    for base in gate.baselines:
        samples = base.samples.copy()
        for row, name in enumerate(base.names):
            rows = [t.series(name).samples for t in gate.tests if name in t.names]
            if name in names and rows:
                low, high = max(float(np.min(x)) for x in rows), min(float(np.max(x)) for x in rows)
                samples[row] = np.clip(samples[row], low, high)
        baselines.append(replace(base, samples=samples))
    return replace(gate, baselines=tuple(baselines)) if names else gate
