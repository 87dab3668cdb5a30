"""Stage 4: candidates are the registered effects at their sites; ranges come from their own declaration."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sim.assembly.assemble import BUILT_IN
from sim.core.params import Param
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Registry, Term
from sim.terms import REGISTRY

BELOW = 10.0
ABOVE = 6.0
"""A candidate's size is sought from a tenth of the declared default to six times it, within the bounds, where its
parameter does not say otherwise."""
COUNTED = 2.0
"""Dimensionless parameters with a whole default from here on are orders: drawn whole."""
NOWHERE: Mapping[str, float] = {}
FREE = ("custom_force",)
"""Laws of the user's own have no prior: they enter as unknown physics."""


@dataclass(frozen=True, kw_only=True)
class Candidate:
    """A registered term at a site."""

    term: str
    site: str

    @property
    def label(self) -> str:
        """`outer_spall@bearing1`."""
        return f"{self.term}@{self.site}"


def _sites(machine: MachineSpec, term: Term) -> Iterator[str]:
    groups = {
        "bearing": [b.name for b in machine.bearings],
        "gear": [g.name for g in machine.gears],
        "body": [b.name for b in machine.bodies],
        "mesh": [m.name for m in machine.meshes],
        "shaft": [s.name for s in machine.shafts],
    }
    for kind in term.sites:
        yield from groups[kind]


def candidates(machine: MachineSpec, registry: Registry = REGISTRY) -> tuple[Candidate, ...]:
    """Every effect wherever it may act: what this machine has already may have grown there, and what excludes that
    cannot be there."""
    return tuple(
        Candidate(term=term.key, site=site)
        for term in registry
        if term.key not in BUILT_IN and term.key not in FREE and term.severity is not None
        for site in _sites(machine, term)
        if not _ruled_out(machine, term, site, registry)
    )


LEAST_GROWTH = 1.5
"""Times its size that an effect in the file must be able to reach to be looked for."""


def _ruled_out(machine: MachineSpec, term: Term, site: str, registry: Registry) -> bool:
    """Whether the machine has what excludes a term at a site, or has this term in a form that cannot grow."""
    for own in (t for t in machine.terms if t.site == site):
        there = registry.get(own.term)
        if own.term != term.key and there is not None and (own.term in term.excludes or term.key in there.excludes):
            return True
    largest = already(machine, term.key, site)
    if largest is None:
        return False
    low, high = _grown(size_parameter(term), largest)
    return low <= 0.0 or high < LEAST_GROWTH * low


def already(machine: MachineSpec, term: str, site: str) -> TermSpec | None:
    """The same effect where the machine has it; the largest of several that act side by side."""
    known = REGISTRY.get(term)
    there = [t for t in machine.terms if (t.term, t.site) == (term, site)]
    if known is None or known.severity is None:
        return there[0] if there else None
    size = size_parameter(known)
    return max(there, key=lambda t: abs(size_now(t, size)), default=None)


def size_now(own: TermSpec, size: Param) -> float:
    """Of an effect that a machine has; its default where the file gives none."""
    return float(own.parameters.get(size.name, size.default))


def sought_range(machine: MachineSpec, term: Term, site: str) -> tuple[float, float]:
    """Smallest and largest size sought of an effect at a site, from that on which the machine has there already."""
    own, size = already(machine, term.key, site), size_parameter(term)
    return size_range(size) if own is None else _grown(size, own)


def _grown(size: Param, own: TermSpec) -> tuple[float, float]:
    """Sizes between which one that a machine has already is sought: up to `ABOVE` times, or as far as any other."""
    now = size_now(own, size)
    return now, min(max(ABOVE * now, size_range(size)[1]), size.high)


def with_effects(machine: MachineSpec, terms: Sequence[TermSpec]) -> MachineSpec:
    """The machine with these effects, each in place of what it has of it already."""
    new = {_one(t) for t in terms}
    return machine.model_copy(update={"terms": [*(t for t in machine.terms if _one(t) not in new), *terms]})


def _one(spec: TermSpec) -> tuple[str, str, float]:
    """What tells an effect from others at its site: some act several times there, once an axis, joint or spring."""
    term = REGISTRY.get(spec.term)
    if term is None or term.repeats is None:
        return spec.term, spec.site, 0.0
    default = next(p.default for p in term.params if p.name == term.repeats)
    return spec.term, spec.site, float(spec.parameters.get(term.repeats, default))


def size_parameter(term: Term) -> Param:
    """The parameter that measures the effect; ValueError for a term without one."""
    for param in term.params:
        if param.name == term.severity:
            return param
    raise ValueError(f"{term.key} has no size")


def size_range(param: Param) -> tuple[float, float]:
    """Smallest and largest size sought."""
    if param.sought is not None:
        return max(param.sought[0], param.low), min(param.sought[1], param.high)
    high = min(param.default * ABOVE, param.high)
    low = max(param.default / BELOW, param.low, high / 1e4)
    return low, high


def _at(param: Param, share: float, bounds: tuple[float, float] | None = None) -> float:
    low, high = bounds or size_range(param)
    return float(np.clip(np.exp(np.log(low) + share * np.log(high / low)), low, high))


def _other(param: Param, rng: np.random.Generator) -> float:
    """A parameter that is not the size: angles anywhere, the rest around its default."""
    if param.choices:
        return float(rng.choice(param.choices))
    if param.unit == "rad":
        return float(rng.uniform(max(param.low, -np.pi), min(param.high, np.pi)))
    if param.default == 0.0:
        return 0.0
    value = param.default * float(np.exp(rng.uniform(-0.7, 0.7)))
    counted = param.unit == "1" and param.default >= COUNTED and float(param.default).is_integer()
    return float(np.clip(round(value) if counted else value, param.low, param.high))


def searched(candidate: Candidate, registry: Registry = REGISTRY) -> tuple[str, ...]:
    """Parameters beside the size that have a range to be searched, in the order of their declaration."""
    term = registry.get(candidate.term)
    if term is None:
        raise ValueError(f"no term {candidate.term}")
    size = size_parameter(term)
    return tuple(p.name for p in term.params if p.sought is not None and p is not size)


def draw_term(
    candidate: Candidate,
    share: float,
    rng: np.random.Generator,
    machine: MachineSpec,
    registry: Registry = REGISTRY,
    *,
    sought: Mapping[str, float] = NOWHERE,
) -> TermSpec:
    """The candidate at `share` 0..1 of its range (logarithmic), other parameters with a range to be searched at their
    share `sought` of that, by name, else in its middle, whatever the machine gives; the rest drawn, but for what the
    machine gives. What the machine has already grows, up to `ABOVE` times at least, all else of it as it is."""
    term = registry.get(candidate.term)
    if term is None:
        raise ValueError(f"no term {candidate.term}")
    size = size_parameter(term)
    own = already(machine, candidate.term, candidate.site)
    if own is not None:
        grown = _at(size, share, _grown(size, own))
        return own.model_copy(update={"parameters": {**own.parameters, size.name: grown}})
    given = term.machine_values(machine, candidate.site)
    rest = [p for p in term.params if p is not size]
    values = {p.name: _other(p, rng) for p in rest if p.sought is None and p.name not in given}
    values |= {p.name: _at(p, sought.get(p.name, 0.5)) for p in rest if p.sought is not None}
    values[size.name] = _at(size, share)
    return TermSpec(term=candidate.term, site=candidate.site, parameters=values)
