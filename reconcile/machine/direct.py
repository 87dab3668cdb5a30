"""Stage 3 without simulations: impacts at a part's own frequency, and what comes back once a turn of a gear.

A local defect strikes each time it passes. How deep a band is modulated at that frequency, and whether the baseline is
too, needs no model of path or gain: what `reconcile.kinematics` says of a machine of which nothing else is known is
evidence here too. The level of the features cannot say it as sharply: lines of inner ring and balls lie within each
other's slip.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.envelopes import envelopes
from reconcile.kinematics.families import Family, Ties, ties
from reconcile.kinematics.judge import candidates, same
from reconcile.kinematics.observe import Observation, reach_of
from reconcile.kinematics.spec import of_machine
from reconcile.machine.alone import Rise
from reconcile.machine.envelope import Drawn, drawn
from reconcile.machine.struck import by_comb, combs
from reconcile.machine.window import tooth_places
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.tooth_place import ToothPlace
from signals.recording import Operating, Recording
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

DOUBT = 3e-4
"""Relative error of the speed of recordings whose angle was followed."""
SCATTER = 2.0
"""Squared score of a family that counts as one unit of twice the evidence: their tails are wider than Gaussian."""
TURNS_SHARE = 0.5
"""A struck inner ring modulates once a turn too: by no more than this share of its own lines' score. Of eleven pits of
inner races of the proof that were heard 0.27 at most; an unbalance that rattles (z014) 1.5, which had made it one."""
IMPACTS_FROM = 3
"""Harmonic of a shaft from which on its modulation is that of impacts."""
MOST_TURNS = 4.0
"""Of impacts once a turn alone: unbalance in a clearance and a rub strike as often."""
MODELLED = 4.0
"""Deviations of simulated sound machines that a family's modulation must exceed where there is no baseline, or one
operating point alone. Concealed development cases: sound bearings at most 2.1 without a baseline, two outer pits 12 and
17; against a baseline a sound one 2.6 at one point, where it had 9.3 deviations of control lines, a pit 6.2."""
MODELLED_BARE = 3.0
"""The same on a machine without teeth against a baseline at several points. Concealed cases: pits 4.7 to 6.7; a loose
ring told at the other bearing's lines 1.9, by 7.7 deviations of control lines; a whirl -0.3."""
ALIKE = 4.0 / 9.0
"""Share of the evidence (two thirds of the deviations) from which two parts with lines at one place are alike."""
SAME_LINE = 1e-3
"""Relative difference of orders below which parts of two bearings have one line: no recording tells them apart."""
MOST = 25.0
"""Log evidence beyond which more impacts prove no more."""
SURE, HEARD, UNHEARD = 8.0, 5.0, 1.0
"""Log evidence from which impacts are sure; below which none are heard (4.5 deviations of control lines); below which
there is nothing at all (two deviations): of 25 concealed cases with a pit (0.56 mm and more) that was told all have 5
deviations and more; of two of loose blows, which a pit fitted best, none."""


@dataclass(frozen=True, kw_only=True)
class Direct:
    """`evidence`: log evidence of effects (`effect@site`) that strike, 0 for all others; below 0 for what would strike
    and is not heard, where another part is struck for sure.

    `p`: chance that a sound machine shows the firmest of what has risen; 1 where nothing has. `struck`: where impacts
    come at the lines of several parts, the effects of each with their evidence, the firmest part's first. `places`: of
    every gear in a mesh.
    """

    evidence: Mapping[str, float]
    p: float
    told: tuple[str, ...]
    struck: tuple[Mapping[str, float], ...] = ()
    places: Mapping[str, ToothPlace] = field(default_factory=dict)
    present: frozenset[str] = frozenset()
    """Effects in bearings at whose lines something strikes in the tests, more than in the baseline or not."""
    silent: frozenset[str] = frozenset()
    """What balls would strike and is not heard at all, where they are heard elsewhere."""
    looked: bool = False
    """Whether every pit in a bearing that strikes would be heard: against a baseline, on a machine whose balls do not
    rattle for want of teeth that load them."""
    envelopes: tuple[Drawn, ...] = ()
    """What was heard at the lines of parts of bearings, the firmest first."""


NOTHING = Direct(evidence={}, p=1.0, told=())


