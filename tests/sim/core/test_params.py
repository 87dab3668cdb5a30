"""Parameters say what is wrong and in which unit."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.params import Param

GAP = Param(name="gap", unit="m", default=2e-5, low=0.0, high=5e-4, sentence="A gap.", scale="log")


@given(st.floats(0.0, 5e-4))
def test_everything_within_bounds_is_allowed(value):
    assert GAP.problem(value, "x") is None


@given(st.one_of(st.floats(max_value=-1e-300), st.floats(min_value=5.001e-4)))
def test_everything_outside_is_not(value):
    problem = GAP.problem(value, "terms.0.gap")
    assert problem is not None
    assert problem.field == "terms.0.gap"
    assert problem.allowed == "0 to 0.0005"
    assert problem.unit == "m"


@pytest.mark.parametrize("value", [math.nan, math.inf, True, "1e-5", None])
def test_what_is_not_a_finite_number(value):
    problem = GAP.problem(value, "x")
    assert problem is not None
    assert "finite number" in problem.message


@pytest.mark.parametrize(("value", "unit"), [(0.02, "mm"), (20.0, "um")])
def test_lengths_in_other_units_get_a_hint(value, unit):
    problem = GAP.problem(value, "x")
    assert problem is not None
    assert f"if meant in {unit}" in problem.message


def test_choices():
    param = Param(name="n", unit="1", default=1.0, low=0.0, high=3.0, sentence="A choice.", choices=(1.0, 3.0))
    assert param.problem(3.0, "x") is None
    problem = param.problem(2.0, "x")
    assert problem is not None
    assert problem.allowed == "1, 3"
