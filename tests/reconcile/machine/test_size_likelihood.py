"""The likelihood of a size, by draws about it: closed forms, how often it holds the truth, and what it must not do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reconcile.machine.severity import COVER, LEAST_SPREAD
from reconcile.machine.size_likelihood import LEAST_DRAWS, Curve, Heard, Sized, distance, missed_by, sized

DRAWS, CURVE = 24, Curve(bandwidth=0.7, degree=2)
LOGS = np.linspace(np.log(2.0), np.log(32.0), DRAWS)
"""Sizes 2 to 32."""


def _view(slope: float, true: float, seed: int, features: int = 40, scatter: float = 0.5, off: float = 0.0) -> Heard:
    """Features that go with the logarithm of the size at slopes about `slope`, on machines that scatter; the
    observation is of the `true` size with a measurement error of one, and of something else by `off`."""
    rng = np.random.default_rng(seed)
    slopes = slope * rng.normal(size=features)
    shown = np.outer(LOGS, slopes) + scatter * rng.normal(size=(DRAWS, features))
    seen = np.log(true) * slopes + rng.normal(size=features) + scatter * rng.normal(size=features)
    return Heard(shown=shown, seen=seen + off * rng.normal(size=features), variance=np.ones(features))


def _told(*ways: Heard) -> Sized:
    told = sized(LOGS, ways, CURVE)
    assert told is not None
    return told


def test_the_distance_is_that_of_a_weighted_line_with_its_own_error() -> None:
    """Three draws at -1, 0, 1 that show 1, 0 and 5: by hand, with weights 1, 1 and 1 (a bandwidth without end) the line
    is 2 + 2 x; it misses by 1, -2 and 1, so a scatter of 2 for three numbers of which two are fitted makes 6; at 0 the
    line's own variance is a third of that."""
    away, shown = np.array([-1.0, 0.0, 1.0]), np.array([[1.0], [0.0], [5.0]])
    way = Heard(shown=shown, seen=np.array([6.0]), variance=np.array([2.0]))
    squared, width = distance(away, way, Curve(bandwidth=1e6, degree=1))
    variance = 2.0 + 6.0 * (1.0 + 1.0 / 3.0)
    assert squared == pytest.approx((6.0 - 2.0) ** 2 / variance)
    assert width == pytest.approx(np.log(variance))


def test_draws_far_away_count_less() -> None:
    way = Heard(shown=np.array([[0.0]] * 6 + [[9.0]] * 6), seen=np.array([0.0]), variance=np.ones(1))
    away = np.concatenate([np.full(6, 0.0), np.full(6, 5.0)])
    near, far = (distance(away, way, Curve(bandwidth=b, degree=0))[0] for b in (0.5, 50.0))
    assert near == pytest.approx(0.0, abs=1e-6) and far > 0.5


@given(true=st.floats(3.0, 20.0), seed=st.integers(0, 1000))
def test_the_size_is_found_where_the_views_go_with_it(true: float, seed: int) -> None:
    told = _told(_view(3.0, true, seed), _view(2.0, true, seed + 1))
    assert abs(told.mean - np.log(true)) < 0.35
    assert LEAST_SPREAD <= told.spread < 0.5


@pytest.mark.parametrize(("slope", "scatter", "features"), [(0.3, 1.0, 60), (0.3, 3.0, 60), (0.15, 2.0, 400)])
def test_intervals_hold_where_machines_scatter(slope: float, scatter: float, features: int) -> None:
    """Machines that scatter as far as the effect moves them: 90 % intervals hold three of four at least, of sizes
    within."""
    held, sizes = 0, np.geomspace(4.0, 16.0, 24)
    for seed, true in enumerate(sizes):
        told = _told(_view(slope, float(true), seed, features=features, scatter=scatter))
        held += abs(told.mean - np.log(true)) < COVER * told.spread
    assert held >= 0.75 * sizes.size


def test_draws_that_are_missed_by_the_others_widen_the_interval() -> None:
    sure, unsure = _view(3.0, 8.0, 1, scatter=0.2), _view(0.3, 8.0, 1, scatter=3.0)
    off = [missed_by(LOGS, [way], CURVE, np.log(8.0)) for way in (sure, unsure)]
    assert off[0] < 0.1 < LEAST_SPREAD < off[1]
    assert _told(sure).spread == pytest.approx(LEAST_SPREAD, abs=0.03) and _told(unsure).spread > off[1]


def test_a_view_that_shows_nothing_leaves_the_size_to_the_others() -> None:
    telling, silent = _view(3.0, 8.0, 1), _view(0.0, 8.0, 2, features=400)
    assert _told(telling, silent).mean == pytest.approx(_told(telling).mean, abs=0.15)


@pytest.mark.parametrize(("features", "scatter"), [(40, 0.5), (400, 0.5), (639, 3.0)])
def test_where_nothing_goes_with_the_size_all_stay_open(features: int, scatter: float) -> None:
    spreads = [_told(_view(0.0, 8.0, seed, features=features, scatter=scatter)).spread for seed in range(6)]
    assert min(spreads) > 0.55, "an even spread over 2 to 32 has 0.8"


def test_what_no_size_explains_makes_none_the_surer() -> None:
    """The same features with an observation that is far from all sizes: a wider spread, not a narrower one."""
    near, far = (_told(_view(0.15, 8.0, 4, off=off)) for off in (0.0, 8.0))
    assert far.spread > near.spread - 0.02


@pytest.mark.parametrize(("true", "below", "above"), [(8.0, False, False), (0.5, True, False), (200.0, False, True)])
def test_a_size_beyond_all_that_were_tried_is_told_to_lie_there(true: float, below: bool, above: bool) -> None:
    told = _told(_view(3.0, true, 5))
    assert (told.below, told.above) == (below, above)


def test_the_order_of_draws_is_nothing() -> None:
    way, turned = _view(2.0, 6.0, 6), np.random.default_rng(0).permutation(DRAWS)
    told, again = _told(way), sized(LOGS[turned], [replace(way, shown=way.shown[turned])], CURVE)
    assert again is not None
    assert (again.mean, again.spread) == pytest.approx((told.mean, told.spread))


def test_too_few_draws_or_what_is_no_number_tell_no_size() -> None:
    way, few = _view(2.0, 6.0, 7), LEAST_DRAWS - 1
    assert sized(LOGS[:few], [replace(way, shown=way.shown[:few])], CURVE) is None
    assert sized(LOGS[:LEAST_DRAWS], [replace(way, shown=way.shown[:LEAST_DRAWS])], CURVE) is not None
    spoiled = np.where(np.arange(way.seen.size) == 3, np.nan, way.seen)
    assert sized(LOGS, [replace(way, seen=spoiled)], CURVE) is None


def test_features_that_are_alike_say_less() -> None:
    way = _view(0.5, 8.0, 8, features=20)
    assert _told(replace(way, alike=4.0)).spread > _told(way).spread


def test_a_way_of_looking_without_features_says_nothing() -> None:
    way, none = _view(2.0, 6.0, 9), Heard(shown=np.zeros((DRAWS, 0)), seen=np.zeros(0), variance=np.zeros(0))
    assert _told(way, none) == _told(way)
    assert sized(LOGS, [none], CURVE) is None
