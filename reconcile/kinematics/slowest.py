"""Recordings too short for what turns slowest: the part is told, last, and not at all beside another part's name."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.gate import Gate
from reconcile.gate.findings import Finding
from reconcile.kinematics.families import Ties
from reconcile.verdict import Report

SHORT = "too_short"
SAME = 1e-6


def with_slowest(gate: Gate, tie: Ties) -> Gate:
    """The gate whose findings of short recordings say the part whose lines they are short for."""
    parts = _slowest(tie)
    order = f"order {tie.lowest_order:.3g}"
    told = f"{' or '.join(words for words, _ in parts)} ({order})"
    sites = ", ".join(site for _, site in parts)
    findings = tuple(
        replace(f, detail=f.detail.replace(order, told, 1), where=sites) if f.kind == SHORT else f
        for f in gate.findings
    )
    return replace(gate, findings=findings)


def _slowest(tie: Ties) -> list[tuple[str, str]]:
    """(words, site) of the cages or shafts that turn slowest."""
    cages = [(f"the cage of {f.site}", f.site, f.order) for f in tie.families if f.kind == "cage"]
    rows = [*cages, *((name, name, ratio) for name, ratio in tie.shafts.items())]
    return [(words, site) for words, site, order in rows if order <= tie.lowest_order * (1 + SAME)]


def short_limits(gate: Gate, report: Report) -> tuple[str, ...]:
    """What is said of short recordings: nothing where other places than those of the slowest part are named."""
    named = {c.site for c in report.causes if c.named}
    return tuple(
        f"{f.recording}: {f.detail}"
        for f in gate.findings
        if f.kind == SHORT and (not named or named & set(f.where.split(", ")))
    )


def without_short(gate: Gate) -> Gate:
    """The gate with all other findings."""
    kept: Sequence[Finding] = [f for f in gate.findings if f.kind != SHORT]
    return replace(gate, findings=tuple(kept))
