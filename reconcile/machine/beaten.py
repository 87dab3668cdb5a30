"""A name that held-out data do not speak for: a correction without physics and a wrong effect both forecast as well."""

from __future__ import annotations

from dataclasses import replace

from reconcile.report.words import percent, readable, strongest_placebo
from reconcile.verdict import Report

BEATEN = "does no better than"


def beaten(report: Report) -> bool:
    """Whether it is said of the name."""
    return report.verdict == "explained" and any(BEATEN in one for one in report.undecidable)


def with_beaten(report: Report) -> Report:
    """The report, which says among what it cannot decide that its name is beaten by both, if it is: of 23 named cases
    of the proof (splits `next`, `others`, `unmet`) one, a pair of which one was named, but three right ones of three
    pits of a rotor's bearings at two speeds; so the name stands, and what else the tests may be is asked
    (`reconcile.machine.mistaken`)."""
    held = report.held_out
    best = None if held is None else strongest_placebo(held)
    if report.verdict != "explained" or held is None or best is None or held.black_box is None:
        return report
    if min(best.gain, held.black_box) < held.gain:
        return report
    other = f"{readable(f'{best.term}@{best.site}')} ({percent(best.gain)})"
    text = (
        f"on data it was not fitted to the name ({percent(held.gain)}) {BEATEN} {other}, nor than a black "
        f"box ({percent(held.black_box)}): they do not decide between the name and those"
    )
    return replace(report, undecidable=(*report.undecidable, text))
