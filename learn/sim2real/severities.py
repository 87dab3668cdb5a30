"""Whether longer defects are told as longer: pairs of recordings of one rig, speed and race."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from learn.sim2real.answers import Answer


def severity_pairs(answers: Sequence[Answer]) -> dict[str, int]:
    """Pairs of defects of different length on one race, and how many of them are ordered rightly.

    A pair counts in any case: where either recording's race is not named, or no index is told, it is not right. Pairs
    of one speed, then (`across_speeds`) those of two, whose index differs by the speed too.
    """
    found = {"pairs": 0, "right": 0, "pairs_across_speeds": 0, "right_across_speeds": 0}
    for x, y in combinations(_sized(answers), 2):
        a, b = x.unit.case, y.unit.case
        if (a.rig, a.label) != (b.rig, b.label) or a.size == b.size:
            continue
        tail = "" if a.stated_hz == b.stated_hz else "_across_speeds"
        found["pairs" + tail] += 1
        first, second = _index(x), _index(y)
        if first is not None and second is not None:
            found["right" + tail] += ((a.size or 0.0) < (b.size or 0.0)) == (first < second)
    return found


def severity_table(answers: Sequence[Answer]) -> str:
    """Index and true arc, and the pairs in the right order."""
    lines = [
        "Severity (index: learn.severity; no size is claimed):\n",
        "| recording | stated speed, Hz | arc, degrees | index |",
        "|---|---|---|---|",
    ]
    for a in _sized(answers):
        case, index = a.unit.case, _index(a)
        told = "-" if index is None else f"{index:.2f}"
        lines.append(f"| {case.name} | {case.stated_hz:g} | {case.size:g} | {told} |")
    n = severity_pairs(answers)
    lines.append(f"\n{n['right']} of {n['pairs']} pairs of one race and speed in the right order, ")
    lines[-1] += f"and {n['right_across_speeds']} of {n['pairs_across_speeds']} of one race and two speeds."
    return "\n".join(lines)


def _sized(answers: Sequence[Answer]) -> list[Answer]:
    return [a for a in answers if a.unit.window is None and a.unit.case.size is not None]


def _index(answer: Answer) -> float | None:
    """Of the true race; None where another class was named, whose index says nothing of it."""
    if answer.assessment is None or answer.label != answer.unit.case.label:
        return None
    return answer.assessment.severity