def direct_evidence(
    machine: MachineSpec,
    data: Sequence[PointData],
    channels: Sequence[Channel],
    *,
    seed: int,
    rise: Rise | None = None,
) -> Direct:
    """What struck, in the recordings of all operating points against their baselines, or without those by more than
    simulated sound machines (`rise`)."""
    places = tooth_places(machine, data)
    try:
        tie = impulsive(ties(of_machine(machine), machine.operating.shaft if machine.operating else None))
    except SpecError as error:  # shafts whose speeds nothing ties together
        return replace(NOTHING, told=(f"not looked for: {error}",), places=places)
    if not reachable(data, tie):
        return replace(NOTHING, told=("not looked for: the sampling rate is too low for their lines",), places=places)
    tests = [observed_as(d.spectra[0], f"test {k}", channels, tie) for k, d in enumerate(data, 1)]
    rested = [d.spectra[1] for d in data]
    baselines = [observed_as(b, f"baseline {k}", channels, tie) for k, b in enumerate(rested, 1) if b is not None]
    seen = candidates(tests, baselines, tie, seed)
    points, based, teeth = len(data), bool(baselines), bool(machine.gears)
    every = tuple(c for c in seen if rise is None or _counts(c, rise, points=points, based=based, teeth=teeth))
    evidence: dict[str, float] = {}
    for term in REGISTRY:
        if term.strikes == "tooth":
            evidence |= {f"{term.key}@{g.name}": _tooth(every, g.shaft, places.get(g.name)) for g in machine.gears}
        elif term.strikes is not None:
            evidence |= {f"{term.key}@{b.name}": _ball(every, tie, term.strikes, b.name) for b in machine.bearings}
    evidence = shared_lines(evidence, tie)
    as_usual = [c.family for c in seen if c.risen and c not in every]
    spared = unjudged(evidence, tie, as_usual)
    firm = [c for c in every if c.present and c.risen]
    several = combs(tests, baselines, tie, every, seed) if baselines else ()
    heard = [c for c in every if c.risen and c.z > 2.0]
    usual = [f"{c.family.key}: {c.z:.1f}, but sound machines show as much" for c in seen if c.risen and c not in every]
    return Direct(
        evidence={name: min(value, MOST) for name, value in unheard(evidence, spared).items() if value != 0.0},
        p=min([1.0, *(c.chance for c in firm), *(min(1.0, len(places) * p.chance) for p in places.values())]),
        told=(
            *(f"{_called(c.family, tie)}: {c.z:.1f} deviations of control lines" for c in heard),
            *usual,
            *(f"one place of the turn of {name}: {p.evidence:.1f} of evidence" for name, p in places.items() if p.told),
            *(f"{c.family.key}: {c.z:.1f} without the lines of {several[0].family.key}" for c in several[1:]),
        ),
        struck=by_comb(several, machine, tie, evidence, MOST),
        places=places,
        silent=silent_beside(evidence, unjudged(evidence, tie, as_usual, HEARD)),
        present=frozenset(struck_at(seen, tie, machine)),
        looked=based and teeth,
        envelopes=drawn(firm, every, tests, baselines, tie),
    )


def struck_at(seen: Sequence[Candidate], tie: Ties, machine: MachineSpec) -> Iterator[str]:
    """Effects in bearings whose families are `present`."""
    there = [c.family for c in seen if c.present]
    for term in REGISTRY:
        for family in tie.families if term.strikes in DEFECTS else ():
            known = family.kind == term.strikes and any(b.name == family.site for b in machine.bearings)
            if known and any(f.kind == family.kind and same(f, family) for f in there):
                yield f"{term.key}@{family.site}"


def _called(family: Family, tie: Ties) -> str:
    """The part, with those of other bearings whose lines stand at the same place."""
    alike = [f for f in tie.families if f.kind == family.kind and f.slip > 0.0]
    near = [f.key for f in alike if abs(f.order / family.order - 1.0) < SAME_LINE and f.key != family.key]
    return " or ".join((family.key, *dict.fromkeys(near)))


def shared_lines(evidence: Mapping[str, float], tie: Ties) -> dict[str, float]:
    """Where slip leaves the lines of two parts at one place, what is heard there counts for both alike, unless one has
    hardly any of it: a pitted inner race had 6.1 deviations as balls, whose lines were 0.6 % off, and 4.6 as itself."""
    rolling = {t.strikes: [u.key for u in REGISTRY if u.strikes == t.strikes] for t in REGISTRY if t.strikes != "tooth"}
    families = [f for f in tie.families if f.slip > 0.0 and f.kind in rolling]
    found = dict(evidence)
    for a in families:
        near = [b for b in families if abs(b.order / a.order - 1.0) < max(a.slip, b.slip)]
        for name in (f"{key}@{a.site}" for key in rolling[a.kind]):
            heard = [evidence.get(f"{key}@{b.site}", 0.0) for b in near for key in rolling[b.kind]]
            most = max(heard, default=0.0)
            if evidence.get(name, 0.0) >= ALIKE * most:
                found[name] = max(found.get(name, 0.0), most)
    return found


def unjudged(evidence: Mapping[str, float], tie: Ties, usual: Sequence[Family], least: float = SURE) -> set[str]:
    """Effects whose silence says nothing: their lines lie within slip of those of a part that is struck for sure (by
    log evidence `least`), or are there (`usual`) and no more than sound machines show."""
    rolling = {t.strikes: [u.key for u in REGISTRY if u.strikes == t.strikes] for t in REGISTRY if t.strikes != "tooth"}
    families = [f for f in tie.families if f.kind in rolling]
    sure = [f for f in families if max(evidence.get(f"{key}@{f.site}", 0.0) for key in rolling[f.kind]) >= least]
    spared = [
        f
        for f in families
        if any(f.kind != g.kind and abs(g.order / f.order - 1.0) < max(f.slip, g.slip) for g in sure)
        or any(f.kind == g.kind and same(f, g) for g in usual)
    ]
    return {f"{key}@{f.site}" for f in spared for key in rolling[f.kind]}


