"""From gears and a mesh of the specification to a mesh law: table of the user's own, or potential-energy method."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.core.laws import MeshLaw
from sim.core.response import FloatArray
from sim.core.spec import GearSpec, MachineSpec, MeshSpec
from sim.parts.gear_body import annulus_inertia_kg_m2, annulus_mass_kg


@dataclass(frozen=True, kw_only=True)
class MeshCurve:
    """Stiffness of a mesh over phase: total rows, or tooth-pair rows with the contact ratio of each row."""

    centre_distance_m: float
    working_angle_rad: float
    centre_errors_m: FloatArray
    tilts_rad: FloatArray
    total_rows: FloatArray | None
    pair_rows: FloatArray | None
    pair_ratios: FloatArray | None
    mean_row: float
    """Mean total stiffness at zero centre-distance error, N/m."""


def _table(mesh: MeshSpec) -> tuple[FloatArray, FloatArray]:
    table = mesh.table
    assert table is not None
    errors = np.asarray(table.centre_distance_error_m, dtype=np.float64)
    lengths = {len(row) for row in table.stiffness_n_per_m}
    field = f"meshes.{mesh.name}.table"
    if len(lengths) != 1 or len(table.stiffness_n_per_m) != errors.size:
        message = "needs one row of equal length for every centre-distance error"
        raise SpecError(Problem(field=field, message=message, given=f"{len(table.stiffness_n_per_m)} rows"))
    steps = np.diff(errors)
    if errors.size > 1 and (np.any(steps <= 0) or np.ptp(steps) > 1e-6 * steps.mean()):
        message = "centre-distance errors must rise in equal steps"
        raise SpecError(Problem(field=f"{field}.centre_distance_error_m", message=message, unit="m"))
    return errors, np.asarray(table.stiffness_n_per_m, dtype=np.float64)


def mesh_curve(
    pinion: GearSpec, gear: GearSpec, mesh: MeshSpec, notes: dict[str, str], warnings: list[str]
) -> MeshCurve:
    """The user's table, or the potential-energy method."""
    radii = base_radius_m(pinion) + base_radius_m(gear)
    standard = 0.5 * pinion.module_m * (pinion.teeth + gear.teeth)
    centre = standard if mesh.centre_distance_m is None else mesh.centre_distance_m
    angle = math.acos(radii / centre)
    errors, rows = _table(mesh)
    zero = int(np.argmin(np.abs(errors)))
    return MeshCurve(
        centre_distance_m=centre,
        working_angle_rad=angle,
        centre_errors_m=errors,
        tilts_rad=np.zeros(1),
        total_rows=rows,
        pair_rows=None,
        pair_ratios=None,
        mean_row=float(rows[zero].mean()),
    )


def equivalent_mass_kg(pinion: tuple[float, float], gear: tuple[float, float]) -> float:
    """1 / (Rb1^2/I1 + Rb2^2/I2) from (base radius m, inertia kg m^2) of both gears, kg."""
    return 1.0 / (pinion[0] ** 2 / pinion[1] + gear[0] ** 2 / gear[1])


def base_radius_m(gear: GearSpec) -> float:
    """Base circle radius, m."""
    return 0.5 * gear.module_m * gear.teeth * math.cos(math.radians(gear.pressure_angle_deg))


def _damping(mesh: MeshSpec, gears: tuple[GearSpec, GearSpec], mean_n_per_m: float, notes: dict[str, str]) -> float:
    """c_t as given, or 2 zeta sqrt(k m_eq) with the mean stiffness of the mesh."""
    if mesh.damping_ns_per_m is not None:
        notes[f"{mesh.name}.damping_ns_per_m"] = f"given: {mesh.damping_ns_per_m:.6g} N s/m"
        return mesh.damping_ns_per_m
    pairs = []
    for gear in gears:
        mass = annulus_mass_kg(gear) if gear.mass_kg is None else gear.mass_kg
        inertia = annulus_inertia_kg_m2(gear, mass) if gear.inertia_kg_m2 is None else gear.inertia_kg_m2
        pairs.append((base_radius_m(gear), inertia))
    value = 2.0 * mesh.damping_ratio * math.sqrt(mean_n_per_m * equivalent_mass_kg(pairs[0], pairs[1]))
    notes[f"{mesh.name}.damping_ns_per_m"] = f"derived: {value:.6g} N s/m (ratio {mesh.damping_ratio:g} of critical)"
    return value


def mesh_law(machine: MachineSpec, mesh: MeshSpec, notes: dict[str, str], warnings: list[str]) -> MeshLaw:
    """Build the law; damping from the ratio when not given."""
    gears = {g.name: g for g in machine.gears}
    pinion, gear = gears[mesh.pinion], gears[mesh.gear]
    curve = mesh_curve(pinion, gear, mesh, notes, warnings)
    middle = curve.mean_row
    return MeshLaw(
        name=mesh.name,
        pinion=pinion.name,
        gear=gear.name,
        teeth=(pinion.teeth, gear.teeth),
        base_radii_m=(base_radius_m(pinion), base_radius_m(gear)),
        centre_distance_m=curve.centre_distance_m,
        working_angle_rad=curve.working_angle_rad,
        damping_ns_per_m=_damping(mesh, (pinion, gear), middle, notes),
        backlash_m=mesh.backlash_m,
        error_mean_m=mesh.transmission_error.mean_m,
        error_amplitude_m=mesh.transmission_error.amplitude_m,
        error_phase_rad=mesh.transmission_error.phase_rad,
        centre_errors_m=curve.centre_errors_m,
        total_rows=curve.total_rows,
        pair_rows=curve.pair_rows,
        pair_ratios=curve.pair_ratios,
        tilts_rad=curve.tilts_rad,
        pinion_tooth_gap_m=np.zeros(pinion.teeth),
        gear_tooth_gap_m=np.zeros(gear.teeth),
        true_centre_line=mesh.centre_distance_form == "true",
        follow_gear_shaft=mesh.follow_gear_shaft,
    )
