"""Whether longer defects are told as longer: pairs of recordings of one rig, speed and race."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from learn.sim2real.answers import Answer


def severity_table(answers: Sequence[Answer]) -> str:
    """Index and true arc, and the pairs in the right order."""
    rows = [a for a in answers if a.unit.window is None and a.unit.case.size is not None and a.assessment is not None]
    lines = [
        "Severity (index: learn.severity; no size is claimed):\n",
        "| recording | arc, degrees | index |",
        "|---|---|---|",
    ]
    told = []
    for a in rows:
        assert a.assessment is not None
        index = a.assessment.severity
        lines.append(f"| {a.unit.case.name} | {a.unit.case.size:g} | {'-' if index is None else f'{index:.2f}'} |")
        if index is not None:
            told.append((a.unit.case.label, float(a.unit.case.size or 0.0), index))
    pairs = [(x, y) for x, y in combinations(told, 2) if x[0] == y[0] and x[1] != y[1]]
    right = sum((x[1] < y[1]) == (x[2] < y[2]) for x, y in pairs)
    lines.append(f"\n{right} of {len(pairs)} pairs of one race in the right order.")
    return "\n".join(lines)
