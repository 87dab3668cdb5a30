"""How near the revised machine comes to what was recorded, and what is to be done where it does not: the machine file
is another machine's, whatever is named."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from reconcile.report.action import NO_FIT
from reconcile.report.action import to_do as by_verdict
from reconcile.report.markup import figure_text
from reconcile.report.named import percent
from reconcile.verdict import Cause, NextExperiment, Report

FARTHER = 1.25
"""Share of the levels' change that the simulated revised machine leaves, from which its file is another machine's. Of
62 reports on made machines and the proof's rigs the largest are 1.05 (nothing named) and 1.03 (named); 1.81 with the
numbers of another rig in the file."""
HARDLY = 0.95
"""From here on the revised machine comes no nearer in level, whatever its impacts show."""
CORRECT = (
    "Correct the machine file (masses, stiffnesses, supports, numbers of teeth and bearings) until its machine fits "
    "the baseline, and ask again: what is named hangs on its lines and impacts, its size on the file."
)


def share_left(report: Report) -> float | None:
    """Of the levels' change in the recordings that were fitted, by the revised machine as it is simulated."""
    found = next((s for s in report.stages if s.get("name") == "revised machine"), None)
    if found is None or not float(str(found["level_change_db"])) > 0.0:
        return None
    return float(str(found["left_of_it_db"])) / float(str(found["level_change_db"]))


def comes_no_nearer(report: Report) -> bool:
    """Whether the revised machine leaves the whole change of levels, on a file that fits."""
    return not misfits(report) and HARDLY <= (share_left(report) or 0.0) < FARTHER


def misfits(report: Report) -> bool:
    """Whether what is named stands beside a file that is another machine's."""
    if report.level != "machine" or report.verdict not in ("explained", "ambiguous"):
        return False
    return NO_FIT in report.sentence or (share_left(report) or 0.0) >= FARTHER


def sent_to_the_file(report: Report) -> Report:
    """The report, whose next experiment is first to correct the machine file where it does not fit."""
    if not misfits(report):
        return report
    following = report.next_experiment or NextExperiment(sentence="")
    return replace(report, next_experiment=replace(following, sentence=f"{CORRECT} {following.sentence}".strip()))


def to_do(report: Report) -> str:
    """What a person can do now, with the machine file where it does not fit."""
    said = by_verdict(report)
    return f"{said} {CORRECT}" if misfits(report) and CORRECT not in said else said


OTHER_SIZE = 0.05
"""Share by which the size in the revised machine may be another than the one told."""


def size_in_it(report: Report) -> str:
    """That the revised machine has another size than is told, and which: of near draws and of the size told, each with
    its other numbers, it is the one whose simulation comes nearest. Empty where it has the size told."""
    for cause in report.causes:
        told, own = cause.severity, _of_machine(report, cause)
        if not cause.named or told is None or told.name not in own:
            continue
        size = abs(float(own[told.name]))
        if abs(size - abs(told.value)) > OTHER_SIZE * abs(told.value):
            has, said = (figure_text(x, told.unit, digits=2) for x in (size, told.value))
            return (
                f" Its {told.name} is {has}, not {said}: of the sizes within the interval that were simulated it is "
                "the one that, with its other numbers, comes nearest to the recordings."
            )
    return ""


def _of_machine(report: Report, cause: Cause) -> Mapping[str, float]:
    """Parameters of an effect in the revised machine."""
    terms = (report.machine or {}).get("terms", [])
    assert isinstance(terms, list)
    own = (t["parameters"] for t in terms if (t["term"], t["site"]) == (cause.term, cause.site))
    return next(own, {})


def note(report: Report) -> str:
    """What the revised machine is good for."""
    return f"{_reproduces(report)}{size_in_it(report)}"


def _reproduces(report: Report) -> str:
    loads, left = "Loads back into the simulator", share_left(report)
    if left is None:
        return f"{loads}, with what {'is named' if any(c.named for c in report.causes) else 'comes nearest'} in it."
    if left >= FARTHER:
        return (
            f"{loads}, but does not reproduce the recordings: simulated, it leaves {percent(left)} of the levels' "
            "change, more than there was without it. The numbers of the machine file should be corrected first."
        )
    if left >= HARDLY:
        return f"{loads}, but comes no nearer to the recordings in level: it leaves {percent(left)} of the change."
    return f"{loads}: simulated, it shows {percent(1.0 - left)} of the change in level, and leaves {percent(left)}."
