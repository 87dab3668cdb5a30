"""What every mesh element has in common: its coordinates, outputs and parameter header."""

from __future__ import annotations

import math

import numpy as np

from sim.core.elements import Coordinate, Output
from sim.core.laws import MeshLaw
from sim.core.response import FloatArray
from sim.core.spec import GearSpec, MachineSpec, ShaftSpec
from sim.parts import mesh_kernels as mk
from sim.parts.gear.helix import base_helix_rad

OUTPUTS = (
    Output(name="stiffness", quantity="stiffness", unit="N/m"),
    Output(name="centre_distance_error", quantity="displacement", unit="m"),
    Output(name="offset_angle", quantity="angle", unit="rad"),
    Output(name="force", quantity="force", unit="N"),
    Output(name="transmission_error", quantity="displacement", unit="m"),
    Output(name="contact", quantity="state", unit="1"),
    Output(name="outside_table", quantity="state", unit="1"),
)


def _gear(machine: MachineSpec, name: str) -> GearSpec:
    return next(g for g in machine.gears if g.name == name)


def rings_of(machine: MachineSpec, body: str) -> list[str]:
    """Bearings that carry a body, in the order of the specification."""
    return [b.name for b in machine.bearings if b.body == body]


def _shaft(machine: MachineSpec, gear: str) -> ShaftSpec:
    return next(s for s in machine.shafts if s.name == _gear(machine, gear).shaft)


def bends(machine: MachineSpec, gear: str) -> bool:
    """Whether a gear sits on a flexible shaft, so that its own motion and slope are DOFs."""
    return bool(_shaft(machine, gear).segments)


def _centre_weights(machine: MachineSpec, body: str, axis: str, sign: float) -> list[tuple[str, float]]:
    """Shaft centre at the gear: mean of its inner rings (seed eq. 17), else and on a flexible shaft the gear itself."""
    rings = [] if bends(machine, body) else rings_of(machine, body)
    if rings:
        return [(f"{ring}.inner.{axis}", sign / len(rings)) for ring in rings]
    return [(f"{body}.{axis}", sign)] if _gear(machine, body).translates else []


def _tilt_weights(machine: MachineSpec, body: str, axis: str) -> list[tuple[str, float]]:
    if bends(machine, body):
        return [(f"{body}.slope_{axis}", _shaft(machine, body).length_m)]
    rings = rings_of(machine, body)
    if len(rings) < 2:
        return []
    return [(f"{rings[-1]}.inner.{axis}", 1.0), (f"{rings[0]}.inner.{axis}", -1.0)]


def line_of_action(law: MeshLaw, machine: MachineSpec) -> tuple[float, float]:
    """Unit vector n of the line of action, in which a positive force pushes the pinion: +-y, or turned.

    The tooth force pushes the gears apart, whichever of them drives: n points away from the gear (-x) where the pinion
    drives and force is positive, towards it where the gear drives and force is negative.
    """
    spec = next(m for m in machine.meshes if m.name == law.name)
    if spec.line_of_action == "y":
        return 0.0, law.flank
    return -law.drive * math.sin(law.working_angle_rad), law.flank * math.cos(law.working_angle_rad)


def centre_line(law: MeshLaw, machine: MachineSpec) -> tuple[float, float]:
    """Unit vector from pinion to gear: x, or in the true form with y as line of action turned by the working angle."""
    spec = next(m for m in machine.meshes if m.name == law.name)
    if not (law.true_centre_line and spec.line_of_action == "y"):
        return 1.0, 0.0
    return math.cos(law.working_angle_rad), -law.flank * law.drive * math.sin(law.working_angle_rad)


def zero_row(law: MeshLaw) -> int:
    """Index of the row at the installed centre distance."""
    return int(np.argmin(np.abs(law.centre_errors_m)))


def _thrust_weights(law: MeshLaw, machine: MachineSpec) -> list[tuple[str, float]]:
    """Axial motion of the pitch point as the gears of a flexible shaft tilt, in the deflection of a helical mesh.

    A force f on the line of action comes with the axial force -f tan(beta_b) sign(n . t) on a right-handed pinion, t
    the tangent at the pitch point, and the opposite one on its gear; at the pitch radius both tilt their shafts.
    """
    spec = _gear(machine, law.pinion)
    base = base_helix_rad(math.radians(spec.helix_angle_deg), math.radians(spec.pressure_angle_deg))
    if base == 0.0:
        return []
    nx, ny = line_of_action(law, machine)
    along_x, along_y = centre_line(law, machine)
    axial = -math.copysign(math.tan(base), base * (ny * along_x - nx * along_y))
    found = []
    for body, radius_m in zip((law.pinion, law.gear), law.base_radii_m, strict=True):
        if bends(machine, body):
            arm = axial * radius_m / math.cos(law.working_angle_rad)
            found += [(f"{body}.slope_{a}", arm * c) for a, c in (("x", along_x), ("y", along_y)) if c != 0.0]
    return found


