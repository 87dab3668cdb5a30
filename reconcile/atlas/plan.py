"""Which machines an atlas simulates: healthy ones with drifted twins, and every candidate over its range."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.candidates import Candidate, already, draw_term, searched, with_effects
from reconcile.calibrate.uncertain import DRIFT, Offsets, Uncertain, draw_offsets, moved
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec, TermSpec, TorqueLoad
from sim.solve.ensemble import Member
from sim.terms import REGISTRY

DRAWS = 8
"""Draws a candidate: a full set of vector lanes."""
CAGE_SLIP = "cage_slip"
SLIP = 0.02
"""Share by which cages lag in sound bearings (Randall & Antoni 2011, section 2)."""
NULL_PAIRS = 144
"""Healthy machines, each with a drifted twin."""


@dataclass(frozen=True, kw_only=True)
class Point:
    """An operating point: drive shaft's speed, Hz, and the factor on all torques."""

    speed_hz: float
    torque_ratio: float = 1.0


NEAR_SPEED, NEAR_TORQUE = 0.005, 0.025
"""Shares by which a speed or torque may be off the machine's own and is simulated there: stated speeds are wrong by as
much, and one atlas then serves all recordings at about that speed."""


def simulated_at(machine: MachineSpec, point: Point) -> Point:
    """The operating point at which is simulated what was recorded at `point`: the machine's own where that is near,
    else the speed to three digits (0.5 % off at most)."""
    own = machine.operating.speed_hz if machine.operating is not None else 0.0
    near = own > 0.0 and abs(point.speed_hz / own - 1.0) <= NEAR_SPEED
    speed = own if near else float(f"{point.speed_hz:.3g}")
    torque = 1.0 if abs(point.torque_ratio - 1.0) <= NEAR_TORQUE else point.torque_ratio
    return Point(speed_hz=speed, torque_ratio=torque)


@dataclass(frozen=True, kw_only=True)
class Draw:
    """One simulated machine: healthy number `pair` (twin or not), or a candidate on healthy machine `pair`."""

    pair: int
    twin: bool = False
    candidate: Candidate | None = None
    term: TermSpec | None = None
    also: Sequence[TermSpec] = ()
    """Further terms of the same effect: a law of its own on another axis."""
    beside: Sequence[TermSpec] = ()
    """The same effect at other sites, too faint to show: machines of one structure run side by side."""


@dataclass(frozen=True, kw_only=True)
class AtlasPlan:
    """`offsets[pair]` and `twins[pair]` move the nominal machine; `draws` lists what to simulate at each point."""

    machine: MachineSpec
    numbers: tuple[Uncertain, ...]
    offsets: tuple[Offsets, ...]
    twins: tuple[Offsets, ...]
    draws: tuple[Draw, ...]
    seed: int

    def member(self, draw: Draw, point: Point) -> Member:
        """The machine of this draw at this point."""
        offsets = (self.twins if draw.twin else self.offsets)[draw.pair]
        machine = at_point(moved(self.machine, self.numbers, offsets), point)
        terms = slips(machine, self.seed, draw.pair) if draw.twin else ()
        if draw.term is not None:
            terms = (*terms, *sorted((draw.term, *draw.also, *draw.beside), key=lambda t: t.site))
        if terms:
            machine = with_effects(machine, terms)
        return Member(machine=machine, seed=self.seed + 1000 * draw.pair + (1 if draw.twin else 0))


def slips(machine: MachineSpec, seed: int, pair: int) -> tuple[TermSpec, ...]:
    """Cages of a sound machine lag by another share in every recording."""
    rng = np.random.default_rng([seed, 13, pair])
    shares = rng.uniform(0.0, SLIP, len(machine.bearings))
    present = {t.site for t in machine.terms if t.term == CAGE_SLIP}
    return tuple(
        TermSpec(term=CAGE_SLIP, site=b.name, parameters={"share": float(share)})
        for b, share in zip(machine.bearings, shares, strict=True)
        if b.name not in present and (b.geometry is not None or b.catalogue is not None)
    )


