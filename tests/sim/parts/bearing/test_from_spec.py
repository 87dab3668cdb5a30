"""From the specification's bearing to checked geometry, with problems under the caller's field."""

from __future__ import annotations

import math

import pytest

from sim.core.errors import SpecError
from sim.core.spec import BallGeometry, BearingSpec, SupportSpec
from sim.parts.bearing.from_spec import geometry_from_ball_spec, geometry_from_spec


def _bearing(catalogue: str | None = None, geometry: BallGeometry | None = None) -> BearingSpec:
    return BearingSpec(
        name="bearing1",
        body="pinion",
        catalogue=catalogue,
        geometry=geometry,
        inner_mass_kg=0.1,
        outer_mass_kg=0.1,
        shaft_stiffness_n_per_m=1e8,
        support=SupportSpec(stiffness_x_n_per_m=1e7, stiffness_y_n_per_m=1e7),
    )


def test_catalogue_designation() -> None:
    geometry = geometry_from_spec(_bearing(catalogue="6205-2RS"))
    assert geometry.balls == 9
    assert geometry.pitch_diameter_m == pytest.approx(39.04e-3, rel=1e-4)
    bearing = _bearing(catalogue="9999")
    with pytest.raises(SpecError, match="is not in the catalogue of bearings") as error:
        geometry_from_spec(bearing)
    assert [p.field for p in error.value.problems] == [f"bearings.{bearing.name}.catalogue"]


def test_a_roller_bearing_is_not_answered_with_ball_bearings_like_it() -> None:
    with pytest.raises(SpecError, match="cylindrical roller") as error:
        geometry_from_spec(_bearing(catalogue="SKF NU205"))
    assert "near it" not in str(error.value)


def test_own_geometry_in_degrees() -> None:
    spec = BallGeometry(balls=16, ball_diameter_m=0.022, pitch_diameter_m=0.125, contact_angle_deg=40)
    geometry = geometry_from_spec(_bearing(geometry=spec))
    assert geometry.contact_angle_rad == pytest.approx(math.radians(40))
    assert geometry.diameter_ratio == pytest.approx(0.176)


def test_ratio_completes_one_diameter() -> None:
    from_pitch = geometry_from_ball_spec(BallGeometry(balls=7, diameter_ratio=0.25, pitch_diameter_m=0.04))
    from_ball = geometry_from_ball_spec(BallGeometry(balls=7, diameter_ratio=0.25, ball_diameter_m=0.01))
    assert from_pitch == from_ball
    assert geometry_from_ball_spec(BallGeometry(balls=7, diameter_ratio=0.25)).ball_diameter_m is None


@pytest.mark.parametrize("both", [True, False])
def test_exactly_one_of_catalogue_and_geometry(both: bool) -> None:
    bearing = _bearing("6205", BallGeometry(balls=7, diameter_ratio=0.25)) if both else _bearing()
    with pytest.raises(SpecError) as error:
        geometry_from_spec(bearing, field="bearings.0")
    assert error.value.problems[0].field == "bearings.0.geometry"


def test_problems_carry_the_callers_field() -> None:
    spec = BallGeometry(balls=30, diameter_ratio=0.25)
    with pytest.raises(SpecError) as error:
        geometry_from_spec(_bearing(geometry=spec), field="bearings.2")
    assert error.value.problems[0].field == "bearings.2.geometry.balls"
    with pytest.raises(SpecError) as error:
        geometry_from_ball_spec(BallGeometry(balls=7, ball_diameter_m=0.01))
    assert error.value.problems[0].field == "geometry.pitch_diameter_m"
