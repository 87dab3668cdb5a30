"""How far a law is followed: as far as its shape asks."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.solve.law_picture.scale import rounded, telling_reach


@given(st.floats(-6.0, -3.0).map(lambda x: 10.0**x))
def test_a_dead_zone_is_seen_from_both_sides(gap):
    reach = telling_reach(lambda x: max(x - gap, 0.0) + min(x + gap, 0.0), "m")
    assert 1.2 * gap < reach < 5.0 * gap


@pytest.mark.parametrize("law", [lambda x: 3.0 * x, lambda x: 5.0, lambda x: max(x, 0.0), lambda x: 0.0])
def test_what_looks_alike_at_every_scale_is_shown_at_the_usual_one(law):
    assert telling_reach(law, "m") == 1e-5


def test_a_hardening_spring_is_seen_to_harden():
    reach = telling_reach(lambda x: 1e7 * x + 1e17 * x**3, "m")
    assert 0.3 < 1e10 * reach**2 < 10.0


@given(st.floats(1e-9, 1e9))
def test_rounding_goes_up_by_less_than_two(value):
    assert value <= rounded(value) * (1 + 1e-8) and rounded(value) < 1.7 * value * (1 + 1e-8)