def shaft_length_m(machine: MachineSpec, gear: str) -> float:
    """Length of the shaft that carries a gear, over which its tilt is taken."""
    return _shaft(machine, gear).length_m


def relative_tilt(law: MeshLaw, machine: MachineSpec, axis: str) -> list[tuple[str, float]]:
    """End-to-end displacement of the pinion's shaft; with slices minus the gear's, at the pinion's length."""
    weights = _tilt_weights(machine, law.pinion, axis)
    if law.slices > 1:
        ratio = shaft_length_m(machine, law.pinion) / shaft_length_m(machine, law.gear)
        weights = weights + [(dof, -ratio * weight) for dof, weight in _tilt_weights(machine, law.gear, axis)]
    return weights


def mesh_coordinates(law: MeshLaw, machine: MachineSpec) -> tuple[Coordinate, ...]:
    """Deflection along the line of action; shaft centres apart (x, y); tilt of the shafts (x, y)."""
    nx, ny = line_of_action(law, machine)
    weights: list[tuple[str, float]] = [
        (f"{law.pinion}.theta", law.base_radii_m[0]),
        (f"{law.gear}.theta", -law.base_radii_m[1]),
    ]
    weights += _thrust_weights(law, machine)
    for body, sign in ((law.pinion, -1.0), (law.gear, 1.0)):
        if _gear(machine, body).translates:
            weights += [(f"{body}.{a}", sign * n) for a, n in (("x", nx), ("y", ny)) if n != 0.0]
    centre = []
    for axis in ("x", "y"):
        pair = _centre_weights(machine, law.pinion, axis, 1.0)
        if law.follow_gear_shaft:
            pair = pair + _centre_weights(machine, law.gear, axis, -1.0)
        centre.append(pair)
    tilt = [relative_tilt(law, machine, axis) for axis in ("x", "y")]
    names = ("deflection", "centre_x", "centre_y", "tilt_x", "tilt_y")
    rows = (weights, *centre, *tilt)
    return tuple(
        Coordinate(name=f"{law.name}.{n}", unit="m", weights=tuple(r)) for n, r in zip(names, rows, strict=True)
    )


def header(law: MeshLaw, machine: MachineSpec, *, table_at: int, points: int) -> FloatArray:
    """The parameter header of `mesh_kernels`."""
    spec = next(m for m in machine.meshes if m.name == law.name)
    head = np.zeros(mk.HEADER)
    head[mk.H_DAMPING] = law.damping_ns_per_m
    head[mk.H_BACKLASH] = mk.NO_BACKLASH if law.backlash_m is None else law.backlash_m
    head[mk.H_E_MEAN] = law.error_mean_m
    head[mk.H_E_AMPLITUDE] = law.error_amplitude_m
    head[mk.H_E_PHASE] = law.error_phase_rad
    head[mk.H_TEETH_PINION], head[mk.H_TEETH_GEAR] = law.teeth
    head[mk.H_CENTRE] = law.centre_distance_m
    along_x, along_y = centre_line(law, machine)
    head[mk.H_COS], head[mk.H_SIN] = along_x, -along_y
    head[mk.H_NORMAL_X], head[mk.H_NORMAL_Y] = line_of_action(law, machine)
    head[mk.H_SENSE_P], head[mk.H_SENSE_G] = law.pinion_sense, law.gear_sense
    head[mk.H_BACKLASH_SLOPE] = 2.0 * math.sin(law.working_angle_rad)
    head[mk.H_DRIVE] = law.drive
    head[mk.H_RUNOUT_P], head[mk.H_RUNOUT_P_PHASE] = law.runout_pinion_m, law.runout_pinion_phase_rad
    head[mk.H_RUNOUT_G], head[mk.H_RUNOUT_G_PHASE] = law.runout_gear_m, law.runout_gear_phase_rad
    head[mk.H_LENGTH] = shaft_length_m(machine, law.pinion)
    head[mk.H_HAS_GAPS] = float(bool(np.any(law.pinion_tooth_gap_m) or np.any(law.gear_tooth_gap_m)))
    head[mk.H_GAPS_P] = mk.HEADER
    head[mk.H_GAPS_G] = mk.HEADER + law.pinion_tooth_gap_m.size
    head[mk.H_ROWS] = law.centre_errors_m.size
    head[mk.H_ROW0] = law.centre_errors_m[0]
    if law.centre_errors_m.size > 1:
        head[mk.H_ROW_STEP] = law.centre_errors_m[1] - law.centre_errors_m[0]
    head[mk.H_POINTS] = points
    head[mk.H_TABLE] = table_at
    head[mk.H_TILTS] = law.tilts_rad.size
    head[mk.H_TILT0] = law.tilts_rad[0]
    if law.tilts_rad.size > 1:
        head[mk.H_TILT_STEP] = law.tilts_rad[1] - law.tilts_rad[0]
    head[mk.H_USE_TILT] = float(spec.offset_angle)
    head[mk.H_KINDS] = 1.0
    head[mk.H_SLICES] = law.slices
    head[mk.H_WIDTH], head[mk.H_LEAD] = law.face_width_m, law.lead_rad
    return head
