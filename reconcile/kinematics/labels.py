"""Labels of speed that pulses or lines contradict: a fault of the measurement that stands beside the answer."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.kinematics.observe import Observation
from reconcile.shares import signed_percent
from reconcile.verdict import Report, SensorFault

WRONG = 0.08
"""Relative error from which a label is a fault: drives slip by less, labels of measured rigs are up to 7 % off, and
lines are followed to 10 %; what is wrong by less is told as a limit."""
UNTOLD = ("The speed is not decided", "The speed is not confirmed", "The stated speed does not hold")
"""How sentences begin that doubt the speed themselves."""


def label_faults(report: Report, several: Sequence[Observation]) -> tuple[SensorFault, ...]:
    """One for all recordings whose label is that far off; none where the answer is about the speed."""
    if report.sentence.startswith(UNTOLD):
        return ()
    wrong = [
        one
        for one in several
        if one.speed.method != "stated" and one.speed.mismatch is not None and abs(one.speed.mismatch) > WRONG
    ]
    if not wrong:
        return ()
    told = "; ".join(
        f"{one.label}: {one.speed.shaft} turned at {one.speed.speed_hz:.4g} Hz, "
        f"{signed_percent(one.speed.mismatch or 0.0)} from the stated {one.speed.stated_hz:.4g} Hz"
        for one in wrong
    )
    recordings = tuple(one.label for one in wrong)
    return (SensorFault(kind="speed_mismatch", channel="", detail=told, recordings=recordings),)
