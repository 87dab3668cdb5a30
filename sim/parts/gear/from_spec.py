"""From the machine specification to gear geometry, gear pairs and tables; says what was given and what derived."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from sim.core.errors import Problem, SpecError
from sim.core.spec.gears import GearSpec, MeshSpec
from sim.parts.gear.geometry import GearGeometry, derived_inertia_kg_m2, derived_mass_kg
from sim.parts.gear.pair import GearPair, RootModel
from sim.parts.gear.total_table import TotalTable

BORE_SHARE = 0.3
"""Bore radius over pitch radius when the bore isn't given."""


@dataclass(frozen=True, kw_only=True)
class GearFromSpec:
    """Geometry, mass and inertia of a gear; `derived` maps field paths to `given: ...` or `derived: ...`."""

    geometry: GearGeometry
    mass_kg: float
    inertia_kg_m2: float
    derived: dict[str, str]


@dataclass(frozen=True, kw_only=True)
class PairFromSpec:
    """A legal pair with what was derived and what deserves a warning."""

    pair: GearPair
    derived: dict[str, str]
    warnings: tuple[str, ...]


def gear_from_spec(spec: GearSpec) -> GearFromSpec:
    """Geometry of one gear; an inertia that isn't given belongs to the mass in use."""
    geometry = _geometry(spec)
    derived: dict[str, str] = {}
    mass_kg = derived_mass_kg(geometry, spec.density_kg_per_m3) if spec.mass_kg is None else spec.mass_kg
    scale = mass_kg / derived_mass_kg(geometry, spec.density_kg_per_m3)
    inertia = scale * derived_inertia_kg_m2(geometry, spec.density_kg_per_m3)
    if spec.inertia_kg_m2 is not None:
        inertia = spec.inertia_kg_m2
    annulus = "annulus from bore to pitch circle"
    rows = (
        ("bore_radius_m", spec.bore_radius_m, geometry.bore_radius_m, f"m ({BORE_SHARE:g} of the pitch radius)"),
        ("mass_kg", spec.mass_kg, mass_kg, f"kg ({annulus})"),
        ("inertia_kg_m2", spec.inertia_kg_m2, inertia, f"kg m^2 ({annulus})"),
    )
    for name, given, value, how in rows:
        said = f"given: {value:.6g} {how.split(' (')[0]}" if given is not None else f"derived: {value:.6g} {how}"
        derived[f"{spec.name}.{name}"] = said
    return GearFromSpec(geometry=geometry, mass_kg=mass_kg, inertia_kg_m2=inertia, derived=derived)


def _geometry(spec: GearSpec) -> GearGeometry:
    bore_m = BORE_SHARE * 0.5 * spec.module_m * spec.teeth if spec.bore_radius_m is None else spec.bore_radius_m
    helix = math.radians(spec.helix_angle_deg)
    normal = math.cos(helix)  # normal over transverse module
    try:
        return GearGeometry(
            teeth=spec.teeth,
            module_m=spec.module_m,
            pressure_angle_rad=math.radians(spec.pressure_angle_deg),
            addendum_coefficient=normal * spec.addendum_coefficient,
            tip_clearance_coefficient=normal * spec.tip_clearance_coefficient,
            profile_shift_coefficient=normal * spec.profile_shift_coefficient,
            face_width_m=spec.face_width_m,
            bore_radius_m=bore_m,
            fillet_radius_coefficient=normal * spec.fillet_radius_coefficient,
            youngs_modulus_pa=spec.youngs_modulus_pa,
            poisson_ratio=spec.poisson_ratio,
            helix_rad=helix,
        )
    except SpecError as error:
        raise SpecError([replace(p, field=f"gears.{spec.name}.{p.field}") for p in error.problems]) from error


def pair_from_spec(
    pinion: GearSpec, gear: GearSpec, mesh: MeshSpec, root_model: RootModel = "clamped_at_base"
) -> PairFromSpec:
    """The pair of a mesh for the potential-energy method."""
    parts = {"pinion": gear_from_spec(pinion), "gear": gear_from_spec(gear)}
    try:
        pair = GearPair(
            pinion=parts["pinion"].geometry,
            gear=parts["gear"].geometry,
            centre_distance_m=mesh.centre_distance_m,
            root_model=root_model,
        )
    except SpecError as error:
        raise SpecError([_located(p, mesh, (pinion, gear)) for p in error.problems]) from error
    derived = {**parts["pinion"].derived, **parts["gear"].derived}
    how = "derived (standard)" if mesh.centre_distance_m is None else "given"
    derived[f"{mesh.name}.centre_distance_m"] = f"{how}: {pair.installed_m:.9g} m"
    if pair.helix.overlap_ratio > 0.0:
        transverse, overlap = pair.contact().contact_ratio, pair.helix.overlap_ratio
        derived[f"{mesh.name}.contact_ratio"] = (
            f"derived: {transverse + overlap:.6g} (transverse {transverse:.6g}, overlap {overlap:.6g})"
        )
    names = {"pinion": pinion.name, "gear": gear.name}
    warnings = tuple(f"{names[w.split(':')[0]]}:{w.split(':', 1)[1]}" for w in pair.warnings)
    return PairFromSpec(pair=pair, derived=derived, warnings=warnings)


def _located(problem: Problem, mesh: MeshSpec, gears: tuple[GearSpec, GearSpec]) -> Problem:
    """The same problem with its path in the machine specification."""
    head, _, tail = problem.field.partition(".")
    names = {"pinion": gears[0].name, "gear": gears[1].name}
    path = f"gears.{names[head]}.{tail}" if head in names and tail else f"meshes.{mesh.name}.{problem.field}"
    return replace(problem, field=path)


def user_table(mesh: MeshSpec) -> TotalTable | None:
    """The mesh's own total table, checked; None when the specification gives none."""
    if mesh.table is None:
        return None
    rows = mesh.table.stiffness_n_per_m
    if len({len(row) for row in rows}) != 1:
        field, message = f"meshes.{mesh.name}.table.stiffness_n_per_m", "rows must have equal lengths"
        raise SpecError(Problem(field=field, message=message, given=[len(row) for row in rows]))
    try:
        return TotalTable(
            centre_distance_error_m=np.asarray(mesh.table.centre_distance_error_m, dtype=np.float64),
            stiffness_n_per_m=np.asarray(rows, dtype=np.float64),
        )
    except SpecError as error:
        raise SpecError([replace(p, field=f"meshes.{mesh.name}.{p.field}") for p in error.problems]) from error
