"""From the specification to the named laws, and the terms applied to them in their declared order."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from sim.assembly.kinematics import Kinematics, shaft_of
from sim.assembly.loads import shaft_torques_nm
from sim.assembly.mesh_settings import mesh_settings
from sim.assembly.senses import Senses
from sim.core.errors import Problem, SpecError
from sim.core.laws import BallLaw, Laws, MeshLaw, SupportLaw
from sim.core.near import did_you_mean
from sim.core.spec import BearingSpec, MachineSpec
from sim.core.terms import Registry, SiteContext, SiteKind, Term
from sim.parts.bearing.frequencies import bearing_speeds
from sim.parts.bearing.from_spec import geometry_from_spec
from sim.parts.bearing.hertz import ball_race_stiffness_n_per_m15
from sim.parts.mesh_law import ALONE, MeshSetting, mesh_law


@dataclass(frozen=True, kw_only=True)
class Acting:
    """A term at work: values and site."""

    term: Term
    values: Mapping[str, float]
    site: SiteContext


def site_kinds(machine: MachineSpec) -> dict[str, SiteKind]:
    """Every site of a machine by name."""
    kinds: dict[str, SiteKind] = {b.name: "bearing" for b in machine.bearings}
    kinds |= {g.name: "gear" for g in machine.gears}
    kinds |= {b.name: "body" for b in machine.bodies}
    kinds |= {m.name: "mesh" for m in machine.meshes}
    kinds |= {s.name: "shaft" for s in machine.shafts}
    return kinds


def site_context(machine: MachineSpec, kin: Kinematics, site: str, seed: int) -> SiteContext:
    """Context of a site."""
    groups = (machine.bearings, machine.gears, machine.bodies, machine.meshes, machine.shafts)
    names = next(group for group in ([p.name for p in g] for g in groups) if site in group)
    body = site
    for bearing in machine.bearings:
        body = bearing.body if bearing.name == site else body
    for mesh in machine.meshes:
        body = mesh.pinion if mesh.name == site else body
    rolling = any(b.name == site for b in machine.bearings)
    shaft = (site if site in kin.shaft_base else shaft_of(machine, body)) or ""
    return SiteContext(
        machine=machine,
        site=site,
        shaft=shaft,
        shaft_base=kin.shaft_base.get(shaft, ""),
        index=names.index(site) + 1,
        speed_hz=kin.shaft_hz.get(shaft, 0.0),
        bases_hz=kin.bases_hz,
        seed=seed,
        sense=(kin.senses.rings if rolling else kin.senses.rotors).get(body, 1.0),
    )


def machine_context(machine: MachineSpec, kin: Kinematics, seed: int) -> SiteContext:
    """Context of an effect that belongs to the machine as a whole."""
    return SiteContext(
        machine=machine, site="", shaft="", shaft_base="", index=0, speed_hz=0.0, bases_hz=kin.bases_hz, seed=seed
    )


def _ball_law(bearing: BearingSpec, notes: dict[str, str], senses: Senses) -> BallLaw:
    field = f"bearings.{bearing.name}"
    geometry = geometry_from_spec(bearing, field=field)
    if bearing.contact_stiffness_n_per_m15 is None:
        stiffness = ball_race_stiffness_n_per_m15(geometry)
        notes[f"{bearing.name}.contact_stiffness_n_per_m15"] = (
            f"derived: {stiffness:.6g} N/m^1.5 (Hertz contact of ball and both races)"
        )
    else:
        stiffness = bearing.contact_stiffness_n_per_m15
        notes[f"{bearing.name}.contact_stiffness_n_per_m15"] = f"given: {stiffness:.6g} N/m^1.5"
    return BallLaw(
        name=bearing.name,
        body=bearing.body,
        balls=geometry.balls,
        diameter_ratio_cos=geometry.gamma,
        stiffness_n_per_m15=stiffness,
        gap_m=bearing.radial_clearance_m,
        cage_phase_rad=bearing.cage_phase_rad,
        sense=senses.rings.get(bearing.body, 1.0),
        ball_spin_ratio=bearing_speeds(geometry, inner=1.0).ball_spin,
    )


def _support(bearing: BearingSpec) -> SupportLaw:
    s = bearing.support
    return SupportLaw(
        bearing=bearing.name,
        stiffness_x_n_per_m=s.stiffness_x_n_per_m,
        stiffness_y_n_per_m=s.stiffness_y_n_per_m,
        damping_x_ns_per_m=s.damping_x_ns_per_m,
        damping_y_ns_per_m=s.damping_y_ns_per_m,
    )


def settings_of(machine: MachineSpec, kin: Kinematics, acting: Sequence[Acting]) -> dict[str, MeshSetting]:
    """What the machine and the effects that act in it decide about each mesh."""
    loose: dict[str, float] = {}
    for a in acting:
        loose[a.site.site] = loose.get(a.site.site, 0.0) + a.term.centre_play_m(a.values)
    return mesh_settings(machine, kin.senses, shaft_torques_nm(machine, kin), loose)


def base_laws(
    machine: MachineSpec,
    notes: dict[str, str],
    warnings: list[str],
    *,
    settings: Mapping[str, MeshSetting] | None = None,
    senses: Senses | None = None,
) -> Laws:
    """The healthy machine's laws; without settings and senses those of the seed."""
    known = settings or {}
    meshes: dict[str, MeshLaw] = {}
    for mesh in machine.meshes:
        meshes[mesh.name] = mesh_law(machine, mesh, notes, warnings, known.get(mesh.name, ALONE))
    return Laws(
        meshes=meshes,
        balls={b.name: _ball_law(b, notes, senses or Senses()) for b in machine.bearings},
        supports={b.name: _support(b) for b in machine.bearings},
    )


