"""Fillet foundation against the figures printed with it; Hertz; torsion arm."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.parts.gear import GearGeometry
from sim.parts.gear.foundation import FIT_RATIO, FIT_THETA_RAD, body_factors, foundation_compliance_m_per_n
from sim.parts.gear.hertz import hertz_compliance_m_per_n
from sim.parts.gear.offset import torsion_arm_m

GEAR = GearGeometry(teeth=23, module_m=2e-3, face_width_m=0.024, bore_radius_m=6.9e-3, youngs_modulus_pa=2.16e11)

# Largest L* and P* over the fitted range as quoted from Sainsot, Velex, Duverger (2004), Table 1, by the open ROSS
# project (gear element with time-varying stiffness). The quoted ends of M* and Q* lie inside what the polynomials
# themselves reach in the corners of the range, so they can't serve as a check.
LARGEST = {0: 6.94, 2: 13.47}


def test_factors_reach_the_quoted_maxima() -> None:
    """A slip in any coefficient of L* or P* that matters moves these by more than 1 %."""
    grid = [body_factors(h, t) for h in np.linspace(*FIT_RATIO, 60) for t in np.linspace(*FIT_THETA_RAD, 60)]
    values = np.array(grid)
    for column, high in LARGEST.items():
        assert values[:, column].max() == pytest.approx(high, rel=0.01)


def test_factors_are_held_outside_the_range() -> None:
    """A gear without bore and a thin ring use the limits."""
    assert body_factors(math.inf, 0.05) == body_factors(7.0, 0.05)
    assert body_factors(1.0, 0.5) == body_factors(1.4, 0.12)


def test_foundation_at_one_point_by_hand() -> None:
    """z = 23, alpha_1 = 0.2, h = 20.5/6.9, S_f = 2 Rb alpha_2: the formula written out."""
    h, theta = 20.5 / 6.9, 0.0831980 * 21.6129303 / 20.5
    low, moment, shear, axial = body_factors(h, theta)
    lever = (21.6129303 / math.cos(0.2) - 20.5) / (2 * 21.6129303 * 0.0831980)
    want = math.cos(0.2) ** 2 / (2.16e11 * 0.024)
    want *= low * lever**2 + moment * lever + shear * (1 + axial * math.tan(0.2) ** 2)
    found = foundation_compliance_m_per_n(GEAR, np.array([0.2]), 0.024, "clamped_at_base")
    assert found[0] == pytest.approx(want, rel=1e-5)


def test_hertz_of_equal_steels() -> None:
    """k_h = pi E W / (4 (1 - nu^2)), Yang and Sun (1985)."""
    want = math.pi * 2.16e11 * 0.024 / (4 * 0.91)
    assert 1 / hertz_compliance_m_per_n(GEAR, GEAR, 0.024) == pytest.approx(want, rel=1e-12)


@given(st.floats(-0.02, 0.02), st.floats(1e-7, 1e-4), st.floats(1e-3, 0.2))
def test_torsion_arm_is_odd_bounded_and_zero_when_aligned(tilt: float, deflection: float, width: float) -> None:
    """Limits of the spring-bed model."""
    arm = float(torsion_arm_m(np.array(tilt), width, deflection))
    assert arm == -float(torsion_arm_m(np.array(-tilt), width, deflection))
    assert abs(arm) <= width / 2
    assert arm * tilt >= 0
    assert float(torsion_arm_m(np.array(0.0), width, deflection)) == 0.0


@pytest.mark.parametrize("ratio", [0.3, 1.5, 1.999, 2.001, 8.0, 50.0])
def test_torsion_arm_is_the_centre_of_the_pressed_springs(ratio: float) -> None:
    """Against a numerical bed of springs with the same load."""
    width, mean = 0.024, 1e-5
    slope = ratio * mean / width
    z = (np.arange(200_000) + 0.5) / 200_000 * width - width / 2
    low, high = -ratio * mean, 2 * ratio * mean + 2 * mean
    for _ in range(60):
        offset = 0.5 * (low + high)
        low, high = (offset, high) if np.maximum(0, offset + z * slope).mean() < mean else (low, offset)
    load = np.maximum(0, offset + z * slope)
    arm = float(torsion_arm_m(np.array(math.atan(slope)), width, mean))
    assert arm == pytest.approx(float((load * z).sum() / load.sum()), rel=1e-4)


def test_the_seeds_constant_arm_is_one_point_of_the_model() -> None:
    """W/8 at W tan(theta) = 1.5 times the deflection."""
    tilt = np.array(math.atan(1.5e-5 / 0.024))
    assert float(torsion_arm_m(tilt, 0.024, 1e-5)) == pytest.approx(0.003, rel=1e-12)
