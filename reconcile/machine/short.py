"""Recordings that are short: what that keeps from being seen, and how long they should be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.gate.findings import Finding
from reconcile.machine.turned import COMPARED
from reconcile.observe.observation import PointData
from reconcile.verdict import NextExperiment, Report

LEAST_TURNS = 12.0
"""Of the driven shaft, below which an open answer is first of all short of data (as level `kinematics` has it)."""
OPEN = ("ambiguous", "not_decidable", "unknown_physics")


def with_short(report: Report, data: Sequence[PointData], findings: Sequence[Finding]) -> Report:
    """The report with the shortest recording among its limits, and tests that were compared at another speed than they
    state; where the shortest holds next to no turns and the answer is open, the next experiment is a longer one."""
    moved = tuple(f"{f.recording}: {f.detail}" for f in findings if f.detail.endswith(COMPARED))
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, *moved))) if moved else report
    short = [f for f in findings if f.kind == "too_short"]
    if not short:
        return report
    worst = max(short, key=lambda f: f.severity)
    limit = f"{worst.recording} is short: {worst.detail}; what turns so slowly may stay unseen"
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, limit)))
    turns, seconds = min(_turns(d) for d in data)
    if turns >= LEAST_TURNS or report.verdict not in OPEN:
        return report
    reason = f"{seconds:.2g} s hold {turns:.3g} turns of the driven shaft only"
    longer = f"Record longer, at least {seconds * LEAST_TURNS / turns:.2g} s and better ten times that: {reason}."
    return replace(report, undecidable=(*report.undecidable, reason), next_experiment=NextExperiment(sentence=longer))


def _turns(one: PointData) -> tuple[float, float]:
    """Turns of the driven shaft in a test, and its length in seconds."""
    test = one.spectra[0]
    seconds = test.samples.shape[1] / test.rate_hz
    return seconds * test.speed_hz, seconds
