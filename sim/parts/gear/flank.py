"""One gear's flank along the path of contact, from the entry of a pair to its exit, sampled as shapes are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.laws import TOOTH_POINTS
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.parts.gear.from_spec import pair_from_spec
from sim.parts.gear.geometry import GearGeometry
from sim.parts.gear.hertz import hertz_compliance_m_per_n
from sim.parts.gear.pair import GearPair, pair_compliance


@dataclass(frozen=True, kw_only=True)
class Flank:
    """Arrays (TOOTH_POINTS,) over x = 0..1 at the installed centre distance."""

    pair: GearPair
    tooth: GearGeometry
    x: FloatArray
    roll_m: FloatArray
    """Distance of the contact from the gear's base point: the flank's radius of curvature there."""
    mate_roll_m: FloatArray
    compliance_m_per_n: FloatArray
    """Of the sound pair."""

    @property
    def alpha_1_rad(self) -> FloatArray:
        """Angle of the load on the tooth."""
        return self.roll_m / self.tooth.base_radius_m - self.tooth.base_half_angle_rad

    @property
    def radius_m(self) -> FloatArray:
        """Radius of the contact point on its gear."""
        return np.hypot(self.tooth.base_radius_m, self.roll_m)

    @property
    def from_tip(self) -> FloatArray:
        """Share of the path between the contact and the end at which this tooth's tip touches."""
        return self.x if self.roll_m[0] > self.roll_m[-1] else 1.0 - self.x

    @property
    def hertz_m_per_n(self) -> float:
        """Contact compliance of the pair over its whole width."""
        return hertz_compliance_m_per_n(self.pair.pinion, self.pair.gear, self.pair.width_m)


def flank_of(machine: MachineSpec, mesh_name: str, gear_name: str) -> Flank:
    """The flank of a gear in one of its meshes."""
    mesh = next(m for m in machine.meshes if m.name == mesh_name)
    gears = {g.name: g for g in machine.gears}
    pair = pair_from_spec(gears[mesh.pinion], gears[mesh.gear], mesh, mesh.root_model).pair
    contact = pair.contact()
    x = np.linspace(0.0, 1.0, TOOTH_POINTS)
    path_m = contact.start_m + x * contact.contact_ratio * contact.base_pitch_m
    rolls = (path_m, contact.line_length_m - path_m)
    driving = gear_name == mesh.pinion
    return Flank(
        pair=pair,
        tooth=pair.pinion if driving else pair.gear,
        x=x,
        roll_m=rolls[0] if driving else rolls[1],
        mate_roll_m=rolls[1] if driving else rolls[0],
        compliance_m_per_n=pair_compliance(pair, contact, x * contact.contact_ratio).total_m_per_n(0.0, 0.0),
    )
