"""Machines without one of their effects: the twins that show what a line is caused by.

A term whose zero is healthy is set to zero severity; another is removed altogether (the paper's clearance: at zero gap
its wall is still rigid, without the term the ring stands on its support). What excites the base machine has twins
too, made from the specification alone: mesh stiffness frozen at its mean over the tooth period, transmission error
without its alternating part, and a bearing of so many weak balls that none is felt passing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

from sim.assembly.laws import base_laws
from sim.core.laws import MeshLaw
from sim.core.spec import BallGeometry, MachineSpec, MeshTable, TermSpec
from sim.terms import REGISTRY

Twin = Literal["severity_zero", "removed", "frozen_at_mean", "amplitude_zero", "many_balls", "predicted"]
PREDICTED: Twin = "predicted"
"""No machine stands for "without": the line is that part's by its frequency alone."""
MAX_ROWS = 201
MANY_BALLS = 64
MANY_RATIO = 0.04
"""d_b/d_m of the many balls: small enough to fit the cage; only their number and stiffness matter for the load."""


@dataclass(frozen=True, kw_only=True)
class Effect:
    """What can be taken away: a term of the specification, or an excitation of the base machine.

    `keeps_bases`: the twin's lines are looked for where the machine's own lie (its balls are not its own).
    """

    term: str
    site: str
    counterfactual: Twin
    keeps_bases: bool = False


def active_terms(machine: MachineSpec) -> tuple[Effect, ...]:
    """Terms of the specification that act: all but those at a zero that changes nothing."""
    return tuple(_effect(spec) for spec in machine.terms if _acts(spec))


def idle_terms(machine: MachineSpec) -> tuple[Effect, ...]:
    """Terms of the specification at a zero that changes nothing."""
    return tuple(_effect(spec) for spec in machine.terms if not _acts(spec))


def base_excitations(machine: MachineSpec) -> tuple[Effect, ...]:
    """What excites the machine without its terms, as far as it can be taken away by itself."""
    found = [Effect(term="mesh_stiffness", site=m.name, counterfactual="frozen_at_mean") for m in machine.meshes]
    found += [
        Effect(term="transmission_error", site=m.name, counterfactual="amplitude_zero")
        for m in machine.meshes
        if m.transmission_error.amplitude_m > 0
    ]
    found += [
        Effect(term="ball_contact", site=b.name, counterfactual="many_balls", keeps_bases=True)
        for b in machine.bearings
    ]
    return tuple(found)


def predicted_part(component: str, machine: MachineSpec) -> Effect:
    """What of the base machine excites a line of `component`: a mesh, the balls of a bearing, else the shaft's turning.

    Without a component: the machine as a whole, whose start or rounding it may be.
    """
    meshing = {part: m.name for m in machine.meshes for part in (m.name, m.pinion, m.gear)}
    if component in meshing:
        return Effect(term="mesh_excitation", site=meshing[component], counterfactual=PREDICTED)
    if component in {b.name for b in machine.bearings}:
        term = "ball_contact"
    else:
        term = "rotation" if component else "base_machine"
    return Effect(term=term, site=component, counterfactual=PREDICTED)


def without(machine: MachineSpec, effects: Sequence[Effect]) -> MachineSpec:
    """The machine with each of the effects taken away."""
    for effect in effects:
        machine = _TWINS[effect.counterfactual](machine, effect)
    return machine


def _acts(spec: TermSpec) -> bool:
    term = REGISTRY.get(spec.term)
    if term is None or term.severity is None or not term.zero_is_healthy:
        return True
    default = next(p.default for p in term.params if p.name == term.severity)
    return spec.parameters.get(term.severity, default) != 0.0


def _effect(spec: TermSpec) -> Effect:
    term = REGISTRY.get(spec.term)
    zero = term is not None and term.zero_is_healthy and term.severity is not None
    return Effect(term=spec.term, site=spec.site, counterfactual="severity_zero" if zero else "removed")


def _zero(machine: MachineSpec, effect: Effect) -> MachineSpec:
    term = REGISTRY.get(effect.term)
    assert term is not None and term.severity is not None
    nothing = {term.severity: 0.0}
    terms = [
        t.model_copy(update={"parameters": {**t.parameters, **nothing}}) if _same(t, effect) else t
        for t in machine.terms
    ]
    return machine.model_copy(update={"terms": terms})


def _removed(machine: MachineSpec, effect: Effect) -> MachineSpec:
    return machine.model_copy(update={"terms": [t for t in machine.terms if not _same(t, effect)]})


def _same(spec: TermSpec, effect: Effect) -> bool:
    return (spec.term, spec.site) == (effect.term, effect.site)


def _frozen(machine: MachineSpec, effect: Effect) -> MachineSpec:
    law = base_laws(machine, {}, []).meshes[effect.site]
    # a table has at most 201 rows; every n-th keeps them equally spaced
    step = -(-law.centre_errors_m.size // MAX_ROWS)
    rows = [[value, value] for value in _mean_rows(law)[::step]]
    table = MeshTable(centre_distance_error_m=law.centre_errors_m[::step].tolist(), stiffness_n_per_m=rows)
    update = {"table": table, "damping_ns_per_m": law.damping_ns_per_m}
    meshes = [m.model_copy(update=update) if m.name == effect.site else m for m in machine.meshes]
    return machine.model_copy(update={"meshes": meshes})


def _mean_rows(law: MeshLaw) -> list[float]:
    """Mean total stiffness over the tooth period for each centre distance, N/m; a pair lasts its contact ratio."""
    if law.pair_rows is not None and law.pair_ratios is not None:
        means = law.pair_rows[law.pair_rows.shape[0] // 2].mean(axis=1) * law.pair_ratios
    else:
        assert law.total_rows is not None
        means = law.total_rows.mean(axis=1)
    return [float(value) for value in means]


def _even(machine: MachineSpec, effect: Effect) -> MachineSpec:
    meshes = []
    for mesh in machine.meshes:
        error = mesh.transmission_error.model_copy(update={"amplitude_m": 0.0})
        meshes.append(mesh.model_copy(update={"transmission_error": error}) if mesh.name == effect.site else mesh)
    return machine.model_copy(update={"meshes": meshes})


def _many_balls(machine: MachineSpec, effect: Effect) -> MachineSpec:
    """Balls so many that their passing is not felt, of the same stiffness all around the ring."""
    law = base_laws(machine, {}, []).balls[effect.site]
    update = {
        "catalogue": None,
        "geometry": BallGeometry(balls=MANY_BALLS, diameter_ratio=MANY_RATIO),
        "contact_stiffness_n_per_m15": law.stiffness_n_per_m15 * law.balls / MANY_BALLS,
    }
    bearings = [b.model_copy(update=update) if b.name == effect.site else b for b in machine.bearings]
    return machine.model_copy(update={"bearings": bearings})


_TWINS = {
    "severity_zero": _zero,
    "removed": _removed,
    "frozen_at_mean": _frozen,
    "amplitude_zero": _even,
    "many_balls": _many_balls,
}
