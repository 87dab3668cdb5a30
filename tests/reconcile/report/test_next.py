"""The next experiment in the page: separations are log evidence, and what is not known is said to be so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.kinematics.vague import SHAFTS_UNJUDGED
from reconcile.report.action import to_do
from reconcile.report.sections import undecidable
from reconcile.verdict import NextExperiment, Report


def drawn(advised: NextExperiment) -> str:
    report = Report(verdict="ambiguous", sentence="Two look alike.", level="machine", next_experiment=advised)
    return str(undecidable(report))


@pytest.mark.parametrize(
    ("now", "then", "said"),
    [
        (1.0, 4.0, ("1.0 now", "2.7 times as likely", "4.0 (55 times) expected")),
        (-0.7, 12.0, ("-0.7 now", "0.5 times as likely", "12.0 (more than 1000 times) expected")),
        (0.5, None, ("0.5 now", "1.6 times as likely", "is not known")),
    ],
)
def test_separations_are_told_as_log_evidence(now: float, then: float | None, said: tuple[str, ...]) -> None:
    told = drawn(NextExperiment(sentence="Record.", separation_now=now, separation_expected=then))
    assert "log evidence (natural logarithm)" in told and "standard error" not in told
    assert all(one in told for one in said)


def test_without_separations_there_is_the_advice_alone() -> None:
    told = drawn(NextExperiment(sentence="Record."))
    assert "Record." in told and "Separation" not in told


def test_without_a_baseline_no_shaft_is_called_sound() -> None:
    quiet = Report(verdict="nothing_missing", sentence=f"No family; {SHAFTS_UNJUDGED}.", level="kinematics")
    assert to_do(quiet).startswith("no bearing defect shows; judge the levels of the shafts' own lines")
    assert "nothing follows" in to_do(replace(quiet, sentence="No family."))
