"""Bending, shear, axial and torsional compliance of a tooth as a cantilever: seed (18)-(26), per unit cos^2(theta)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.tooth import NODES, FloatArray, RootModel, involute_h_m, involute_x_m, tooth_sections

SHEAR_FACTOR = 1.2
"""Timoshenko factor of a rectangle, as in the seed's (23)."""


@dataclass(frozen=True, kw_only=True)
class BeamCompliance:
    """Parts for K contact points, arrays (K,), aligned load (theta = 0)."""

    bending_m_per_n: FloatArray
    shear_m_per_n: FloatArray
    axial_m_per_n: FloatArray
    torsion_per_arm2_per_nm: FloatArray
    """Times t^2 (torsion arm t in m): the torsional compliance in m/N."""


def beam_compliance(
    gear: GearGeometry, alpha_1_rad: FloatArray, width_m: float, root_model: RootModel, nodes: int = NODES
) -> BeamCompliance:
    """Strain energy of the tooth under a unit load at alpha_1, shape (K,).

    (18) with I = (2h)^3 W/12 (second moment of a rectangle), (19) with one factor 1.2, (20), and (21) with
    I_p = 2h W (4h^2 + W^2)/12. On the involute these integrals are (23)-(26) with the arm t left outside.
    """
    beam = tooth_sections(gear, alpha_1_rad, root_model, nodes)
    cos_1, sin_1 = np.cos(alpha_1_rad)[:, None], np.sin(alpha_1_rad)[:, None]
    reach_m = involute_x_m(gear, -alpha_1_rad)[:, None] - beam.x_m
    offset_m = involute_h_m(gear, -alpha_1_rad)[:, None]
    area_m2 = 2 * beam.h_m * width_m
    second_m4 = (2 * beam.h_m) ** 3 * width_m / 12
    polar_m4 = area_m2 * (4 * beam.h_m**2 + width_m**2) / 12
    young_pa = gear.youngs_modulus_pa
    shear_pa = young_pa / (2 * (1 + gear.poisson_ratio))
    moment_m = cos_1 * reach_m - sin_1 * offset_m
    return BeamCompliance(
        bending_m_per_n=np.sum(beam.dx_m * moment_m**2 / (young_pa * second_m4), axis=-1),
        shear_m_per_n=np.sum(beam.dx_m * SHEAR_FACTOR * cos_1**2 / (shear_pa * area_m2), axis=-1),
        axial_m_per_n=np.sum(beam.dx_m * sin_1**2 / (young_pa * area_m2), axis=-1),
        torsion_per_arm2_per_nm=np.sum(beam.dx_m * cos_1**2 / (shear_pa * polar_m4), axis=-1),
    )
