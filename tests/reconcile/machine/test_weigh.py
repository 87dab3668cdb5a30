"""Weights of places are those of the set that the verdict leaves open."""

from __future__ import annotations

import pytest

from reconcile.machine.decide import decide
from reconcile.machine.weigh import credible_set, merged_weights, of_the_set
from tests.reconcile.machine.test_decide import NAMES, screen


def test_places_share_alike_where_the_set_is_not_made_by_the_weights() -> None:
    """One sensor at one point: what explains half as much stays in the set, so its place is as open as the first's."""
    one = screen([20.0, 12.0])
    few, weights = decide(one, views=1), merged_weights(one)
    assert weights[NAMES[0]] > 0.99
    assert of_the_set(weights, few.chosen) == {NAMES[0]: 0.5, NAMES[1]: 0.5}
    assert of_the_set(weights, decide(one, views=9).chosen) == weights
    near = merged_weights(screen([20.0, 19.5, 19.0]))
    assert of_the_set(near, NAMES[:3]) == near, "the weights made the set"
    struck = of_the_set(near, NAMES[1:2])
    assert struck == {NAMES[1]: 1.0}, "only its impacts told"


def test_a_place_behind_by_pattern_is_shown_where_only_impacts_tell() -> None:
    weights = merged_weights(screen([2.9, -8.0]))
    chosen = (NAMES[1], NAMES[0])
    assert of_the_set(weights, chosen) == {NAMES[1]: 0.5, NAMES[0]: 0.5}


@pytest.mark.parametrize(("ahead", "named"), [(2.8, False), (2.9, False), (3.0, True), (4.0, True)])
def test_a_name_leads_its_next_rival_by_three_of_log_evidence(ahead: float, named: bool) -> None:
    """A loose fit was named a support that stiffens, 2.8 ahead of the fit (f007 of the proof)."""
    found = decide(screen([20.0, 20.0 - ahead]), views=9)
    assert found.word == ("explained" if named else "ambiguous")
    assert found.chosen == (NAMES[:1] if named else NAMES[:2])
    assert credible_set(merged_weights(screen([20.0, 20.0 - ahead]))) == found.chosen
