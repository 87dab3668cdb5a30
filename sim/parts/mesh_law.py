"""From gears and a mesh of the specification to a mesh law: table of the user's own, or potential-energy method."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.core.laws import MeshLaw
from sim.core.response import FloatArray
from sim.core.spec import GearSpec, MachineSpec, MeshSpec
from sim.parts.gear.from_spec import gear_from_spec, pair_from_spec, user_table
from sim.parts.gear.helix import base_helix_rad
from sim.parts.gear.pair import GearPair
from sim.parts.gear.pair_table import PairTable, build_pair_table
from sim.parts.gear.reach import covering_errors_m, covering_tilts_rad
from sim.parts.gear.summary import mean_stiffness_n_per_m
from sim.parts.gear.total_table import total_table


@dataclass(frozen=True, kw_only=True)
class MeshSetting:
    """What the machine around it decides about a mesh; the defaults are the seed's senses and no load known."""

    pinion_sense: float = 1.0
    gear_sense: float = -1.0
    flank: float = 1.0
    drive: float = 1.0
    gear_first_tooth: int = 0
    force_n: float = 0.0
    """Mean force on the line of action, N."""
    centre_play_m: float = 0.0
    """Change of the centre distance that the tables must cover, m."""
    tilt_play_rad: float = 0.0
    """Tilt of the pinion's shaft that the tables must cover, rad."""


ALONE = MeshSetting()


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


TOTAL_COLUMNS = 2000
"""Columns of a total curve made from pairs: an entry is smeared over 1/2000 of a mesh period."""


HELICAL_POINTS = 257
"""Points of a helical pair's curve, which has a corner where a slice leaves: 2e-4 of the largest stiffness (tests)."""
KEPT = 128
"""Tables of tooth pairs that a process keeps: 35 kB each for aligned spur gears, 0.6 MB with tilts."""
MOST_PAIRS = 3.0
"""Contact ratio up to which tooth pairs are summed in a step (four pairs)."""


def _few_enough(ratio: float, mesh: MeshSpec) -> None:
    if ratio > MOST_PAIRS:
        message = "more tooth pairs touch than are summed one by one: set it to false for one total curve"
        field = f"meshes.{mesh.name}.tooth_pairs"
        allowed = f"total contact ratio up to {MOST_PAIRS:g}, here {ratio:.4g}"
        raise SpecError(Problem(field=field, message=message, given=True, allowed=allowed))


def _equal_steps(errors: FloatArray, mesh: MeshSpec) -> None:
    steps = np.diff(errors)
    if errors.size > 1 and (np.any(steps <= 0) or np.ptp(steps) > 1e-6 * steps.mean()):
        message = "centre-distance errors must rise in equal steps"
        raise SpecError(Problem(field=f"meshes.{mesh.name}.table.centre_distance_error_m", message=message, unit="m"))


def _brackets_zero(errors: FloatArray, mesh: MeshSpec) -> None:
    if not errors[0] <= 0.0 <= errors[-1]:
        message = "the rows must include the installed centre distance, error 0"
        given = f"{errors[0]:g} to {errors[-1]:g}"
        field = f"meshes.{mesh.name}.table.centre_distance_error_m"
        raise SpecError(Problem(field=field, message=message, given=given, allowed="first <= 0 <= last", unit="m"))


def _loaded(pair: GearPair, mesh: MeshSpec, force_n: float, notes: dict[str, str]) -> GearPair:
    """The pair with the mean deflection of the transmitted load, on which the torsion arm of a tilt depends."""
    if not mesh.offset_angle or force_n <= 0.0:
        return pair
    deflection = force_n / mean_stiffness_n_per_m(pair)
    said = f"derived: {deflection:.6g} m (mean force {force_n:.6g} N over mean stiffness)"
    notes[f"{mesh.name}.mean_deflection_m"] = said
    return replace(pair, mean_deflection_m=deflection)


def _beyond(curve: MeshCurve, mesh: MeshSpec, setting: MeshSetting) -> list[str]:
    """Sentences about motion that the parameters allow and the table does not cover."""
    why = "where the teeth stop working (contact ratio 1, or interference)" if mesh.table is None else "as it is given"
    found = []
    low, high = float(curve.centre_errors_m[0]), float(curve.centre_errors_m[-1])
    play = setting.centre_play_m
    if (mesh.table is None or curve.centre_errors_m.size > 1) and play > min(-low, high) * (1 + 1e-9):
        found.append(
            f"{mesh.name}: run-out, clearances and deflection may change the centre distance by {1e6 * play:.0f} um, "
            f"the stiffness table runs from {1e6 * low:.0f} to {1e6 * high:.0f} um, {why}; beyond, its last row is used"
        )
    reach = float(curve.tilts_rad[-1])
    if curve.tilts_rad.size > 1 and setting.tilt_play_rad > reach * (1 + 1e-9):
        found.append(
            f"{mesh.name}: clearances and deflection may tilt the shaft by {1e3 * setting.tilt_play_rad:.2g} mrad, the "
            f"stiffness table ends at {1e3 * reach:.2g} mrad; beyond, its last layer is used"
        )
    return found


