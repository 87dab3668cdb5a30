"""A faulty tooth by the mean turn of its gear, heard by all channels and in all bands together, against a baseline.

Sidebands say that a shaft's turn is uneven and need many of them above the floor; a burst at one place of the turn is
told while each of them is below it (`reconcile.observe.whole_turn`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.kinematics.gears import GearEvidence
from reconcile.kinematics.lines import matched
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.turn_picture import turn_picture
from reconcile.kinematics.vague import TOOTH_TERMS, gear_report
from reconcile.observe.tooth_place import Look, ToothPlace, placed, window_of
from reconcile.observe.whole_turn import Turned, standing, whole_turns
from reconcile.report.score import LOG_EVIDENCE, LOG_GROWTH
from reconcile.verdict import Cause, NextExperiment, PlaceWeight, Report, Where

ALIKE = 1e-6
"""Relative difference of the turns of two gears below which they turn alike: nothing tells whose tooth it is."""
RISEN = 2.5
"""Growth of what comes back in a turn, over what noise makes, from which the turn is uneven in another way than it was.
In 73 cases of the proof the middle of the speeds grew by 5 to 45 where a shaft rattles in a clearance or a tooth is
broken or pitted, and by 1.2 at most elsewhere, cracked teeth among them. It counts only where sidebands of that shaft
have grown over the lines of the teeth."""


@dataclass(frozen=True, kw_only=True)
class ToothTurn:
    """What comes back in the turn of a gear: the `place` that stands out most, how far all of the turn has `grown` (the
    middle of the tests), and in how many `tests` with a baseline at their speed it could be told. `shown`: the test
    that shows the place best, and what its angles count from."""

    gear: str
    shaft: str
    place: ToothPlace
    grown: float
    tests: int
    shown: str = "the first sample"
    alike: tuple[str, ...] = ()
    """Other gears that turn as this one does."""
    picture: Mapping[str, object] = field(default_factory=dict)
    """Of its mean turn in that test and the baseline."""


def tooth_turns(tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties) -> tuple[ToothTurn, ...]:
    """Of every gear in a mesh, the one that stands out most first; none without a baseline."""
    pairs = [(test, base) for test in tests if (base := matched(test, baselines)) is not None]
    found = []
    for shaft, gear, teeth in _gears(ties) if pairs else ():
        points, grown, shown = [], [], []
        pictures: list[dict[str, object]] = []
        for test, base in pairs:
            names = tuple(n for n in test.recording.names if n in base.recording.names)
            each = [_turned(one, names, ties.shafts[shaft]) for one in (test, base)]
            if each[0] is None or each[1] is None:
                continue
            now, before = whole_turns(each[0], each[1], teeth=teeth)
            if now is not None and before is not None:
                start = _start(test, ties.shafts[shaft])
                speed = test.speed.speed_hz
                points.append(Look(standing=standing(now, before), turn=now, start_turns=start, speed_hz=speed))
                grown.append(now.level / max(before.level, 1.0))
                counted = f"{'the first pulse of the tacho' if _pulses(test) else 'the first sample'} of {test.label}"
                shown.append(counted)
                same = all(_by_pulses(one, ties.shafts[shaft], ties) for one in (test, base))
                pictures.append(
                    turn_picture(
                        *(now, before), gear=gear, shaft=shaft, start=counted, speed_hz=speed,
                        starts=(start, _start(base, ties.shafts[shaft])), same_start=same,
                    )
                )  # fmt: skip
        if points:
            middle = float(np.median(grown))
            best = int(np.argmax([look.standing for look in points]))
            place = placed(shaft, points)
            alike = tuple(
                g for s, g, _ in _gears(ties) if g != gear and abs(ties.shafts[s] / ties.shafts[shaft] - 1.0) < ALIKE
            )
            found.append(
                ToothTurn(
                    gear=gear,
                    shaft=shaft,
                    place=place,
                    grown=middle,
                    tests=len(points),
                    shown=shown[best],
                    alike=alike,
                    picture=pictures[best],
                )
            )
    return tuple(sorted(found, key=lambda one: -one.place.standing))


def _pulses(one: Observation) -> bool:
    return one.speed.method == "tacho"


def _by_pulses(one: Observation, ratio: float, ties: Ties) -> bool:
    """Whether a gear of the `ratio` stands at one angle at every pulse: only then two records count from the same."""
    tacho = one.recording.tacho
    if not _pulses(one) or tacho is None or tacho.shaft not in ties.shafts:
        return False
    a_pulse = ratio / ties.shafts[tacho.shaft] / tacho.pulses_per_revolution
    return round(a_pulse) >= 1 and abs(a_pulse / round(a_pulse) - 1.0) < ALIKE


def _start(one: Observation, ratio: float) -> float:
    """Angle, turns of the gear, at which its mean turn begins: with pulses from the first of them on, else 0."""
    channel = one.channels[0] if one.channels else None
    if channel is None or not _pulses(one):
        return 0.0
    known = channel.angle_rad[np.isfinite(channel.angle_rad)]
    return float(known[0] * ratio / (2 * np.pi)) % 1.0 if known.size else 0.0


def teeth_report(
    turns: Sequence[ToothTurn], gears: Sequence[GearEvidence], tests: Sequence[Observation]
) -> Report | None:
    """A tooth by its place in the turn; by the sidebands of its shaft where the turn can't be told."""
    if turns and turns[0].place.told:
        return tooth_report(turns[0])
    unknown = [g for g in gears if g.grown and not any(t.gear == g.gear for t in turns)]
    return gear_report(unknown, tests) if unknown else None


