"""The likelihood of a size, by draws about it: closed forms and what it must not do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reconcile.machine.severity import LEAST_SPREAD
from reconcile.machine.size_likelihood import LEAST_DRAWS, Heard, sized

DRAWS, WIDE = 24, 0.35
LOGS = np.linspace(np.log(2.0), np.log(32.0), DRAWS)
"""Sizes 2 to 32."""


def _view(slope: float, true: float, seed: int, features: int = 40, scatter: float = 0.5, off: float = 0.0) -> Heard:
    """Features that go with the logarithm of the size at slopes about `slope`, on machines that scatter; the
    observation is of the `true` size with a measurement error of one, and of something else by `off`."""
    rng = np.random.default_rng(seed)
    slopes = slope * rng.normal(size=features)
    shown = np.outer(LOGS, slopes) + scatter * rng.normal(size=(DRAWS, features))
    seen = np.log(true) * slopes + rng.normal(size=features) + scatter * rng.normal(size=features)
    seen = seen + off * rng.normal(size=features)
    return Heard(shown=shown, seen=seen, variance=np.ones(features))


@given(true=st.floats(3.0, 20.0), seed=st.integers(0, 1000))
def test_the_size_is_found_where_the_views_go_with_it(true: float, seed: int) -> None:
    told = sized(LOGS, [_view(3.0, true, seed), _view(2.0, true, seed + 1)], WIDE)
    assert told is not None
    assert abs(told[0] - np.log(true)) < 0.35
    assert LEAST_SPREAD <= told[1] < 0.4


def test_a_view_that_shows_nothing_leaves_the_size_to_the_others() -> None:
    telling, silent = _view(3.0, 8.0, 1), _view(0.0, 8.0, 2, features=400)
    alone, both = sized(LOGS, [telling], WIDE), sized(LOGS, [telling, silent], WIDE)
    assert alone is not None and both is not None
    assert both[0] == pytest.approx(alone[0], abs=0.15)


def test_where_nothing_goes_with_the_size_all_stay_open() -> None:
    told = sized(LOGS, [_view(0.0, 8.0, 3)], WIDE)
    assert told is not None
    assert told[1] > 0.45  # an even spread over 2 to 32 has 0.8, chance takes some of that


def test_what_no_size_explains_makes_none_the_surer() -> None:
    """The same features with an observation that is far from all sizes: a wider spread, not a narrower one."""
    near, far = (sized(LOGS, [_view(0.15, 8.0, 4, off=off)], WIDE) for off in (0.0, 8.0))
    assert near is not None and far is not None
    assert far[1] > near[1]


def test_machines_that_scatter_say_less() -> None:
    spreads = []
    for scatter in (0.2, 4.0):
        told = sized(LOGS, [_view(0.8, 8.0, 5, scatter=scatter)], WIDE)
        assert told is not None
        spreads.append(told[1])
    assert spreads[1] > spreads[0]


def test_the_order_of_draws_is_nothing() -> None:
    way, turned = _view(2.0, 6.0, 6), np.random.default_rng(0).permutation(DRAWS)
    told, again = sized(LOGS, [way], WIDE), sized(LOGS[turned], [replace(way, shown=way.shown[turned])], WIDE)
    assert told is not None and again is not None
    assert again == pytest.approx(told)


def test_too_few_draws_tell_no_size() -> None:
    way, few = _view(2.0, 6.0, 7), LEAST_DRAWS - 1
    assert sized(LOGS[:few], [replace(way, shown=way.shown[:few])], WIDE) is None
    assert sized(LOGS[:LEAST_DRAWS], [replace(way, shown=way.shown[:LEAST_DRAWS])], WIDE) is not None


def test_features_that_are_alike_say_less() -> None:
    way = _view(0.8, 8.0, 8, features=20)
    alone, alike = sized(LOGS, [way], WIDE), sized(LOGS, [replace(way, alike=4.0)], WIDE)
    assert alone is not None and alike is not None
    assert alike[1] > alone[1]
    assert alike[0] == pytest.approx(alone[0], abs=0.2)


def test_a_way_of_looking_without_features_says_nothing() -> None:
    way, none = _view(2.0, 6.0, 9), Heard(shown=np.zeros((DRAWS, 0)), seen=np.zeros(0), variance=np.zeros(0))
    assert sized(LOGS, [way, none], WIDE) == sized(LOGS, [way], WIDE)
