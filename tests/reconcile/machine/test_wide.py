"""A size that is known to a factor only is undecided, and said to be."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.machine.wide import NARROWS, WIDE, with_wide
from reconcile.verdict import Cause, NextExperiment, Report, Severity

SIZE = Severity(name="width", value=1.7e-3, unit="m", low=0.376e-3, high=7.4e-3)
PIT = Cause(term="outer_spall", site="drive_end", score=30.0, named=True, severity=SIZE)
REPORT = Report(verdict="explained", sentence="A pit.", level="machine", causes=(PIT,), undecidable=("the second",))


def test_a_wide_interval_is_told_beside_what_is_undecided_already() -> None:
    assert with_wide(REPORT).undecidable == (
        "the second",
        "the width of outer spall at drive_end, known to a factor of 20 only (90 %: 0.38 mm to 7.4 mm)",
    )
    assert with_wide(REPORT).next_experiment == NextExperiment(sentence=NARROWS)
    advised = NextExperiment(sentence="Another.")
    assert with_wide(replace(REPORT, next_experiment=advised)).next_experiment is advised


@pytest.mark.parametrize(
    "cause",
    [
        replace(PIT, severity=replace(SIZE, low=1.01 * SIZE.high / WIDE)),
        replace(PIT, severity=replace(SIZE, low=0.0)),
        replace(PIT, severity=None),
        replace(PIT, named=False),
    ],
    ids=["narrow", "a bound", "no size", "no name"],
)
def test_else_nothing_is_added(cause: Cause) -> None:
    report = replace(REPORT, causes=(cause,))
    assert with_wide(report) is report


def test_each_named_size_is_held_against_the_rule_by_itself() -> None:
    loose = replace(
        PIT, term="pedestal_looseness", severity=Severity(name="loss", value=0.5, unit="", low=0.4, high=0.6)
    )
    told = with_wide(replace(REPORT, causes=(loose, PIT)))
    assert len(told.undecidable) == 2 and "drive_end" in told.undecidable[1]
