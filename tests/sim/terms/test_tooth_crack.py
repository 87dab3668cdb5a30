"""The compliance of a cracked tooth."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad

from sim.parts.gear.crack import crack_compliance_m_per_n
from sim.parts.gear.flank import flank_of
from sim.presets import preset
from sim.terms import REGISTRY

MACHINE = preset("paper-lightly-damped")
DEVIATION = REGISTRY.get("tooth_crack").validation[0].deviation


def energy_integral(gear, alpha_1, width, left):
    """Bending and shear of seed (24), (25), with the half thickness of one side at most `left` base radii."""
    half, young, poisson = gear.base_half_angle_rad, gear.youngs_modulus_pa, gear.poisson_ratio

    def thickness(a):
        h = math.sin(a) + (half - a) * math.cos(a)
        return h + min(h, left)

    def density(a):
        lever = 1.0 + math.cos(alpha_1) * ((half - a) * math.sin(a) - math.cos(a))
        strip = (half - a) * math.cos(a)
        bending = 12.0 * lever**2 * strip / (young * width * thickness(a) ** 3)
        return bending + 2.4 * (1.0 + poisson) * math.cos(alpha_1) ** 2 * strip / (young * width * thickness(a))

    return quad(density, -alpha_1, half, epsabs=0.0, epsrel=1e-10, limit=400)[0]


@pytest.mark.parametrize("gear", ["pinion", "gear"])
@pytest.mark.parametrize(("depth", "angle"), [(0.05, 70.0), (0.2, 45.0), (0.35, 70.0), (0.5, 90.0)])
def test_compliance_equals_an_integral_over_the_angle(gear, depth, angle):
    flank = flank_of(MACHINE, "mesh1", gear)
    tooth, alpha_1 = flank.tooth, flank.alpha_1_rad[::16]
    found = crack_compliance_m_per_n(
        tooth, alpha_1, flank.pair.width_m, "clamped_at_base", depth_share=depth, angle_rad=math.radians(angle)
    )
    left = tooth.base_half_angle_rad * (1.0 - 2.0 * depth * math.sin(math.radians(angle)))
    expected = [
        energy_integral(tooth, a, flank.pair.width_m, left) - energy_integral(tooth, a, flank.pair.width_m, np.inf)
        for a in alpha_1
    ]
    assert found == pytest.approx(expected, rel=DEVIATION, abs=1e-6 * max(expected))


@pytest.mark.parametrize("root_model", ["clamped_at_base", "true_root"])
def test_it_grows_with_depth_and_angle_and_with_the_arm_of_the_load(root_model):
    flank = flank_of(MACHINE, "mesh1", "pinion")

    def gained(depth, angle):
        return crack_compliance_m_per_n(
            flank.tooth, flank.alpha_1_rad, flank.pair.width_m, root_model, depth_share=depth, angle_rad=angle
        )

    assert np.all(gained(0.0, 1.2) == pytest.approx(0.0, abs=1e-16))
    assert np.all(gained(0.3, 1.2) > gained(0.2, 1.2))
    assert np.all(gained(0.3, 1.2) > gained(0.3, 0.8))
    assert np.all(np.diff(gained(0.3, 1.2)) > 0.0)  # towards the pinion's tip