@lru_cache(maxsize=KEPT)
def kept_table(pair: GearPair, tilts_rad: tuple[float, ...], errors_m: tuple[float, ...], points: int) -> PairTable:
    """The pair's table, made once: machines that differ elsewhere, or turn at another speed, share it read-only."""
    table = build_pair_table(
        pair, tilts_rad=np.array(tilts_rad), centre_distance_errors_m=np.array(errors_m), points=points
    )
    for name in ("tilts_rad", "centre_distance_error_m", "contact_ratio", "start_m", "stiffness_n_per_m"):
        getattr(table, name).flags.writeable = False
    return table


def mesh_curve(
    pinion: GearSpec,
    gear: GearSpec,
    mesh: MeshSpec,
    notes: dict[str, str],
    warnings: list[str],
    setting: MeshSetting = ALONE,
) -> MeshCurve:
    """The user's table, or the potential-energy method as pairs or as one total curve."""
    source = pair_from_spec(pinion, gear, mesh, mesh.root_model)
    notes |= {k: v for k, v in source.derived.items() if k.startswith(mesh.name) or k.endswith("bore_radius_m")}
    warnings += source.warnings
    pair = source.pair
    common = {"centre_distance_m": pair.installed_m, "working_angle_rad": pair.contact(0.0).working_angle_rad}
    table = user_table(mesh)
    if table is None and mesh.tooth_pairs:
        tilts = covering_tilts_rad(setting.tilt_play_rad) if mesh.offset_angle else np.zeros(1)
        pair = _loaded(pair, mesh, setting.force_n, notes)
        errors = covering_errors_m(pair, setting.centre_play_m)
        points = 129 if pair.helix.overlap_ratio == 0.0 else HELICAL_POINTS
        rows = kept_table(pair, tuple(tilts.tolist()), tuple(errors.tolist()), points)
        _few_enough(float(rows.contact_ratio.max()), mesh)
        return MeshCurve(
            **common,
            centre_errors_m=rows.centre_distance_error_m,
            tilts_rad=rows.tilts_rad,
            total_rows=None,
            pair_rows=rows.stiffness_n_per_m,
            pair_ratios=rows.contact_ratio,
            mean_row=mean_stiffness_n_per_m(pair),
        )
    if table is None:
        errors = covering_errors_m(pair, setting.centre_play_m)
        table = total_table(pair, errors, columns=TOTAL_COLUMNS)
    _equal_steps(table.centre_distance_error_m, mesh)
    _brackets_zero(table.centre_distance_error_m, mesh)
    zero = int(np.argmin(np.abs(table.centre_distance_error_m)))
    return MeshCurve(
        **common,
        centre_errors_m=table.centre_distance_error_m,
        tilts_rad=np.zeros(1),
        total_rows=table.stiffness_n_per_m,
        pair_rows=None,
        pair_ratios=None,
        mean_row=float(table.stiffness_n_per_m[zero].mean()),
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
    pairs = [(base_radius_m(gear), gear_from_spec(gear).inertia_kg_m2) for gear in gears]
    value = 2.0 * mesh.damping_ratio * math.sqrt(mean_n_per_m * equivalent_mass_kg(pairs[0], pairs[1]))
    notes[f"{mesh.name}.damping_ns_per_m"] = f"derived: {value:.6g} N s/m (ratio {mesh.damping_ratio:g} of critical)"
    return value


def mesh_law(
    machine: MachineSpec, mesh: MeshSpec, notes: dict[str, str], warnings: list[str], setting: MeshSetting = ALONE
) -> MeshLaw:
    """Build the law; damping from the ratio when not given."""
    gears = {g.name: g for g in machine.gears}
    pinion, gear = gears[mesh.pinion], gears[mesh.gear]
    curve = mesh_curve(pinion, gear, mesh, notes, warnings, setting)
    warnings += _beyond(curve, mesh, setting)
    base = base_helix_rad(math.radians(pinion.helix_angle_deg), math.radians(pinion.pressure_angle_deg))
    if base != 0.0:
        thrust = setting.force_n * math.tan(abs(base))
        notes[f"{mesh.name}.axial_force_n"] = f"derived: {thrust:.6g} N (mean force times tan of the base helix angle)"
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
        pinion_sense=setting.pinion_sense,
        gear_sense=setting.gear_sense,
        flank=setting.flank,
        drive=setting.drive,
        gear_first_tooth=setting.gear_first_tooth,
        mean_force_n=abs(setting.force_n),
    )
