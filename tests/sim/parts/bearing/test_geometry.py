"""Geometry checks: what cannot be built is refused with the field and what is allowed."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.parts.bearing.geometry import CAGE_MARGIN, RollingGeometry, from_diameters, most_balls


def _fields(error: pytest.ExceptionInfo[SpecError]) -> set[str]:
    return {p.field for p in error.value.problems}


def test_too_many_balls_names_the_largest_number() -> None:
    with pytest.raises(SpecError) as error:
        from_diameters(balls=16, ball_diameter_m=7.94e-3, pitch_diameter_m=39.04e-3)
    (problem,) = error.value.problems
    assert problem.field == "balls"
    assert problem.given == 16
    assert problem.allowed == f"3 to {most_balls(7.94 / 39.04)}"
    from_diameters(balls=most_balls(7.94 / 39.04), ball_diameter_m=7.94e-3, pitch_diameter_m=39.04e-3)


@given(ratio=st.floats(0.011, 0.6))
def test_most_balls_fit_and_one_more_does_not(ratio: float) -> None:
    most = most_balls(ratio)
    needed = (1 + CAGE_MARGIN) * ratio
    assert math.sin(math.pi / most) >= needed * (1 - 1e-6)
    assert math.sin(math.pi / (most + 1)) < needed


def test_disagreeing_ratio_and_lone_diameter_are_refused() -> None:
    with pytest.raises(SpecError) as error:
        RollingGeometry(balls=8, diameter_ratio=0.3, ball_diameter_m=0.01, pitch_diameter_m=0.05)
    assert _fields(error) == {"diameter_ratio"}
    assert "0.2" in error.value.problems[0].allowed
    with pytest.raises(SpecError) as error:
        RollingGeometry(balls=8, diameter_ratio=0.2, ball_diameter_m=0.01)
    assert _fields(error) == {"pitch_diameter_m"}


def test_millimetres_are_recognised() -> None:
    with pytest.raises(SpecError, match="meant in mm"):
        from_diameters(balls=9, ball_diameter_m=7.94, pitch_diameter_m=9.99)


@pytest.mark.parametrize("bad", [0.0, -0.01, math.nan, math.inf])
def test_lengths_must_be_positive_and_finite(bad: float) -> None:
    with pytest.raises(SpecError) as error:
        from_diameters(balls=9, ball_diameter_m=bad, pitch_diameter_m=0.039)
    assert "ball_diameter_m" in _fields(error)


def test_every_wrong_number_is_listed_at_once() -> None:
    with pytest.raises(SpecError) as error:
        RollingGeometry(balls=1, diameter_ratio=math.nan, inner_groove_ratio=0.5, contact_angle_rad=2.0)
    assert _fields(error) == {"balls", "diameter_ratio", "inner_groove_ratio", "contact_angle_rad"}


def test_ring_narrower_than_its_balls() -> None:
    with pytest.raises(SpecError) as error:
        from_diameters(balls=9, ball_diameter_m=7.94e-3, pitch_diameter_m=39.04e-3, width_m=5e-3)
    assert _fields(error) == {"width_m"}


def test_ratio_alone_is_enough_for_orders_but_not_for_stiffness() -> None:
    geometry = RollingGeometry(balls=7, diameter_ratio=0.2647)
    assert geometry.gamma == 0.2647
    with pytest.raises(SpecError, match="ball_diameter_m"):
        geometry.diameters_m()
