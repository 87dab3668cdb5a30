"""Recordings too short for what turns slowest: the part is told, last, and not at all beside another part's name."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

from reconcile.gate import Gate
from reconcile.gate.findings import Finding
from reconcile.gate.timing import MIN_TURNS as SLOWEST_TURNS
from reconcile.kinematics.families import Ties
from reconcile.stated import pulses_hz
from reconcile.verdict import NextExperiment, Report
from signals.recording import Recording

SHORT = "too_short"
MIN_TURNS = 12.0
"""Of the shaft whose speed is stated, below which its lines are not looked for."""
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


def shortest_s(speed_hz: float) -> float:
    """Shortest recording at a speed, s, two figures, none too few."""
    seconds = MIN_TURNS / speed_hz
    step = 10.0 ** (math.floor(math.log10(seconds)) - 1)
    return float(f"{math.ceil(seconds / step - SAME) * step:.2g}")


def needed_for(tie: Ties, speed_hz: float) -> str:
    """How long a recording at this speed must be, and for what: turns of the shaft or of what turns slowest."""
    slow = SLOWEST_TURNS / tie.lowest_order
    part = " or ".join(words for words, _ in _slowest(tie))
    what = f"{SLOWEST_TURNS:g} turns of {part}" if slow > MIN_TURNS else f"{MIN_TURNS:g} turns of {tie.reference}"
    return f"{math.ceil(10 * max(slow, MIN_TURNS) / speed_hz) / 10:g} s ({what})"


def longer(several: Sequence[Recording], tie: Ties, usual_hz: float | None) -> NextExperiment | None:
    """To record longer, where one of the recordings holds too few turns of the shaft; `usual_hz`: its speed where they
    tell none."""
    speeds = [(r, _speed_hz(r, tie.reference) or usual_hz) for r in several]
    short = [hz for r, hz in speeds if hz and hz * r.duration_s < MIN_TURNS]
    if not short:
        return None
    return NextExperiment(sentence=f"Record at least {needed_for(tie, min(short))}.")


def _speed_hz(one: Recording, shaft: str) -> float | None:
    """As pulses or the description say it."""
    stated = one.operating.speed_hz if one.operating is not None else None
    return pulses_hz(one, shaft) or stated


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
