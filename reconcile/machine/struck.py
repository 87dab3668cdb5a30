"""Two local defects: impacts at the frequencies of two parts, neither of which makes the other's lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

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
    not taken out may look like it: one that stands against either has lines of its own. One that stands where the
    first's cage has lines must do so with these taken out."""
    first = next((c for c in seen if c.family.kind in KINDS and c.present and c.risen), None)
    if first is None:
        return ()
    heard = [c.family for c in seen if c.z >= ALSO_Z]
    if all(_among(family, [first.family]) for family in heard):
        return ()
    found: list[Candidate] = []
    for lean in (True, False):
        for c in candidates(tests, baselines, tie, seed, (first,), lean=lean):
            own = c.family.kind in KINDS and c.present and c.risen and c.chance < SECOND_LEVEL
            own = own and not (lean and _of_cage(c.family, first.family, tie))
            if own and _among(c.family, heard) and not _among(c.family, [f.family for f in (first, *found)]):
                found.append(c)
    return (first, *sorted(found, key=lambda c: -c.z)) if found else ()


def _of_cage(family: Family, struck: Family, tie: Ties) -> bool:
    """Whether a family begins, within slip, at one of the lines of the cage of the bearing that is struck: no two balls
    strike alike, so a pit's blows repeat with the cage. Twice that of the fast shaft's bearings of the proof's gearbox
    is 0.6 % off the outer race of the slow one's, and stood for a second pit of x001."""
    cages = [f.order for f in tie.families if f.kind == "cage" and f.site == struck.site]
    lines = [k * order for order in cages for k in range(1, HARMONICS["cage"] + 1)]
    return any(abs(line / family.order - 1.0) < max(family.slip, struck.slip) for line in lines)


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
