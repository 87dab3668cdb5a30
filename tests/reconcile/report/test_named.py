"""Names and figures of the page: the sentence's name of an effect, zero as zero, names whole where they can be."""

from __future__ import annotations

import re

import pytest

from reconcile.report.figures.bars import ranking
from reconcile.report.named import cause, percent, readable
from reconcile.report.page import page
from reconcile.verdict import Cause, HeldOut, Placebo, Report


def report(**more: object) -> Report:
    causes = (
        Cause(term="missing_tooth", site="gear", score=9.0, named=True),
        Cause(term="unbalance", site="input", score=-7.3e-08),
    )
    given: dict[str, object] = {"verdict": "explained", "sentence": "Broken tooth at gear.", "level": "machine", **more}
    return Report(causes=causes, **given)  # type: ignore[arg-type]


def test_the_table_calls_an_effect_as_the_sentence_does() -> None:
    drawn = page(report(pictures={"ranking": [{"label": "missing_tooth@gear", "score": 9.0, "named": True}]}))
    assert "missing tooth" not in drawn and drawn.count("broken tooth at gear") > 2


def test_of_two_housings_the_name_says_which() -> None:
    loose = Cause(term="fit_clearance_series", site="bearing1", score=9.0, named=True)
    assert cause(loose) == readable("fit_clearance_series@bearing1") == "fit clearance, elastic housing at bearing1"


def test_a_score_of_next_to_nothing_is_none() -> None:
    drawn = page(report())
    assert "e-08" not in drawn and '<td data-head="score">0</td>' in drawn


@pytest.mark.parametrize(("share", "said"), [(-0.002, "0 %"), (0.002, "0 %"), (-0.006, "-1 %"), (None, "–")])
def test_no_share_is_less_than_nothing_by_nothing(share: float | None, said: str) -> None:
    assert percent(share) == said


def test_a_placebo_that_gains_nothing_is_told_so() -> None:
    held = HeldOut(
        metric="distance", unit="dB", before=9.0, after=3.0, gain=0.6, gain_low=0.5, gain_high=0.7, retuned=0.1,
        black_box=0.1, placebo=-0.001, placebos=(Placebo(term="missing_tooth", site="gear2", gain=-0.001, draws=9),),
    )  # fmt: skip
    drawn = page(report(held_out=held))
    assert "-0 %" not in drawn and "strongest placebo: broken tooth at gear2" in drawn


def test_a_name_that_is_a_little_too_long_is_squeezed_not_cut() -> None:
    long = "one-sided Hertz contact, (z − 0.567 mm)₊^1.5"
    wide = str(ranking([{"label": long, "score": 1.0}])).split("plot narrow")[0]
    assert re.search(rf'textLength="269"[^>]*>{re.escape(long)}<', wide), wide
    assert "…" in str(ranking([{"label": 3 * long, "score": 1.0}])).split("plot narrow")[0]
