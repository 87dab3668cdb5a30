"""Which families are named: firm against foreign orders in every family's search, and more than in the baseline."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from reconcile.kinematics.beside_turn import NEXT_BINS, ONE_LINE, Beside, Turned
from reconcile.kinematics.candidate import DEFECTS, LEAST_Z, Candidate
from reconcile.kinematics.chances import fisher, holm
from reconcile.kinematics.contrast import contrast
from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.evidence import CERTAIN_Z, Evidence, family_evidence
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.in_step import of_blows
from reconcile.kinematics.observe import Observation

TURN_DEPTH = 0.3
"""Of impacts once a turn against a baseline: runout modulates a sound gearbox under 1.6 times the load by 0.22, a tooth
that strikes by 0.37 and more."""
HEARD_Z = 4.5
"""Deviations from which a family's lines are kept from the orders it is held against, where nothing but these lines is
known: sound bearings stay below 3, struck inner races reach 5 where the controls hear their sidebands."""
SECOND_SHARE, SECOND_ALONE = 0.5, 0.7
"""Of the first family's score, for a second one to be named beside it: with a baseline, and without."""
SECOND_LEVEL = 1e-3
SAME_ORDER = 0.5
"""Families nearer than this share of the slip are one to the data."""
LIKE_SPACING = 0.05
"""Relative difference of cages' orders that no recording of a minute tells apart in the sidebands of a ball."""
CENTRE = 0.95
"""Of a sideband's depth that the line itself has at least: in a load zone of half a turn sidebands have 0.85 of it."""
LIKE_SHARE = 0.7
"""Of the score of the firmest reading of a line that another reading of it must have."""


def candidates(
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    ties: Ties,
    seed: int,
    explained: Sequence[Candidate] = (),
    *,
    lean: bool = False,
    certain_z: float = CERTAIN_Z,
) -> tuple[Candidate, ...]:
    """All families (but `explained`, whose lines are taken out, `lean`: no more than those), the firmest first."""
    left: list[Family] = []
    for f in ties.families:
        if not any(same(f, g) and f.kind == g.kind for g in (*left, *(c.family for c in explained))):
            left.append(f)
    rows = []
    for f in left:
        found = []
        for i, t in enumerate(tests):
            rng = np.random.default_rng((seed, i, ties.families.index(f)))
            taken = [(c.family, c.evidence[i].order) for c in explained]
            found.append(family_evidence(t.channels, ties, f, t.doubt, rng, taken, lean, certain_z))
        rows.append((f, tuple(found)))
    chances = holm([fisher([e.chance for e in found]) for _, found in rows])

    def heard(f: Family, found: tuple[Evidence, ...], chance: float) -> Candidate:
        pairs = zip(found, tests, strict=True)
        return Candidate(
            family=f,
            evidence=found,
            contrasts=tuple(contrast(e, t, baselines, ties) for e, t in pairs),
            chance=chance,
        )

    result = []
    for (f, evidence), chance in zip(rows, chances, strict=True):
        first = heard(f, evidence, chance)
        elsewhere = (heard(f, e, len(rows) * fisher([one.chance for one in e])) for e in in_other_channels(first))
        result.append(next((c for c in elsewhere if c.based and c.present and c.risen), first))
    return firmest_first(result)


def firmest_first(several: Iterable[Candidate]) -> tuple[Candidate, ...]:
    """Those that are present and have risen before the rest, by their scores."""
    return tuple(sorted(several, key=lambda c: (not (c.present and c.risen), -c.z)))


def in_other_channels(first: Candidate) -> Iterator[tuple[Evidence, ...]]:
    """The evidence of each other channel in turn, the firmest first, where lines are present and the baseline has them
    as deep: one sensor may hear the balls of the sound bearing pass, and another, which does not, the defect."""
    if first.family.kind not in DEFECTS or not first.present or first.risen or not first.based:
        return
    every = [{e.channel: e for e in (one, *one.others)} for one in first.evidence]
    shared = set(every[0]).intersection(*every[1:])
    mean = {c: float(np.mean([e[c].z for e in every])) for c in shared}
    for channel in sorted(shared, key=lambda c: (-mean[c], c)):
        found = tuple(e[channel] for e in every)
        if found != first.evidence:
            yield found


