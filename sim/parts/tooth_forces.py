"""The element that makes tooth friction or the tilting moment out of the loads of the tooth pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.laws import MeshLaw
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.parts.gear.from_spec import gear_from_spec
from sim.parts.mesh_element import line_of_action, mesh_coordinates, relative_tilt
from sim.parts.pair_parameters import pair_parameters
from sim.parts.tooth_force_kernel import CONTEXT, KERNEL

OUTPUTS = (
    Output(name="friction", quantity="force", unit="N"),
    Output(name="tilting_moment", quantity="moment", unit="N*m"),
)


@dataclass(frozen=True, kw_only=True)
class Friction:
    """Coulomb friction of the flanks; none by default."""

    coefficient: float = 0.0
    speed_m_per_s: float = 1.0


def sliding_direction(law: MeshLaw, machine: MachineSpec) -> tuple[float, float]:
    """Unit vector normal to the line of action, away from the pinion."""
    nx, ny = line_of_action(law, machine)
    return abs(ny), -nx * math.copysign(1.0, ny)


def tooth_force_element(
    law: MeshLaw, machine: MachineSpec, *, name: str, friction: Friction, tilting: bool
) -> Element:
    """Forces on: relative motion of the gears across the line of action, both gears' angles, the shafts' tilt."""
    nx, ny = line_of_action(law, machine)
    across = sliding_direction(law, machine)
    moving = {g.name: g.translates for g in machine.gears}
    sides = [
        (f"{body}.{axis}", sign * part)
        for body, sign in ((law.pinion, 1.0), (law.gear, -1.0))
        for axis, part in zip("xy", across, strict=True)
        if moving[body] and part != 0.0
    ]
    tilts = [
        (dof, part * weight)
        for axis, part in (("x", nx), ("y", ny))
        if tilting and part != 0.0
        for dof, weight in relative_tilt(law, machine, axis)
    ]
    own = (sides, [(f"{law.pinion}.theta", 1.0)], [(f"{law.gear}.theta", 1.0)], tilts)
    units = ("m", "rad", "rad", "m")
    named = ("across", "pinion", "gear", "tilt")
    forced = tuple(
        Coordinate(name=f"{law.name}.{n}", unit=unit, weights=tuple(weights))
        for n, unit, weights in zip(named, units, own, strict=True)
    )
    return Element(
        name=name,
        site=law.name,
        kernel=KERNEL,
        coordinates=forced + mesh_coordinates(law, machine)[:3],
        forces=4,
        parameters=pair_parameters(law, machine, _own_parameters(law, machine, friction, tilting)),
        context=CONTEXT,
        shafts=(law.pinion, law.gear),
        outputs=OUTPUTS,
        exact_end=True,
    )


def _own_parameters(law: MeshLaw, machine: MachineSpec, friction: Friction, tilting: bool) -> FloatArray:
    """In the order of `tooth_force_kernel`."""
    gears = {g.name: gear_from_spec(g).geometry for g in machine.gears}
    pinion, gear = gears[law.pinion], gears[law.gear]
    tangents = [math.sqrt(g.tip_radius_m**2 - g.base_radius_m**2) for g in (gear, pinion)]
    dynamic = machine.operating is not None and machine.operating.kinematics == "dynamic"
    return flat(
        friction.coefficient,
        friction.speed_m_per_s,
        sum(law.base_radii_m),
        tangents[0],
        tangents[1],
        pinion.base_pitch_m,
        0.0 if dynamic else 1.0,  # the shafts' speeds hold the torsional motion already
        float(tilting),
    )
