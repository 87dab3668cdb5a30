"""A name that a black box and a placebo both reach on held-out data is said to be doubtful."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.machine.beaten import beaten, with_beaten
from reconcile.report.action import to_do
from reconcile.verdict import Cause, HeldOut, Placebo, Report

HELD = HeldOut(
    metric="m", unit="dB", before=2.0, after=1.1, gain=0.44, gain_low=0.3, gain_high=0.5, retuned=0.0, black_box=0.62,
    placebo=0.0, placebos=(Placebo(term="inner_spall", site="fan_end", gain=0.57, draws=8),
                           Placebo(term="rub", site="fan_end", gain=0.0, draws=8)),
)  # fmt: skip
REPORT = Report(verdict="explained", sentence="Outer-race spall.", level="machine", held_out=HELD)


def test_a_name_that_both_beat_is_doubted() -> None:
    found = with_beaten(REPORT)
    assert found.verdict == "explained" and "inner spall at fan_end (57 %)" in found.undecidable[0]
    assert "do not decide" in found.undecidable[0] and "62 %" in found.undecidable[0]


@pytest.mark.parametrize(
    "report",
    [
        replace(REPORT, held_out=replace(HELD, black_box=0.40)),
        replace(REPORT, held_out=replace(HELD, placebos=HELD.placebos[1:])),
        replace(REPORT, held_out=replace(HELD, black_box=None)),
        replace(REPORT, held_out=None),
        replace(REPORT, verdict="ambiguous"),
    ],
    ids=["black box", "placebo", "no black box", "no forecast", "a set"],
)
def test_a_name_that_beats_one_of_them_stands(report: Report) -> None:
    assert with_beaten(report) is report


def test_the_name_and_what_to_do_stay() -> None:
    cause = Cause(term="outer_spall", site="drive_end", score=20.0, named=True)
    told = with_beaten(replace(REPORT, causes=(cause,)))
    assert told.sentence == REPORT.sentence and told.causes == (cause,) and beaten(told) and not beaten(REPORT)
    assert to_do(told).startswith("inspect drive_end at the next stop")
