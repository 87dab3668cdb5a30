"""The page says by how much the sensors speak against a rival place, and nothing where they do not."""

from __future__ import annotations

import pytest

from reconcile.report.heard import against_places
from reconcile.report.page import page
from reconcile.verdict import Cause, Report


def report(*rows: str, stage: str = "judge") -> Report:
    return Report(
        verdict="explained",
        sentence="Outer-race spall at bearing3.",
        level="machine",
        causes=(Cause(term="outer_spall", site="bearing3", score=9.0, named=True),),
        stages=({"name": stage, "heard_less_likely": list(rows)},),
    )


def test_the_rival_place_is_told_with_the_evidence_against_it() -> None:
    found = report("outer_spall@bearing3: 0.0", "outer_spall@bearing4: 8.0", "fit_clearance@bearing4: 1.2")
    words = against_places(found)
    assert "outer spall at bearing4 by 8.0, fit clearance at bearing4 by 1.2 of log evidence" in words
    assert "bearing3" not in words and words in page(found)


@pytest.mark.parametrize("given", [report(), report("a@b: 0.4"), report("a@b: 9.0", stage="impacts")])
def test_where_sensors_tell_nothing_nothing_is_said(given: Report) -> None:
    assert not against_places(given)
    bare = Report(verdict="nothing_missing", sentence="Nothing.", level="machine")
    assert not against_places(bare) and "less likely than another" not in page(bare)
