"""Compliance that a crack at the root adds to a tooth: the potential-energy method on reduced sections.

A straight crack of length q starts at the loaded side of the root and runs into the tooth at the angle nu to its centre
line. Everything outside the line through its tip, parallel to the centre line, carries nothing (Wu, Zuo, Parey 2008, J.
Sound Vib. 317(3-5), 608-624; straight cracks also in Chaari, Fakhfakh, Haddar 2009, Eur. J. Mech. A/Solids 28(3),
461-468): the half thickness on the cracked side is at most h_c - q sin(nu). Bending and shear grow; axial compression
closes the crack, and contact and gear body stay as they are.
"""

from __future__ import annotations

import math

import numpy as np

from sim.parts.gear.beam import SHEAR_FACTOR
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.tooth import (
    NODES,
    FloatArray,
    RootModel,
    ToothSections,
    involute_h_m,
    involute_x_m,
    root_section,
    tooth_sections,
)


def half_root_m(gear: GearGeometry, root_model: RootModel) -> float:
    """Half thickness of the thickest section at the root, where the crack starts, m."""
    root = root_section(gear, root_model)
    # the involute is thickest at alpha = 0, a little above the base circle
    bulge_m = gear.base_radius_m * gear.base_half_angle_rad if root.lowest_alpha_rad > 0.0 else 0.0
    if root_model == "clamped_at_base":
        return bulge_m
    return max(bulge_m, float(involute_h_m(gear, np.array(root.lowest_alpha_rad))) + gear.fillet_height_m)


def _bent_and_sheared(
    gear: GearGeometry, alpha_1_rad: FloatArray, width_m: float, beam: ToothSections, thickness_m: FloatArray
) -> FloatArray:
    """Bending and shear compliance for sections of a given thickness, m/N (as in `beam_compliance`)."""
    cos_1, sin_1 = np.cos(alpha_1_rad)[:, None], np.sin(alpha_1_rad)[:, None]
    reach_m = involute_x_m(gear, -alpha_1_rad)[:, None] - beam.x_m
    moment_m = cos_1 * reach_m - sin_1 * involute_h_m(gear, -alpha_1_rad)[:, None]
    young_pa = gear.youngs_modulus_pa
    shear_pa = young_pa / (2 * (1 + gear.poisson_ratio))
    bending = moment_m**2 / (young_pa * thickness_m**3 * width_m / 12)
    shear = SHEAR_FACTOR * cos_1**2 / (shear_pa * thickness_m * width_m)
    return np.asarray(np.sum(beam.dx_m * (bending + shear), axis=-1))


def crack_compliance_m_per_n(
    gear: GearGeometry,
    alpha_1_rad: FloatArray,
    width_m: float,
    root_model: RootModel,
    *,
    depth_share: float,
    angle_rad: float,
    nodes: int = 16 * NODES,
) -> FloatArray:
    """Compliance gained by a crack through the whole width, shape of `alpha_1_rad` (K,), m/N.

    `depth_share`: length of the crack over the thickness of the root, at most 0.5. More nodes than for a sound tooth,
    because the section has a corner where the dead zone ends.
    """
    beam = tooth_sections(gear, alpha_1_rad, root_model, nodes)
    left_m = half_root_m(gear, root_model) * (1.0 - 2.0 * depth_share * math.sin(angle_rad))
    cracked = beam.h_m + np.minimum(beam.h_m, left_m)
    whole = _bent_and_sheared(gear, alpha_1_rad, width_m, beam, 2.0 * beam.h_m)
    return _bent_and_sheared(gear, alpha_1_rad, width_m, beam, cracked) - whole
