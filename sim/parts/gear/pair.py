"""Stiffness of ONE tooth pair along the path of contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.parts.gear.beam import beam_compliance
from sim.parts.gear.checks import check_centre_distance, check_mates, check_tip_clearance, gear_warnings
from sim.parts.gear.contact import ContactGeometry, standard_centre_distance_m
from sim.parts.gear.foundation import foundation_compliance_m_per_n
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.helix import POINTS, Helix, helix_of, spread
from sim.parts.gear.hertz import hertz_compliance_m_per_n
from sim.parts.gear.offset import torsion_arm_m
from sim.parts.gear.tooth import NODES, FloatArray, RootModel

__all__ = ["GearPair", "PairCompliance", "RootModel", "pair_compliance", "pair_stiffness_n_per_m"]

MEAN_DEFLECTION_M = 1e-5
"""Mesh deflection for the torsion arm when the load isn't known: typical of steel gears at working load."""


@dataclass(frozen=True, kw_only=True)
class GearPair:
    """Two gears that mesh at an installed centre distance; refused when they can't."""

    pinion: GearGeometry
    gear: GearGeometry
    centre_distance_m: float | None = None
    """None: the standard one."""
    root_model: RootModel = "clamped_at_base"
    mean_deflection_m: float = MEAN_DEFLECTION_M
    """Mean mesh deflection under load; only the torsion arm of a tilted mesh depends on it."""

    def __post_init__(self) -> None:
        """Refuse unequal base pitches, interference and a contact ratio below 1."""
        if not (np.isfinite(self.mean_deflection_m) and self.mean_deflection_m > 0):
            given, message = self.mean_deflection_m, "must be a finite number"
            raise SpecError(Problem(field="mean_deflection_m", message=message, given=given, allowed="> 0", unit="m"))
        check_mates(self.pinion, self.gear)
        if self.centre_distance_m is not None:
            check_centre_distance(self.pinion, self.gear, self.centre_distance_m)
        self.contact()
        check_tip_clearance(self.pinion, self.gear, self.installed_m)

    @property
    def installed_m(self) -> float:
        """Centre distance at rest."""
        given = self.centre_distance_m
        return standard_centre_distance_m(self.pinion, self.gear) if given is None else given

    @property
    def width_m(self) -> float:
        """Common face width."""
        return min(self.pinion.face_width_m, self.gear.face_width_m)

    @property
    def helix(self) -> Helix:
        """Overlap over the common face, and the pinion's hand."""
        p = self.pinion
        return helix_of(p.helix_rad, p.pressure_angle_rad, p.module_m, self.width_m)

    def engagement(self, centre_distance_error_m: float = 0.0) -> float:
        """Transverse contact ratio plus overlap ratio: how long a pair carries, in base pitches."""
        return self.contact(centre_distance_error_m).contact_ratio + self.helix.overlap_ratio

    @property
    def warnings(self) -> tuple[str, ...]:
        """Undercut, foundation outside its published range."""
        named = (("pinion", self.pinion), ("gear", self.gear))
        return tuple(w for name, g in named for w in gear_warnings(g, name, self.root_model))

    def contact(self, centre_distance_error_m: float = 0.0) -> ContactGeometry:
        """Path of contact at the installed distance plus an error."""
        return ContactGeometry.between(self.pinion, self.gear, self.installed_m + centre_distance_error_m)


@dataclass(frozen=True, kw_only=True)
class PairCompliance:
    """Parts of one pair's compliance at K positions, m/N, arrays (K,): seed (14), single pair."""

    hertz: FloatArray
    foundation: FloatArray
    """Of both bodies."""
    bending: FloatArray
    shear: FloatArray
    axial: FloatArray
    torsion_per_arm2: FloatArray
    """1/(N m), both teeth."""

    def total_m_per_n(self, tilt_rad: float, arm_m: float) -> FloatArray:
        """Series sum; cos^2(tilt) on the beam parts as in (23)-(26), not on contact and body."""
        beam = self.bending + self.shear + self.axial + self.torsion_per_arm2 * arm_m**2
        return np.asarray(self.hertz + self.foundation + np.cos(tilt_rad) ** 2 * beam)


def pair_compliance(
    pair: GearPair, contact: ContactGeometry, position: FloatArray, nodes: int = NODES
) -> PairCompliance:
    """Compliance at `position` (K,), in base pitches from the start of engagement at `contact`.

    The tooth keeps its shape at any centre distance: only the contact point moves. (The seed's text puts the working
    angle into alpha_2 too, which would cut a different tooth.)
    """
    path_m = contact.start_m + position * contact.base_pitch_m
    parts = {"foundation": 0.0 * path_m, "bending": 0.0 * path_m, "shear": 0.0 * path_m, "axial": 0.0 * path_m}
    torsion = 0.0 * path_m
    for tooth, roll_m in ((pair.pinion, path_m), (pair.gear, contact.line_length_m - path_m)):
        alpha_1 = roll_m / tooth.base_radius_m - tooth.base_half_angle_rad
        beam = beam_compliance(tooth, alpha_1, pair.width_m, pair.root_model, nodes)
        parts["foundation"] += foundation_compliance_m_per_n(tooth, alpha_1, pair.width_m, pair.root_model)
        parts["bending"] += beam.bending_m_per_n
        parts["shear"] += beam.shear_m_per_n
        parts["axial"] += beam.axial_m_per_n
        torsion += beam.torsion_per_arm2_per_nm
    hertz = np.full_like(path_m, hertz_compliance_m_per_n(pair.pinion, pair.gear, pair.width_m))
    return PairCompliance(hertz=hertz, torsion_per_arm2=torsion, **parts)


def pair_stiffness_n_per_m(
    pair: GearPair, position: FloatArray, centre_distance_error_m: float = 0.0, tilt_rad: float = 0.0
) -> FloatArray:
    """Stiffness of one pair at `position` (any shape; base pitches since it entered), N/m; 0 outside engagement."""
    contact = pair.contact(centre_distance_error_m)
    flat = np.ravel(np.asarray(position, dtype=np.float64))
    if pair.helix.overlap_ratio > 0.0:
        grid = np.linspace(0.0, contact.contact_ratio, POINTS)
        arm = float(torsion_arm_m(np.array(tilt_rad), pair.width_m, pair.mean_deflection_m))
        spur = 1 / pair_compliance(pair, contact, grid).total_m_per_n(tilt_rad, arm)
        return spread(spur, contact.contact_ratio, pair.helix, flat).reshape(np.shape(position))
    inside = (flat >= 0) & (flat < contact.contact_ratio)
    arm_m = float(torsion_arm_m(np.array(tilt_rad), pair.width_m, pair.mean_deflection_m))
    stiffness = np.zeros_like(flat)
    stiffness[inside] = 1 / pair_compliance(pair, contact, flat[inside]).total_m_per_n(tilt_rad, arm_m)
    return stiffness.reshape(np.shape(position))
