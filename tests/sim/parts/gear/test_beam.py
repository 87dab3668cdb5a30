"""Tooth compliance against the seed's equations and an independent beam."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from sim.parts.gear import GearGeometry, GearPair
from sim.parts.gear.beam import beam_compliance
from sim.parts.gear.tooth import root_section, tooth_sections

Z23 = GearGeometry(teeth=23, module_m=2e-3, face_width_m=0.024, bore_radius_m=6.9e-3, youngs_modulus_pa=2.16e11)
Z81 = replace(Z23, teeth=81, bore_radius_m=24.3e-3)
ALPHA_1 = np.array([0.05, 0.2, 0.35])


def printed(gear: GearGeometry, alpha_1: float) -> tuple[float, float, float, float]:
    """Seed (23), (24) at theta = 0, (25) and the corrected (26) over t^2, with an adaptive quadrature."""
    a2, e, nu, w = gear.base_half_angle_rad, gear.youngs_modulus_pa, gear.poisson_ratio, gear.face_width_m
    c1, s1, rb = math.cos(alpha_1), math.sin(alpha_1), gear.base_radius_m

    def b(a: float) -> float:
        return math.sin(a) + (a2 - a) * math.cos(a)

    def run(f: Callable[[float], float]) -> float:
        return float(quad(lambda a: f(a) * (a2 - a) * math.cos(a), -alpha_1, a2, epsabs=0, epsrel=1e-12)[0])

    bending = run(lambda a: 3 * (1 + c1 * ((a2 - a) * math.sin(a) - math.cos(a))) ** 2 / (2 * e * w * b(a) ** 3))
    shear = run(lambda a: 1.2 * (1 + nu) * c1**2 / (e * w * b(a)))
    axial = run(lambda a: s1**2 / (2 * e * w * b(a)))
    torsion = run(lambda a: 12 * (1 + nu) * c1**2 / (e * w * b(a) * (4 * rb**2 * b(a) ** 2 + w**2)))
    return bending, shear, axial, torsion


@pytest.mark.parametrize("gear", [Z23, Z81])
@pytest.mark.parametrize("alpha_1", [0.02, 0.2, 0.4])
def test_clamped_at_base_is_the_seeds_equations(gear: GearGeometry, alpha_1: float) -> None:
    """(18)-(22) integrated over sections equal the printed (23)-(26) (corrected) over alpha."""
    found = beam_compliance(gear, np.array([alpha_1]), gear.face_width_m, "clamped_at_base")
    parts = (
        found.bending_m_per_n,
        found.shear_m_per_n,
        found.axial_m_per_n,
        found.torsion_per_arm2_per_nm,
    )
    for got, want in zip(parts, printed(gear, alpha_1), strict=True):
        assert got[0] == pytest.approx(want, rel=1e-9)


@pytest.mark.parametrize("gear", [Z23, Z81])
@pytest.mark.parametrize("root_model", ["clamped_at_base", "true_root"])
def test_bending_equals_integrating_the_beam_equation(gear: GearGeometry, root_model: str) -> None:
    """Slope and deflection of E I w'' = M integrated from the clamp give the same compliance as the energy."""
    alpha_1, w = 0.3, gear.face_width_m
    dense = tooth_sections(gear, np.array([alpha_1]), root_model, nodes=600)  # type: ignore[arg-type]
    order = np.argsort(dense.x_m[0])
    x, h = dense.x_m[0][order], dense.h_m[0][order]
    d, h_c = x[-1], h[-1]
    moment = math.cos(alpha_1) * (d - x) - math.sin(alpha_1) * h_c
    curvature = moment / (gear.youngs_modulus_pa * (2 * h) ** 3 * w / 12)
    step = np.diff(x)
    slope = np.concatenate([[0], np.cumsum(0.5 * (curvature[1:] + curvature[:-1]) * step)])
    bend = np.sum(0.5 * (slope[1:] + slope[:-1]) * step)
    along_force = math.cos(alpha_1) * bend - math.sin(alpha_1) * h_c * slope[-1]
    found = beam_compliance(gear, np.array([alpha_1]), w, root_model)  # type: ignore[arg-type]
    assert found.bending_m_per_n[0] == pytest.approx(along_force, rel=2e-4)


@pytest.mark.parametrize("gear", [Z23, Z81])
@pytest.mark.parametrize("root_model", ["clamped_at_base", "true_root"])
def test_quadrature_is_converged(gear: GearGeometry, root_model: str) -> None:
    """Default nodes against four times as many: 1e-9 as stated."""
    coarse = beam_compliance(gear, ALPHA_1, 0.024, root_model)  # type: ignore[arg-type]
    fine = beam_compliance(gear, ALPHA_1, 0.024, root_model, nodes=128)  # type: ignore[arg-type]
    for name in ("bending_m_per_n", "shear_m_per_n", "axial_m_per_n", "torsion_per_arm2_per_nm"):
        np.testing.assert_allclose(getattr(coarse, name), getattr(fine, name), rtol=1e-9)


def test_true_root_moves_the_clamp_both_ways() -> None:
    """Rf < Rb (23 teeth): longer beam than to the base circle; Rf > Rb (81 teeth): shorter, hence stiffer."""
    assert Z23.root_radius_m < Z23.base_radius_m
    assert Z81.root_radius_m > Z81.base_radius_m
    for gear, sign in ((Z23, -1), (Z81, 1)):
        clamps = [root_section(gear, m).clamp_m for m in ("clamped_at_base", "true_root")]
        assert (clamps[1] - clamps[0]) * sign > 0
    soft = beam_compliance(replace(Z23, fillet_radius_coefficient=0.0), ALPHA_1, 0.024, "true_root")
    base = beam_compliance(Z23, ALPHA_1, 0.024, "clamped_at_base")
    assert np.all(soft.bending_m_per_n > base.bending_m_per_n)


@given(
    st.integers(12, 200), st.floats(5e-4, 2e-2), st.floats(0.0, 0.5), st.sampled_from(["clamped_at_base", "true_root"])
)
def test_sections_add_up_to_the_tooth(teeth: int, module_m: float, fillet: float, model: str) -> None:
    """The weights sum to the height from clamp to contact; thickness is positive."""
    gear = replace(Z23, teeth=teeth, module_m=module_m, bore_radius_m=0.0, fillet_radius_coefficient=fillet)
    alpha_1 = np.array([math.tan(gear.pressure_angle_rad) - gear.base_half_angle_rad])
    beam = tooth_sections(gear, alpha_1, model)  # type: ignore[arg-type]
    clamp_m = root_section(gear, model).clamp_m
    pitch_point_m = gear.pitch_radius_m * math.cos(math.pi / 2 / teeth)
    assert beam.dx_m.sum() == pytest.approx(pitch_point_m - clamp_m, rel=1e-9)
    assert np.all(beam.h_m > 0)


def test_wider_teeth_are_stiffer(paper_pair: Callable[..., GearPair]) -> None:
    """Aligned compliance goes with 1/W."""
    one = beam_compliance(paper_pair().pinion, ALPHA_1, 0.012, "true_root")
    two = beam_compliance(paper_pair().pinion, ALPHA_1, 0.024, "true_root")
    np.testing.assert_allclose(one.bending_m_per_n, 2 * two.bending_m_per_n, rtol=1e-12)