def unheard(evidence: Mapping[str, float], spared: Collection[str] = ()) -> dict[str, float]:
    """Where balls strike one part for sure, the silence of other parts that they would strike is evidence too: what
    a pit of one race and one of the other do to the levels is nearly alike, what they strike is not. With phases
    between sensors the pattern of a pit of the wrong race led two of the proof's outer races (l056, l069) by 14 and 18,
    where the right race's lines stood 8 deviations out of control lines and the other's not at all. That of
    the `spared` says nothing."""
    strikers = _of_balls(evidence)
    if max(strikers.values(), default=0.0) < SURE:
        return dict(evidence)
    return {**evidence, **{n: value - MOST for n, value in strikers.items() if value < HEARD and n not in spared}}


def silent_beside(evidence: Mapping[str, float], spared: Collection[str]) -> frozenset[str]:
    """What balls would strike and is not heard at all, where they are heard elsewhere; `evidence` as it was heard. That
    of the `spared` says nothing."""
    strikers = _of_balls(evidence)
    if max(strikers.values(), default=0.0) < HEARD:
        return frozenset()
    return frozenset(name for name, value in strikers.items() if value < UNHEARD and name not in spared)


def _of_balls(evidence: Mapping[str, float]) -> dict[str, float]:
    """Evidence of what balls strike."""
    rolling = {t.key for t in REGISTRY if t.strikes is not None and t.strikes != "tooth"}
    return {name: value for name, value in evidence.items() if name.split("@")[0] in rolling}


def _counts(candidate: Candidate, rise: Rise, *, points: int, based: bool, teeth: bool) -> bool:
    """Whether what a family shows may be more than sound machines show, whose balls modulate too: without a baseline,
    where there is one operating point, from which nothing is seen to come back, and without teeth, where bearings
    rattle under a weight and say so at the lines of others, by how much those do."""
    asked = not based or ((points == 1 or not teeth) and candidate.family.kind in DEFECTS)
    least = MODELLED if teeth or points == 1 or not based else MODELLED_BARE
    return not asked or rise(candidate.family) >= least


def impulsive(tie: Ties) -> Ties:
    """Of what comes once a turn only impacts: unbalance and run-out modulate at the shaft's first two orders."""
    families = tuple(replace(f, lowest=IMPACTS_FROM) if f.kind == "turn" else f for f in tie.families)
    return replace(tie, families=families)


def reachable(data: Sequence[PointData], tie: Ties) -> bool:
    """Whether the sampling rate covers the envelope lines of all parts."""
    _, top = reach_of(tie.families)
    return bool(tie.families) and all(2 * top * d.spectra[0].speed_hz < d.spectra[0].rate_hz for d in data)


def observed_as(one: Steady, label: str, channels: Sequence[Channel], tie: Ties) -> Observation:
    """What the level `kinematics` sees of a recording whose angle is known."""
    recording = Recording(
        sampling_rate_hz=one.rate_hz,
        channels=tuple(channels),
        samples=one.samples,
        operating=Operating(shaft=tie.reference, speed_hz=one.speed_hz),
    )
    angle = np.asarray(2 * np.pi * one.speed_hz / one.rate_hz * np.arange(one.samples.shape[1]), dtype=np.float64)
    base, top = reach_of(tie.families)
    found = tuple(envelopes(recording, c.name, angle, highest_base=base, highest_order=top) for c in channels)
    return Observation(label=label, recording=recording, speed=one.estimate, doubt=DOUBT, channels=found)


def _score(candidate: Candidate | None) -> float:
    return candidate.z if candidate is not None and candidate.risen else 0.0


def _turn(every: Sequence[Candidate], shaft: str) -> float:
    return _score(next((c for c in every if c.family.kind == "turn" and c.family.site == shaft), None))


def _tooth(every: Sequence[Candidate], shaft: str, place: ToothPlace | None) -> float:
    """By impacts once a turn, or by the place in the mean turn, whichever says more."""
    impacts = _turn(every, shaft) ** 2 / (2 * SCATTER)
    return max(min(impacts, MOST_TURNS), place.evidence if place is not None else 0.0)


def _ball(every: Sequence[Candidate], tie: Ties, kind: str, site: str) -> float:
    """Of a defect that balls meet; bearings with the same lines share it."""
    family = next((f for f in tie.families if f.kind == kind and f.site == site), None)
    if family is None:
        return 0.0
    own = _score(next((c for c in every if c.family.kind == kind and same(c.family, family)), None))
    turn = 0.0
    if kind == "inner":
        shaft = next(s for s, ratio in tie.shafts.items() if abs(ratio - family.spacing) < 1e-9)
        turn = min(_turn(every, shaft), TURNS_SHARE * own)
    return (own**2 + turn**2) / (2 * SCATTER)