def named(
    tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties, seed: int
) -> tuple[tuple[Candidate, ...], tuple[Candidate, ...]]:
    """(bearing defects that stand, at most two; all candidates)."""
    found = candidates(tests, baselines, ties, seed, certain_z=HEARD_Z)
    beside = partial(candidates, tests, baselines, ties, seed, certain_z=HEARD_Z)
    turned = Turned(found, tests, beside)
    every = tuple(_asked(c, tests, ties) for c in firmest_first(map(turned.told, found)))
    first = next((c for c in every if c.family.kind in DEFECTS and c.present and c.risen and c.deep), None)
    if first is None:
        return (), every
    first, left = own_lines(nearest_drawing(first, every), every, beside)
    second = next(
        (
            c
            for c in left
            if c.family.kind in DEFECTS
            and c.risen
            and c.deep
            and c.chance < SECOND_LEVEL
            and c.z > (SECOND_SHARE if baselines else SECOND_ALONE) * first.z
            and not turned.leaves(c)
            and of_blows(c, tests, ties) is None
        ),
        None,
    )
    return ((first,) if second is None else (first, second)), every


def _asked(one: Candidate, tests: Sequence[Observation], ties: Ties) -> Candidate:
    """The candidate, which knows whether its line is one of its own, and no blows' that keep step with a shaft."""
    if one.family.kind in DEFECTS:
        one = replace(one, centred=centred(one, tests, ties))
    return replace(one, driven=True) if one.present and of_blows(one, tests, ties) is not None else one


def centred(one: Candidate, tests: Sequence[Observation], ties: Ties) -> bool:
    """Whether the first line of a family is as deep as what stands beside it at the distance of its sidebands or of a
    turn. Blows are stronger or weaker as load and cage have it, never negative: so the mean of their strength, the line
    itself, exceeds what modulates it. A line with deeper ones beside it is itself a sideband of a stranger."""
    return all(_centred(one.family, where, order, tests[one.strongest], ties) for where, order in one.read_in)


def _centred(
    family: Family, where: tuple[str, tuple[float, float]], own_order: float, test: Observation, ties: Ties
) -> bool:
    """The same in one band of a channel."""
    e = test.channel(where[0])
    assert e is not None
    band = int(np.argmin(np.abs(e.bands_hz - np.array(where[1])).sum(axis=1)))
    own = _depth_at(e, band, own_order)
    turns = tuple(ties.shafts.values())
    for distance in {family.spacing, *turns} - {0.0}:
        for order in (own_order - distance, own_order + distance):
            of_a_turn = any(abs(order - round(order / t) * t) < NEXT_BINS * e.order_step for t in turns)
            if order > NEXT_BINS * e.order_step and not of_a_turn and _depth_at(e, band, order) * CENTRE > own:
                return False
    return True


def _depth_at(envelopes: Envelopes, band: int, order: float) -> float:
    place = round(order / envelopes.order_step)
    return float(np.max(envelopes.depth[band, max(place - 2, 0) : place + 3], initial=0.0))


def own_lines(first: Candidate, every: Sequence[Candidate], beside: Beside) -> tuple[Candidate, tuple[Candidate, ...]]:
    """The firmest, or a rival that is as firm and stands without the firmest's lines while that does not without the
    rival's; and all `beside` it, without its lines. Sidebands of an inner race near five times the turn are the lattice
    of an outer one near three times."""
    left = beside((first,))
    for rival in every:
        firm = rival.family.kind in DEFECTS and rival.present and rival.risen and rival.deep
        if rival is first or not firm or one_line(rival, first) or rival.z < LIKE_SHARE * first.z:
            continue
        if _z_of(rival, left) >= LEAST_Z > _z_of(first, instead := beside((rival,))):
            return rival, instead
    return first, left


def _z_of(one: Candidate, every: Sequence[Candidate]) -> float:
    return max((c.z for c in every if c.family.key == one.family.key), default=0.0)


def one_line(a: Candidate, b: Candidate) -> bool:
    """Whether two candidates read one line as parts of two bearings."""
    like = a.family.kind == b.family.kind and like_spacing(a.family, b.family)
    return like and abs(a.best.order / b.best.order - 1) < ONE_LINE


def nearest_drawing(first: Candidate, every: Sequence[Candidate]) -> Candidate:
    """Of the readings of one line the one that lies nearest to its drawing: with races 2 % apart the searches of both
    find it, and chance decides whose score is higher."""
    alike = [
        c for c in every if c.present and c.risen and c.deep and one_line(c, first) and c.z >= LIKE_SHARE * first.z
    ]
    return min(alike, key=lambda c: abs(c.best.slip), default=first)


def same(a: Family, b: Family) -> bool:
    """Whether two families are one to the data (bearings of one geometry on shafts of one speed)."""
    return abs(a.order / b.order - 1) < SAME_ORDER * max(a.slip, b.slip, 1e-6) and like_spacing(a, b)


def like_spacing(a: Family, b: Family) -> bool:
    """Whether sidebands of two families stand at one distance: those of one shaft, or of two cages that slip."""
    return abs(a.spacing - b.spacing) <= LIKE_SPACING * max(a.spacing, b.spacing)
