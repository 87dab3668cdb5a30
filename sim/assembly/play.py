"""How far a mesh's centre distance and tilt can move: what its stiffness tables must cover."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sim.assembly.levers import lever
from sim.core.spec import BearingSpec, GearSpec, MachineSpec, MeshSpec
from sim.parts.mesh_element import rings_of

MARGIN = 1.25
"""Cover beyond the sum of what is given: motion overshoots."""
SUDDEN = 2.0
"""A load that steps on deflects an undamped spring twice as far as at rest."""


@dataclass(frozen=True, kw_only=True)
class Play:
    """Largest change of the centre distance, m, and of the tilt of the pinion's shaft, rad, of either sign."""

    centre_m: float = 0.0
    tilt_rad: float = 0.0


def _spring_n_per_m(bearing: BearingSpec, loose: Mapping[str, float]) -> float:
    """Shaft and softer support in series; a ring that lies in its bore stands on a wall."""
    shaft = bearing.shaft_stiffness_n_per_m
    support = min(bearing.support.stiffness_x_n_per_m, bearing.support.stiffness_y_n_per_m)
    return shaft if support == 0.0 or loose.get(bearing.name, 0.0) > 0.0 else shaft * support / (shaft + support)


def _deflection_m(gear: GearSpec, bearings: list[BearingSpec], force_n: float, loose: Mapping[str, float]) -> float:
    springs = sum(_spring_n_per_m(b, loose) for b in bearings)
    if gear.translates:
        springs += min(gear.stiffness_x_n_per_m, gear.stiffness_y_n_per_m)
    return SUDDEN * abs(force_n) / springs if springs > 0.0 else 0.0


def _bent(machine: MachineSpec, gear: GearSpec, force_n: float, loose: Mapping[str, float]) -> Play | None:
    """Play of a gear on a flexible shaft: bending, springs, and slack by the lever of each bearing; None if rigid."""
    shaft = next(s for s in machine.shafts if s.name == gear.shaft)
    own = [b for b in machine.bearings if b.name in shaft.seats]
    if not shaft.segments or gear.name not in shaft.seats or len(own) < 2:
        return None
    arm = lever(machine, shaft, gear.name, {b.name: _spring_n_per_m(b, loose) for b in own})
    slack = {b.name: max(b.radial_clearance_m, 0.0) + loose.get(b.name, 0.0) for b in own}
    centre = sum(abs(arm.shares.get(name, 0.0)) * gap for name, gap in slack.items())
    places = [shaft.seats[b.name] for b in own]
    tilt = sum(sorted(slack.values())[-2:]) / max(max(places) - min(places), 1e-3)
    return Play(
        centre_m=centre + SUDDEN * abs(force_n) * abs(arm.deflection_m_per_n),
        tilt_rad=tilt + SUDDEN * abs(force_n) * abs(arm.slope_rad_per_n),
    )


def mesh_play(machine: MachineSpec, mesh: MeshSpec, force_n: float, loose: Mapping[str, float]) -> Play:
    """Run-out, clearances and elastic deflection under the mesh force, with a margin.

    `loose`: metres by which the effects at a gear or bearing move the shaft's centre or let it move.
    """
    gears = {g.name: g for g in machine.gears}
    bearings = {b.name: b for b in machine.bearings}
    centre = tilt = 0.0
    for name in (mesh.pinion, mesh.gear):
        centre += loose.get(name, 0.0)
        own = [bearings[ring] for ring in rings_of(machine, name)]
        if name == mesh.gear and not mesh.follow_gear_shaft:
            continue
        bent = _bent(machine, gears[name], force_n, loose)
        if bent is not None:
            centre += bent.centre_m
            tilt = bent.tilt_rad if name == mesh.pinion else tilt
            continue
        slack = [max(b.radial_clearance_m, 0.0) + loose.get(b.name, 0.0) for b in own]
        centre += sum(slack) / max(len(slack), 1)
        deflection = _deflection_m(gears[name], own, force_n, loose)
        centre += deflection
        if name == mesh.pinion and len(own) > 1:
            length = next(s.length_m for s in machine.shafts if s.name == gears[name].shaft)
            tilt = (slack[0] + slack[-1] + deflection) / length
    return Play(centre_m=MARGIN * centre, tilt_rad=MARGIN * tilt)
