"""Figures of answers: by rig, over all rigs, two ways against each other; as dictionaries for the line of JSON."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from learn.sim2real.answers import Answer
from learn.sim2real.rigs import INFERRED
from learn.sim2real.scores import score, sign_test

KINDS = ("recording", "window")
DEVELOPMENT_RIG = "cwru"
"""The rig that features and ranges were chosen with."""


def right(answer: Answer) -> bool:
    """Whether what was said is the truth."""
    return answer.label == answer.unit.case.label


def recording_of(answer: Answer) -> tuple[str, str]:
    """Which recording a unit is of."""
    return answer.unit.case.rig, answer.unit.case.name


def figure(answers: Sequence[Answer], rig: str | None, kind: str) -> dict[str, object] | None:
    """Balanced accuracy of one rig, or of all; None without such units."""
    chosen = [a for a in answers if a.unit.kind == kind and rig in (None, a.unit.case.rig)]
    if not chosen:
        return None
    truth, said = [a.unit.case.label for a in chosen], [a.label for a in chosen]
    return score(truth, said, kind, [recording_of(a) for a in chosen])


def share(one: Mapping[str, object] | None) -> str:
    """A figure as a cell of a table."""
    if one is None:
        return "-"
    mean, low, high = (float(str(one[key])) for key in ("balanced_accuracy", "low", "high"))
    return f"{mean:.3f} ({low:.2f} to {high:.2f}), n {one['n']}"


def classes_of(answers: Sequence[Answer], rig: str) -> set[str]:
    """True classes that a rig has."""
    return {a.unit.case.label for a in answers if a.unit.case.rig == rig}


def rigs(answers: Sequence[Answer]) -> dict[str, object]:
    """Rigs with several classes: whole recordings under their name, windows under `NAME_windows`.

    Of a rig with one class there is no balanced accuracy: it is in `controls`, and it counts in `pooled`.
    """
    found: dict[str, object] = {}
    for rig in dict.fromkeys(a.unit.case.rig for a in answers):
        if len(classes_of(answers, rig)) > 1:
            for kind, tail in zip(KINDS, ("", "_windows"), strict=True):
                one = figure(answers, rig, kind)
                if one is not None:
                    found[rig + tail] = one
    return found


def controls(answers: Sequence[Answer]) -> dict[str, object]:
    """Rigs of which only sound recordings are known: how many are called faulty, named as in `rigs`."""
    found: dict[str, object] = {}
    for rig in dict.fromkeys(a.unit.case.rig for a in answers):
        if classes_of(answers, rig) == {"healthy"}:
            for kind, tail in zip(KINDS, ("", "_windows"), strict=True):
                chosen = [a for a in answers if a.unit.case.rig == rig and a.unit.kind == kind]
                if chosen:
                    alarms = sum(not right(a) for a in chosen)
                    found[rig + tail] = {"unit": kind, "n": len(chosen), "false_alarms": alarms}
    return found


def pooled(answers: Sequence[Answer]) -> dict[str, object]:
    """All rigs together, single-class ones too: whole recordings, with the windows' figures beside them."""
    whole, cut = figure(answers, None, KINDS[0]), figure(answers, None, KINDS[1])
    return {**(whole or {}), "windows": cut}


def other_rigs(answers: Sequence[Answer]) -> list[Answer]:
    """Without the rig that features and ranges were chosen with."""
    return [a for a in answers if a.unit.case.rig != DEVELOPMENT_RIG]


def stated_bearings(answers: Sequence[Answer]) -> list[Answer]:
    """Without the rigs whose bearing was inferred from orders in their own recordings."""
    return [a for a in answers if a.unit.case.rig not in INFERRED]


def paired(one: Sequence[Answer], other: Sequence[Answer], kind: str) -> dict[str, object]:
    """Recordings that one of two ways answers better, and the exact sign test between them.

    Of windows, a recording is answered better if more of its windows are right, as those of one are not independent.
    """
    counts: dict[tuple[str, str], list[int]] = {}
    for sign, answers in ((1, one), (-1, other)):
        for a in answers:
            if a.unit.kind == kind:
                counts.setdefault(recording_of(a), []).append(sign * right(a))
    balance = [sum(units) for units in counts.values()]
    better, worse = sum(b > 0 for b in balance), sum(b < 0 for b in balance)
    return {
        "unit": kind,
        "recordings": len(balance),
        "better": better,
        "worse": worse,
        "sign_test_p": round(sign_test(better, worse), 4),
    }
