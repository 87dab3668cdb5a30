"""Specification to system."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from sim.assembly.channels import machine_channels
from sim.assembly.held import check_held
from sim.assembly.kinematics import Kinematics, kinematics, slipped_bases
from sim.assembly.laws import Acting, acting_terms, base_laws, machine_context, modified_laws, settings_of, site_context
from sim.assembly.linear import Linear, linear_part
from sim.assembly.loads import load_vector, weight_vector
from sim.assembly.plausibility import implausible
from sim.assembly.reach import unreached_bores
from sim.assembly.references import check_references
from sim.assembly.run_up import run_up_elements
from sim.core.elements import Element
from sim.core.errors import Problem, SpecError
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.spec import MachineSpec
from sim.core.speed import speed_table
from sim.core.system import System
from sim.core.terms import Registry
from sim.terms import REGISTRY

BASE_TERMS = {"mesh": ("mesh_total", "mesh_pairs"), "bearing": ("ball_contact",)}
"""Effects every mesh and every bearing has without being asked for."""
BUILT_IN = (*(key for keys in BASE_TERMS.values() for key in keys), "force_load")
"""Keys of all effects that act without being asked for."""


def _base(machine: MachineSpec, kin: Kinematics, registry: Registry, seed: int) -> list[Acting]:
    acting = []
    for kind, names in (("mesh", [m.name for m in machine.meshes]), ("bearing", [b.name for b in machine.bearings])):
        for name in names:
            for key in BASE_TERMS[kind]:
                term = registry.get(key)
                if term is not None:
                    site = site_context(machine, kin, name, seed)
                    acting.append(Acting(term=term, values=term.values({}, key), site=site))
    loads = registry.get("force_load")
    if loads is not None:
        acting.append(Acting(term=loads, values={}, site=machine_context(machine, kin, seed)))
    return acting


def _elements(acting: Sequence[Acting], laws: Laws, dofs: Sequence[str]) -> tuple[Element, ...]:
    known = set(dofs)
    elements = [e for a in acting for e in a.term.elements(laws, a.values, a.site)]
    for element in elements:
        for coordinate in element.coordinates:
            for dof, _ in coordinate.weights:
                if dof not in known:
                    message = f"{element.name} acts on {dof}, which this machine does not have"
                    raise SpecError(Problem(field=element.site, message=message, allowed="a body that moves there"))
    return tuple(elements)


def _check_masses(linear: Linear) -> None:
    if not np.all(np.isfinite(linear.mass)) or np.any(linear.mass <= 0):
        raise SpecError(Problem(field="masses", message="every mass and inertia must be positive and finite"))


def _lines(acting: Sequence[Acting]) -> tuple[Line, ...]:
    return tuple(line for a in acting for line in a.term.lines(a.values, a.site))


def predicted_lines(
    machine: MachineSpec, *, seed: int = 0, registry: Registry = REGISTRY
) -> tuple[tuple[Line, ...], dict[str, float]]:
    """Lines and base frequencies (Hz) as `assemble` gives them, without the meshes' tables, in milliseconds."""
    check_references(machine)
    kin = kinematics(machine)
    acting = [a for a in acting_terms(machine, kin, registry, seed) if not a.term.idle(a.values)]
    bearings = base_laws(machine.model_copy(update={"meshes": []}), {}, [], senses=kin.senses)
    # Only what acts at bearings changes the speeds of their parts.
    laws = modified_laws(bearings, [a for a in acting if a.term.sites == ("bearing",)])
    return _lines(_base(machine, kin, registry, seed) + acting), slipped_bases(kin, machine, laws)


def assemble(machine: MachineSpec, *, seed: int = 0, registry: Registry = REGISTRY) -> System:
    """Build the system; SpecError lists every field that makes the machine impossible."""
    check_references(machine)
    kin = kinematics(machine)
    derived: dict[str, str] = {}
    warnings: list[str] = []
    extra = [a for a in acting_terms(machine, kin, registry, seed) if not a.term.idle(a.values)]
    settings = settings_of(machine, kin, extra)
    laws = modified_laws(base_laws(machine, derived, warnings, settings=settings, senses=kin.senses), extra)
    warnings += implausible(machine, kin)
    warnings += [text for a in extra for text in a.term.cautions(a.values, a.site)]
    bases = slipped_bases(kin, machine, laws)
    spins = {s: 2 * math.pi * hz * kin.senses.rotors.get(s, 1.0) for s, hz in kin.shaft_hz.items()}
    linear = linear_part(machine, laws.supports, spins, laws.masses)
    acting = _base(machine, kin, registry, seed) + extra
    elements = _elements(acting, laws, linear.names) + run_up_elements(machine, kin, linear)
    _check_masses(linear)
    check_held(machine, linear, elements, laws.supports)
    derived |= linear.derived
    load = load_vector(machine, kin, linear.names, linear.mass, derived)
    load = load + weight_vector(laws.weights, linear.names, linear.mass)
    dynamic = machine.operating is not None and machine.operating.kinematics == "dynamic"
    angles = {n[: -len(".theta")]: i for i, n in enumerate(linear.names) if n.endswith(".theta")} if dynamic else {}
    system = System(
        machine=machine,
        dofs=linear.names,
        mass=linear.mass,
        damping=linear.damping,
        stiffness=linear.stiffness,
        dampers=linear.dampers,
        load=load,
        elements=elements,
        speeds_hz={"": 0.0} | dict(kin.body_hz),
        speed=speed_table(machine.operating.profile if machine.operating else None, seed),
        dynamic_angle=angles,
        bases_hz=bases,
        lines=_lines(acting),
        derived=derived,
        warnings=tuple(warnings),
        channels=machine_channels(linear.names, elements),
    )
    return replace(system, warnings=(*warnings, *unreached_bores(system)))
