"""Combinations of levels: all of them, or a few that keep pairs of factors apart."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from sideband_datasets.plan import drawing, make_plan
from sideband_datasets.plan.lattice import factorial_point
from sideband_datasets.plan.seeds import Stream
from sideband_datasets.recipe.read import document_of, read_recipe
from sideband_datasets.recipe.ready import recipe_named
from signals.series import FloatArray


def points(levels: tuple[int, ...], count: int, seed: int = 1) -> FloatArray:
    return np.array([factorial_point(levels, k, count, seed, Stream.CLASS, 1) for k in range(count)])


def test_a_factorial_plan_has_every_combination_once():
    found = points((3, 2, 4), 24)
    assert len(np.unique(found, axis=0)) == 24
    assert set(found[:, 0]) == {0.0, 0.5, 1.0}


def test_a_thinned_factorial_plan_repeats_nothing_and_uses_all_levels():
    found = points((3, 3, 3, 3), 27)
    assert len(np.unique(found, axis=0)) == 27
    assert all(set(found[:, d]) == {0.0, 0.5, 1.0} for d in range(4))
    assert np.array_equal(found, points((3, 3, 3, 3), 27)) and not np.array_equal(found, points((3, 3, 3, 3), 27, 2))


@pytest.mark.parametrize(
    ("levels", "count"), [((3, 3, 2, 3), 8), ((3, 3, 2, 3), 18), ((5, 4, 3, 2), 40), ((3,) * 8, 30), ((3,) * 8, 600)]
)
def test_every_two_factors_meet_in_as_many_pairs_as_there_may_be(levels: tuple[int, ...], count: int):
    found = points(levels, count)
    for a, b in combinations(range(len(levels)), 2):
        pairs, times = np.unique(found[:, [a, b]], axis=0, return_counts=True)
        every = levels[a] * levels[b]
        assert len(pairs) >= min(every, count) - 2 * (count < 2 * every)
        assert times.max() <= 2.5 * max(count / every, 1.0)
        assert np.ptp(np.unique(found[:, a], return_counts=True)[1]) <= 2 + count // 100


def test_what_is_left_after_all_combinations_is_spread_too():
    found = points((3, 3, 2), 18 + 9)
    assert len(np.unique(found[:18], axis=0)) == 18
    assert len(np.unique(found[18:, :2], axis=0)) >= 8


def factorial(**changes: object):
    return make_plan(read_recipe({**document_of(recipe_named("small")), "plan": "factorial", **changes}))


def test_speed_does_not_tell_the_width_of_a_fault():
    plan = factorial()
    drawn = [drawing(plan, int(i)) for i in np.flatnonzero(plan.kind)]
    pairs = {(d.spec.operating.speed_hz, round(1e3 * d.effects[0].severity, 3)) for d in drawn}
    assert len(drawn) == 8 and len(pairs) >= 7


def test_factors_with_more_pairs_than_recordings_are_named():
    (told,) = [text for text in factorial().warnings if text.startswith("class outer")]
    assert "8 recordings" in told
    assert "speeds_hz with faults.0.terms.0.parameters.width (9 pairs)" in told
    assert "sites" not in told, "six pairs with two places are not more than eight recordings"
    assert not factorial(count=18).warnings
    assert not factorial(plan="sobol").warnings
