"""Point contact against worked examples, limits, an approximation and the general Hertz solution."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.parts.bearing.ellipse import contact_ellipse, curvature_difference
from sim.parts.bearing.geometry import RollingGeometry, from_diameters
from sim.parts.bearing.hertz import (
    Curvature,
    Elasticity,
    ball_race_stiffness_n_per_m15,
    point_stiffness_n_per_m15,
    race_curvature,
    race_stiffness_n_per_m15,
    series_stiffness,
    tangent_stiffness_n_per_m,
)

DGBB_209 = from_diameters(
    balls=9, ball_diameter_m=12.7e-3, pitch_diameter_m=65e-3, inner_groove_ratio=0.52, outer_groove_ratio=0.52
)
ACBB_218 = from_diameters(
    balls=16,
    ball_diameter_m=22.23e-3,
    pitch_diameter_m=125.3e-3,
    contact_angle_rad=math.radians(40),
    inner_groove_ratio=0.5232,
    outer_groove_ratio=0.5232,
)


def test_209_curvatures_of_the_worked_example() -> None:
    """Harris & Kotzalas, 5th ed., chapter 2: 0.202 and 0.138 1/mm, F 0.9399 and 0.9120 (209 bearing)."""
    inner, outer = race_curvature(DGBB_209, "inner"), race_curvature(DGBB_209, "outer")
    assert inner.sum_per_m == pytest.approx(202, abs=0.5)
    assert inner.difference == pytest.approx(0.9399, abs=2e-4)
    assert outer.sum_per_m == pytest.approx(138, abs=0.5)
    assert outer.difference == pytest.approx(0.9120, abs=2e-4)


def test_218_curvatures_and_ellipse_of_the_worked_example() -> None:
    """Harris & Kotzalas, 5th ed., chapters 2 and 6: 0.108 1/mm, F 0.9260, a* 3.50, b* 0.430 (218, inner race)."""
    inner = race_curvature(ACBB_218, "inner")
    assert inner.sum_per_m == pytest.approx(108, abs=0.5)
    assert inner.difference == pytest.approx(0.9260, abs=3e-4)
    ellipse = contact_ellipse(inner.difference)
    assert ellipse.semi_major == pytest.approx(3.50, rel=5e-3)
    assert ellipse.semi_minor == pytest.approx(0.430, rel=3e-3)


def test_steel_load_deflection_factor() -> None:
    """Harris & Kotzalas, chapter 7: K = 2.15e5 (sum rho)^-1/2 (delta*)^-3/2 in N and mm for steel balls and races."""
    curvature = race_curvature(DGBB_209, "inner")
    book = 2.15e5 * (curvature.sum_per_m * 1e-3) ** -0.5 * contact_ellipse(curvature.difference).approach ** -1.5
    ours = point_stiffness_n_per_m15(curvature, Elasticity(youngs_modulus_pa=2.07e11, poisson_ratio=0.3))
    assert ours == pytest.approx(book * 1e3**1.5, rel=5e-3)


def test_sphere_on_plane_closed_form() -> None:
    """Equal materials: Q = (4/3) E* sqrt(R) delta^1.5 with 1/E* = 2 (1 - nu^2)/E (Johnson, 1985, eq. 4.23)."""
    steel = Elasticity(youngs_modulus_pa=2e11, poisson_ratio=0.3)
    radius_m = 4e-3
    ours = point_stiffness_n_per_m15(Curvature(sum_per_m=2 / radius_m, difference=0.0), steel)
    assert ours == pytest.approx(4 / 3 * steel.plane_modulus_pa / 2 * math.sqrt(radius_m), rel=1e-12)


def test_circular_contact_has_unit_factors() -> None:
    ellipse = contact_ellipse(0.0)
    factors = (ellipse.axis_ratio, ellipse.semi_major, ellipse.semi_minor, ellipse.approach)
    assert factors == pytest.approx((1, 1, 1, 1), abs=1e-12)


@given(st.floats(1e-6, 0.9999))
def test_ellipse_inverts_the_curvature_difference(difference: float) -> None:
    ellipse = contact_ellipse(difference)
    assert curvature_difference(ellipse.axis_ratio) == pytest.approx(difference, abs=1e-9)
    assert ellipse.axis_ratio == pytest.approx(ellipse.semi_major / ellipse.semi_minor)
    assert 0 < ellipse.approach <= 1 + 1e-9


def test_series_about_the_circle_joins_the_elliptic_form() -> None:
    just_below, just_above = math.sqrt(1 + 0.99e-6), math.sqrt(1 + 1.01e-6)
    slope = (curvature_difference(just_above) - curvature_difference(just_below)) / (just_above - just_below)
    assert slope == pytest.approx(0.75, rel=0.02)


@given(st.floats(0.515, 0.54), st.floats(0.05, 0.3))
def test_hamrock_brewe_approximation_agrees(groove: float, ratio: float) -> None:
    """Fits of Hamrock & Brewe, J. Lubr. Tech. 105 (1983) 171-177: both within 4 % up to Ry/Rx = 50."""
    ball_m = 0.01
    geometry = from_diameters(
        balls=3,
        ball_diameter_m=ball_m,
        pitch_diameter_m=ball_m / ratio,
        inner_groove_ratio=groove,
        outer_groove_ratio=groove,
    )
    for race, sign in (("inner", 1), ("outer", -1)):
        curvature_x = 2 / ball_m * (1 + sign * ratio / (1 - sign * ratio))
        curvature_y = 2 / ball_m - 1 / (groove * ball_m)
        quotient = curvature_x / curvature_y
        kappa = 1.0339 * quotient**0.636
        e, k = 1.0003 + 0.5968 / quotient, 1.5277 + 0.6023 * math.log(quotient)
        exact = race_curvature(geometry, race)  # type: ignore[arg-type]
        assert contact_ellipse(exact.difference).axis_ratio == pytest.approx(kappa, rel=0.04)
        total = curvature_x + curvature_y
        approach = 2 * k / math.pi * (math.pi / (2 * kappa**2 * e)) ** (1 / 3)
        steel = Elasticity(youngs_modulus_pa=2.06e11, poisson_ratio=0.3)
        approximate = steel.plane_modulus_pa * total / 3 * (2 / (approach * total)) ** 1.5
        assert race_stiffness_n_per_m15(geometry, race, steel) == pytest.approx(approximate, rel=0.04)  # type: ignore[arg-type]


@given(st.floats(0.505, 0.57), st.floats(1.002, 1.05))
def test_wider_groove_is_softer(groove: float, factor: float) -> None:
    def stiffness(inner: float) -> float:
        return ball_race_stiffness_n_per_m15(
            from_diameters(balls=7, ball_diameter_m=9.525e-3, pitch_diameter_m=36e-3, inner_groove_ratio=inner)
        )

    assert math.isfinite(stiffness(groove))
    assert stiffness(groove * factor) < stiffness(groove)


def test_series_adds_deflections_and_is_symmetric() -> None:
    load_n, first, second = 500.0, 3e10, 4e10
    both = series_stiffness(first, second)
    assert (load_n / both) ** (2 / 3) == pytest.approx((load_n / first) ** (2 / 3) + (load_n / second) ** (2 / 3))
    assert both == series_stiffness(second, first) < min(first, second)


def test_magnitude_for_the_seed_sizes() -> None:
    """1e9 to 1e10 N/m^1.5 is what ball-race stiffness of these sizes amounts to."""
    geometry = from_diameters(balls=7, ball_diameter_m=9.525e-3, pitch_diameter_m=36e-3)
    assert 5e9 < ball_race_stiffness_n_per_m15(geometry) < 2e10


def test_tangent_is_the_derivative() -> None:
    k, squeeze_m, h = 1e10, 5e-6, 1e-10
    numeric = k * ((squeeze_m + h) ** 1.5 - (squeeze_m - h) ** 1.5) / (2 * h)
    assert tangent_stiffness_n_per_m(k, k * squeeze_m**1.5) == pytest.approx(numeric, rel=1e-6)


def test_ratio_only_geometry_has_no_stiffness() -> None:
    with pytest.raises(SpecError):
        ball_race_stiffness_n_per_m15(RollingGeometry(balls=7, diameter_ratio=0.2647))


@pytest.mark.parametrize("bad", [-0.1, 1.0, math.nan])
def test_impossible_curvature_difference(bad: float) -> None:
    with pytest.raises(ValueError, match="curvature difference"):
        contact_ellipse(bad)
