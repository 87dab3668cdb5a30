"""The element that makes tooth friction or the tilting moment out of the loads of the tooth pairs."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.laws import MeshLaw
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.parts.gear.from_spec import gear_from_spec
from sim.parts.mesh_element import line_of_action, mesh_coordinates, relative_tilt, zero_row
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


@dataclass(frozen=True, kw_only=True)
class Arms:
    """What the lever arms of friction follow from: tangents from tip to base circle, base pitch, line of action."""

    pinion_tangent_m: float
    gear_tangent_m: float
    base_pitch_m: float
    length_m: float

    @property
    def start_m(self) -> float:
        """Distance of the entering contact from the pinion's base point."""
        return self.length_m - self.gear_tangent_m


def sliding_direction(law: MeshLaw, machine: MachineSpec) -> tuple[float, float]:
    """Unit vector normal to the line of action, away from the pinion."""
    nx, ny = line_of_action(law, machine)
    return abs(ny), -nx * math.copysign(1.0, ny)


def tooth_force_element(
    law: MeshLaw, machine: MachineSpec, *, name: str, friction: Friction, tilting: bool, speed_hz: float = 0.0
) -> Element:
    """Forces on: relative motion of the gears across the line of action, both gears' angles, the shafts' tilt.

    `speed_hz`: speed of the pinion, which the drive keeps up against the mean loss.
    """
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
        parameters=pair_parameters(law, machine, _own_parameters(law, machine, friction, tilting, speed_hz)),
        context=CONTEXT,
        shafts=(law.pinion, law.gear),
        outputs=OUTPUTS,
        exact_end=True,
    )


def mean_loss_torque_nm(law: MeshLaw, arms_m: Arms, friction: Friction, speed_rad_per_s: float) -> float:
    """Mean torque on the pinion that the friction of the mean load takes at a speed of the pinion, N m.

    Quadrature over the phase at the installed centre distance; the pairs share the load as their stiffnesses.
    """
    if law.pair_rows is None or law.pair_ratios is None or friction.coefficient == 0.0:
        return 0.0
    row = zero_row(law)
    curve, ratio = law.pair_rows[law.pair_rows.shape[0] // 2, row], float(law.pair_ratios[row])
    phase = (np.arange(1024) + 0.5) / 1024
    place = phase + np.arange(np.ceil(ratio))[:, None]
    stiffness = np.where(place < ratio, np.interp(place / ratio, np.linspace(0.0, 1.0, curve.size), curve), 0.0)
    load_n = law.mean_force_n * stiffness / stiffness.sum(axis=0)
    path_m = arms_m.start_m + place * arms_m.base_pitch_m
    lever_m = path_m - (arms_m.length_m - path_m) * law.teeth[0] / law.teeth[1]
    share = np.tanh(np.abs(lever_m) * speed_rad_per_s / friction.speed_m_per_s)
    return float(friction.coefficient * np.mean(np.sum(load_n * np.abs(lever_m) * share, axis=0)))


def arms_of(law: MeshLaw, machine: MachineSpec) -> Arms:
    """Lever arms along the path of contact of a mesh."""
    gears = {g.name: gear_from_spec(g).geometry for g in machine.gears}
    pinion, gear = gears[law.pinion], gears[law.gear]
    tangents = [math.sqrt(g.tip_radius_m**2 - g.base_radius_m**2) for g in (pinion, gear)]
    return Arms(
        pinion_tangent_m=tangents[0],
        gear_tangent_m=tangents[1],
        base_pitch_m=pinion.base_pitch_m,
        length_m=math.sqrt(law.centre_distance_m**2 - sum(law.base_radii_m) ** 2),
    )


def _own_parameters(
    law: MeshLaw, machine: MachineSpec, friction: Friction, tilting: bool, speed_hz: float
) -> FloatArray:
    """In the order of `tooth_force_kernel`."""
    arms = arms_of(law, machine)
    dynamic = machine.operating is not None and machine.operating.kinematics == "dynamic"
    lost = 0.0 if dynamic else mean_loss_torque_nm(law, arms, friction, 2.0 * math.pi * speed_hz)
    driving = law.drive > 0.0
    return flat(
        friction.coefficient,
        friction.speed_m_per_s,
        sum(law.base_radii_m),
        arms.gear_tangent_m,
        arms.pinion_tangent_m,
        arms.base_pitch_m,
        float(tilting),
        lost if driving else 0.0,
        0.0 if driving else lost * law.teeth[1] / law.teeth[0],
    )
