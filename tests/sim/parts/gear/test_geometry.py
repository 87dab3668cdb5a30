"""Closed forms of the involute gear and the gears that can't exist."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.parts.gear.geometry import GearGeometry, derived_inertia_kg_m2, derived_mass_kg
from sim.parts.gear.involute import inverse_involute, involute
from sim.parts.gear.tooth import involute_h_m, involute_x_m

GEAR = GearGeometry(teeth=23, module_m=2e-3, face_width_m=0.024, bore_radius_m=6.9e-3, youngs_modulus_pa=2.16e11)


def test_radii_of_the_seeds_pinion() -> None:
    """The base radius is the one in the reference's parameter list."""
    assert GEAR.base_radius_m == pytest.approx(0.021612930278075895, rel=1e-14)
    assert (GEAR.tip_radius_m, GEAR.root_radius_m) == pytest.approx((25e-3, 20.5e-3))


def test_involute_of_20_degrees() -> None:
    """inv 20 deg = 0.014904 (ISO 21771:2007, any gear table)."""
    assert involute(math.radians(20)) == pytest.approx(0.0149043838, abs=1e-10)


@given(st.floats(0.01, 1.2))
def test_inverse_involute_undoes_it(angle: float) -> None:
    """Round trip."""
    assert inverse_involute(involute(angle)) == pytest.approx(angle, abs=1e-9)


@given(st.integers(10, 120), st.floats(-0.2, 0.5))
def test_tooth_thickness_on_the_pitch_circle(teeth: int, shift: float) -> None:
    """s = m (pi/2 + 2 x tan alpha) on the reference circle, read off the flank in the tooth's own coordinates."""
    gear = replace(GEAR, teeth=teeth, profile_shift_coefficient=shift)
    alpha = np.array(gear.base_half_angle_rad - math.tan(gear.pressure_angle_rad))
    x, h = float(involute_x_m(gear, alpha)), float(involute_h_m(gear, alpha))
    assert math.hypot(x, h) == pytest.approx(gear.pitch_radius_m, rel=1e-12)
    thickness = gear.module_m * (math.pi / 2 + 2 * shift * math.tan(gear.pressure_angle_rad))
    assert 2 * math.atan2(h, x) * gear.pitch_radius_m == pytest.approx(thickness, rel=1e-12)


def test_mass_and_inertia_of_an_annulus() -> None:
    """Against a sum over thin rings."""
    edges = np.linspace(GEAR.bore_radius_m, GEAR.pitch_radius_m, 20001)
    middle = 0.5 * (edges[1:] + edges[:-1])
    rings = 7850 * 2 * np.pi * middle * np.diff(edges) * GEAR.face_width_m
    assert derived_mass_kg(GEAR, 7850) == pytest.approx(rings.sum(), rel=1e-8)
    assert derived_inertia_kg_m2(GEAR, 7850) == pytest.approx((rings * middle**2).sum(), rel=1e-8)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("teeth", 0),
        ("module_m", -1e-3),
        ("module_m", float("nan")),
        ("face_width_m", float("inf")),
        ("youngs_modulus_pa", 0.0),
        ("bore_radius_m", 0.0206),
        ("profile_shift_coefficient", 1.5),
    ],
)
def test_impossible_gears_name_the_field(field: str, value: float) -> None:
    """Not positive, not finite, bore in the roots, pointed teeth."""
    with pytest.raises(SpecError) as caught:
        replace(GEAR, **{field: value})  # type: ignore[arg-type]
    assert caught.value.problems[0].field == field


def test_teeth_deeper_than_the_gear() -> None:
    """A 6-tooth gear with negative shift has no root circle left."""
    with pytest.raises(SpecError, match="root radius"):
        replace(GEAR, teeth=6, addendum_coefficient=2.0, tip_clearance_coefficient=1.2, bore_radius_m=0.0)
