"""Two local defects: impacts at the frequencies of two parts, neither of which makes the other's lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.families import HARMONICS, Family, Ties
from reconcile.kinematics.judge import SECOND_LEVEL, candidates, same
from reconcile.kinematics.observe import Observation
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

TWICE = 4.0
"""Squared score of a family over its log evidence: their tails are wider than Gaussian."""
ALSO_Z = 4.5
"""Score of a second one with all lines in place: what rises only when others are taken out is what they leave. Of
concealed development cases second defects had 4.8 to 9, the balls of a bearing whose inner race was pitted 3.9."""
KINDS = (*DEFECTS, "turn")


def combs(
    tests: Sequence[Observation], baselines: Sequence[Observation], tie: Ties, seen: Sequence[Candidate], seed: int
) -> tuple[Candidate, ...]:
    """The firmest family of impacts and those that stand without its lines, the firmest first; empty where no second
    one does. In short records what shafts and cage add to the first may cover most of a second's lines, and what is
    not taken out may look like it: one that stands against either has lines of its own. One that begins at a line of
    the first's cage must stand with all lines of that cage taken out."""
    first = next((c for c in seen if c.family.kind in KINDS and c.present and c.risen), None)
    if first is None:
        return ()
    heard = [c.family for c in seen if c.z >= ALSO_Z]
    if all(_among(family, [first.family]) for family in heard):
        return ()
    found: list[Candidate] = []
    for lean in (True, False):
        for c in candidates(tests, baselines, tie, seed, (first,), lean=lean):
            if _stands(c) and _among(c.family, heard) and not _among(c.family, [f.family for f in (first, *found)]):
                found.append(c)
    cage = _cage_of(first, tie)
    if cage is not None and any(_at_cage(c.family, cage.family) for c in found):
        apart = [c.family for c in candidates(tests, baselines, tie, seed, (first, cage), lean=True) if _stands(c)]
        found = [c for c in found if not _at_cage(c.family, cage.family) or _among(c.family, apart)]
    return (first, *sorted(found, key=lambda c: -c.z)) if found else ()


def _stands(one: Candidate) -> bool:
    return one.family.kind in KINDS and one.present and one.risen and one.chance < SECOND_LEVEL


def _cage_of(struck: Candidate, tie: Ties) -> Candidate | None:
    """The cage of the bearing that is struck, at the orders that the struck part's tell (a race passes its balls at Z
    times the cage's speed before it); None of what is no bearing's."""
    own = next((f for f in tie.families if f.kind == "cage" and f.site == struck.family.site), None)
    if own is None:
        return None
    shaft = own.order / tie.races[own.site].cage
    outer = struck.family.kind == "outer"
    ratios = [e.order / struck.family.order for e in struck.evidence]
    orders = [own.order * r if outer else shaft - (shaft - own.order) * r for r in ratios]
    told = tuple(replace(e, family=own, order=o) for e, o in zip(struck.evidence, orders, strict=True))
    return replace(struck, family=own, evidence=told)


def _at_cage(family: Family, cage: Family) -> bool:
    """Whether a bearing's family begins, within slip, at one of a cage's lines: no two balls strike alike, so a pit's
    blows repeat with the cage. Twice that of the fast shaft's bearings of the proof's gearbox is 0.6 % off the outer
    race of the slow one's, and stood for a second pit of x001."""
    lines = [k * cage.order for k in range(1, HARMONICS["cage"] + 1)]
    near = max(family.slip, cage.slip)
    return family.kind in DEFECTS and any(abs(line / family.order - 1.0) < near for line in lines)


def _among(family: Family, others: Sequence[Family]) -> bool:
    return any(same(family, f) and family.kind == f.kind for f in others)


def effects_of(comb: Candidate, machine: MachineSpec, tie: Ties) -> tuple[str, ...]:
    """Effects (`effect@site`) that strike at a comb's lines; bearings with the same lines share it."""
    family = comb.family
    alike = {f.site for f in tie.families if f.kind == family.kind and same(f, family)} | {family.site}
    names = []
    for term in REGISTRY:
        if term.strikes == "tooth" and family.kind == "turn":
            names += [f"{term.key}@{g.name}" for g in machine.gears if g.shaft in alike]
        elif term.strikes == family.kind:
            names += [f"{term.key}@{b.name}" for b in machine.bearings if b.name in alike]
    return tuple(names)


def by_comb(
    found: Sequence[Candidate], machine: MachineSpec, tie: Ties, evidence: Mapping[str, float], most: float
) -> tuple[Mapping[str, float], ...]:
    """Log evidence of the effects of each comb, at most `most`: of the first and of teeth as it is in `evidence`, of
    another by what stands without the first's lines."""
    groups = []
    for k, comb in enumerate(found):
        own = 0.0 if k == 0 or comb.family.kind == "turn" else comb.z**2 / TWICE
        groups.append({n: min(most, max(own, evidence.get(n, 0.0))) for n in effects_of(comb, machine, tie)})
    return tuple(g for g in groups if g)
