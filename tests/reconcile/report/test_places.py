"""How sure a place is, in the words of the page."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.report import page
from reconcile.verdict import PlaceWeight, Where
from tests.reconcile.report.test_report import full_report


@pytest.mark.parametrize(
    ("weights", "said"),
    [
        ((0.9969, 0.0031), "most likely place, more than 99 % of the weight"),
        ((0.9, 0.1), "most likely place, 90 % of the weight"),
        ((1.0,), "place, of the parts in the machine file"),
    ],
)
def test_nearly_all_of_the_weight_is_not_told_as_all(weights: tuple[float, ...], said: str) -> None:
    sites = tuple(PlaceWeight(site=f"bearing{k}", weight=w) for k, w in enumerate(weights, 1))
    drawn = page(replace(full_report(), verdict="explained", where=Where(sites=sites)))
    assert said in drawn
    assert len(weights) == 1 or f"bearing1: {said.rpartition(', ')[2]}" in drawn


@pytest.mark.parametrize(
    "sentence", ["The speed is not decided: 30 Hz or 15.", "The speed is not confirmed by any line, and the part hangs"]
)
def test_an_open_speed_is_settled_before_anything_is_opened(sentence: str) -> None:
    sites = (PlaceWeight(site="bearing1", weight=0.9), PlaceWeight(site="gear", weight=0.1))
    one = replace(full_report().causes[0], site="bearing1", named=False, score=9.0)
    opened = replace(full_report(), verdict="ambiguous", sentence=sentence, where=Where(sites=sites))
    drawn = page(replace(opened, causes=(one,)))
    assert "find out how fast it turned" in drawn and "before bearing1 is opened" in drawn
    assert "it hangs on the speed" in drawn and "which of the names it is" not in drawn