def acting_terms(machine: MachineSpec, kin: Kinematics, registry: Registry, seed: int) -> list[Acting]:
    """Check the specification's terms against the registry and sort them by order of composition."""
    kinds = site_kinds(machine)
    acting: list[Acting] = []
    problems: list[Problem] = []
    for i, spec in enumerate(machine.terms):
        term = registry.get(spec.term)
        where = f"terms.{i}"
        if term is None:
            known = registry.keys()
            message = f"unknown term{did_you_mean(spec.term, known)}"
            problems.append(Problem(field=f"{where}.term", message=message, given=spec.term, allowed=", ".join(known)))
            continue
        allowed = [name for name, kind in kinds.items() if kind in term.sites]
        if spec.site not in allowed:
            message = f"is not a site where {term.key} can act"
            problems.append(
                Problem(field=f"{where}.site", message=message, given=spec.site, allowed=", ".join(allowed) or "none")
            )
            continue
        try:
            given = {**term.machine_values(machine, spec.site), **spec.parameters}
            values = term.values(given, f"{where}.parameters")
        except SpecError as error:
            problems += error.problems
            continue
        acting.append(Acting(term=term, values=values, site=site_context(machine, kin, spec.site, seed)))
    problems += _conflicts(acting)
    if problems:
        raise SpecError(problems)
    return sorted(acting, key=lambda a: a.term.order)


def _conflicts(acting: Sequence[Acting]) -> list[Problem]:
    problems = []
    seen: set[tuple[str, str]] = set()
    told: set[tuple[str, str, float]] = set()
    for a in acting:
        key = (a.term.key, a.site.site)
        one = (*key, 0.0 if a.term.repeats is None else a.values[a.term.repeats])
        if one in told:
            problems.append(
                Problem(field="terms", message=f"{a.term.key} is given twice at {a.site.site}", given=a.term.key)
            )
        seen.add(key)
        told.add(one)
    for a in acting:
        for other in a.term.excludes:
            if (other, a.site.site) in seen:
                message = f"{a.term.key} and {other} cannot act together at {a.site.site}"
                problems.append(Problem(field="terms", message=message))
    return problems


def modified_laws(laws: Laws, acting: Sequence[Acting]) -> Laws:
    """Apply the terms in order."""
    for a in acting:
        laws = a.term.modify(laws, a.values, a.site)
    return laws