def with_sidebands(report: Report, turns: Sequence[ToothTurn], gears: Sequence[GearEvidence]) -> Report:
    """What sidebands and the turn say where no tooth stands out: no single tooth, but perhaps all of the turn."""
    causes = _teeth_last(report.causes, turns)
    last = {c.site: -i for i, c in enumerate(reversed(causes))}
    sites = tuple(sorted(report.where.sites, key=lambda w: (-w.weight, last.get(w.site, 1))))
    report = replace(report, causes=causes, where=replace(report.where, sites=sites))
    shafts = {g.shaft for g in gears if g.grown}
    uneven = max((t for t in turns if t.grown >= RISEN and t.shaft in shafts), key=lambda t: t.grown, default=None)
    grown = next((g for g in gears if g.grown), None)
    if uneven is not None and report.verdict in ("nothing_missing", "not_decidable"):
        return uneven_report(uneven)
    if grown is None or report.verdict == "unknown_physics":
        return report
    note = (
        f"why {grown.lines} sidebands of {grown.shaft} around {grown.mesh} grew by {grown.growth_db:.0f} dB: nothing "
        "comes back at one place of its turn, as it would at a faulty tooth; a speed or load that wanders may do so, "
        "or an angle that is not known well enough"
    )
    quiet = report.verdict == "nothing_missing"
    said = f" {note[0].upper()}{note[1:]} - that is not decided." if quiet else ""
    return replace(
        report,
        verdict="not_decidable" if quiet else report.verdict,
        sentence=f"{report.sentence}{said}",
        undecidable=(*report.undecidable, note),
    )


def _teeth_last(causes: Sequence[Cause], turns: Sequence[ToothTurn]) -> tuple[Cause, ...]:
    """Of what strikes once a turn the teeth of a gear last, where no place of its turn stands out."""
    sound = {t.gear for t in turns if not t.place.told}
    return tuple(sorted(causes, key=lambda c: c.term in TOOTH_TERMS and c.site in sound))


def uneven_report(found: ToothTurn) -> Report:
    """All of a turn is uneven in another way than before, no single tooth."""
    causes = (
        *(("unbalance", found.shaft), ("bent_shaft", found.shaft), ("rub", found.shaft)),
        *((term, found.gear) for term in ("pitch_error", *TOOTH_TERMS)),
    )
    return Report(
        verdict="ambiguous",
        sentence=f"Sidebands of {found.shaft} grew, and what comes back with each of its turns {found.grown:.1f} "
        "times, over more than one tooth: an unbalance or a bend that rattles in a clearance, a rub, or uneven or "
        f"several damaged teeth of {found.gear} are alike at this level.",
        level="kinematics",
        where=Where(sites=(PlaceWeight(site=found.shaft, weight=1.0),)),
        causes=tuple(
            Cause(
                term=term,
                site=site,
                score=float(np.log(found.grown)),
                score_unit=LOG_GROWTH,
                reasons=("the mean turn says that it repeats, not what; a model of the machine is needed to tell",),
            )
            for term, site in causes
        ),
        undecidable=("what comes back once a turn", "how large: a size can't be given without a model"),
        next_experiment=NextExperiment(
            sentence="Record at two further speeds: what is out of balance grows with speed, teeth hardly do."
        ),
        pictures=found.picture,
    )


def _gears(ties: Ties) -> list[tuple[str, str, tuple[int, ...]]]:
    """Shaft and name of every gear in a mesh, its teeth and those of the others on its shaft."""
    sides = {
        gears[side]: (shafts[side], round(order / ties.shafts[shafts[side]]))
        for _, order, shafts, gears in ties.meshes
        for side in (0, 1)
    }
    return [
        (shaft, gear, (teeth, *(z for name, (other, z) in sides.items() if other == shaft and name != gear)))
        for gear, (shaft, teeth) in sides.items()
    ]


def _turned(one: Observation, names: Sequence[str], ratio: float) -> Turned | None:
    channel = one.channel(names[0]) if names else None
    if channel is None:
        return None
    samples = np.array([one.recording.series(name).samples for name in names], dtype=np.float64)
    return Turned(samples=samples, turns=np.asarray(channel.angle_rad * (ratio / (2 * np.pi)), dtype=np.float64))


def tooth_report(found: ToothTurn) -> Report:
    """One tooth differs; how, a model of the mesh would have to tell."""
    turn = found.place.strongest
    assert turn is not None
    gears = (found.gear, *found.alike)
    window = window_of(turn, shaft=found.shaft, start_turns=found.place.start_turns)
    return Report(
        verdict="ambiguous",
        sentence=f"A local tooth fault on {' or '.join(gears)}: a burst comes back at one place of its turn "
        f"({turn.height:.1f} times the rest of the mean turn, {turn.turns} turns, over the baseline's), at "
        f"{window.centre_deg:.0f} degrees from {found.shown}; whether the tooth is broken, cracked or pitted can't be "
        "told without a model.",
        level="kinematics",
        where=Where(sites=tuple(PlaceWeight(site=g, weight=1.0 / len(gears)) for g in gears), angle_window=window),
        causes=tuple(
            Cause(
                term=term,
                site=gear,
                score=found.place.evidence,
                score_unit=LOG_EVIDENCE,
                reasons=("the mean turn says that one tooth differs, not how; a model of the mesh is needed to tell",),
            )
            for gear in gears
            for term in TOOTH_TERMS
        ),
        undecidable=(
            *((f"which of {' and '.join(gears)}, which turn alike",) if found.alike else ()),
            "broken, cracked or pitted: a model of the mesh is needed",
            "how large: a size can't be given without a model",
            f"whether it is a tooth of {found.gear}: a key, a rub or a loose part of {found.shaft} may do so too",
        ),
        next_experiment=NextExperiment(sentence="Add the gear data and loads to the machine to fit the tooth faults."),
        pictures=found.picture,
    )