def with_tooth_pairs(machine: MachineSpec) -> MachineSpec:
    """A mesh given by one total curve is simulated by its tooth pairs, so that single teeth can differ.

    A table of another origin differs from the potential-energy method by some percent: the machine's uncertainty
    (10 % of the modulus) covers that.
    """
    meshes = [m.model_copy(update={"table": None, "tooth_pairs": True}) for m in machine.meshes]
    return machine.model_copy(update={"meshes": meshes})


def at_point(machine: MachineSpec, point: Point) -> MachineSpec:
    """The machine at another speed and load; SpecError for a machine that does not turn."""
    if machine.operating is None:
        raise SpecError(Problem(field="operating", message="the machine has no speed", allowed="shaft, speed_hz"))
    operating = machine.operating.model_copy(update={"speed_hz": point.speed_hz, "profile": None})
    loads = [
        load.model_copy(update={"torque_nm": load.torque_nm * point.torque_ratio})
        if isinstance(load, TorqueLoad)
        else load
        for load in machine.loads
    ]
    return machine.model_copy(update={"operating": operating, "loads": loads})


def atlas_plan(
    machine: MachineSpec,
    numbers: tuple[Uncertain, ...],
    chosen: Sequence[Candidate],
    *,
    seed: int,
    draws: int = DRAWS,
    pairs: int = NULL_PAIRS,
) -> AtlasPlan:
    """Deterministic: same machine, candidates and seed give the same plan."""
    rng = np.random.default_rng([seed, 1])
    offsets = tuple(draw_offsets(numbers, rng) for _ in range(pairs))
    twins = tuple(o.mixed(draw_offsets(numbers, rng), DRIFT) for o in offsets)
    planned = [Draw(pair=k, twin=twin) for twin in (False, True) for k in range(pairs)]
    for candidate in chosen:
        own = np.random.default_rng([seed, 2, *candidate.label.encode()])
        shares = (own.permutation(draws) + own.uniform(0.1, 0.9, draws)) / draws
        others = spread_over(candidate, draws, seed)
        for j in range(draws):
            sought = {name: float(places[j]) for name, places in others.items()}
            term = draw_term(candidate, float(shares[j]), own, machine, sought=sought)
            planned.append(Draw(pair=j % pairs, candidate=candidate, term=term))
    return AtlasPlan(machine=machine, numbers=numbers, offsets=offsets, twins=twins, draws=tuple(planned), seed=seed)


def spread_over(candidate: Candidate, draws: int, seed: int) -> dict[str, FloatArray]:
    """Of each parameter beside the size that is searched the places of the draws in its range, (draws,), 0..1: evenly,
    each in an order of its own."""
    found = {}
    for number, name in enumerate(searched(candidate)):
        rng = np.random.default_rng([seed, 5, *((number,) if number else ()), *candidate.label.encode()])
        found[name] = (rng.permutation(draws) + 0.5) / draws
    return found


def side_by_side(plan: AtlasPlan) -> AtlasPlan:
    """Each draw with its effect at all other sites of the plan, too faint to show: few draws a site then fill lanes."""
    sites: dict[str, dict[str, TermSpec]] = {}
    for draw in plan.draws:
        if draw.term is not None:
            sites.setdefault(draw.term.term, {}).setdefault(draw.term.site, draw.term)
    faint = {key: _faint(key, terms) for key, terms in sites.items()}

    def beside(draw: Draw) -> Draw:
        if draw.term is None:
            return draw
        key, own = draw.term.term, draw.term.site
        others = [t for site, t in faint[key].items() if site != own and already(plan.machine, key, site) is None]
        return replace(draw, beside=tuple(others))

    return replace(plan, draws=tuple(beside(d) for d in plan.draws))


def _faint(key: str, terms: Mapping[str, TermSpec]) -> dict[str, TermSpec]:
    """By site; none where an effect has no faint form."""
    term = REGISTRY.get(key)
    found = {}
    for site, one in terms.items():
        values = term.faint(one.parameters) if term is not None else None
        if values is not None:
            found[site] = one.model_copy(update={"parameters": dict(values)})
    return found
