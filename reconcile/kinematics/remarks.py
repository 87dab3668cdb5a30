"""What a reader must know beside an answer: lines that rose too, a speed that nothing confirms, a deeper baseline."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace

from reconcile.kinematics.candidate import DEFECTS, LEAST_Z, Candidate
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.gears import GearEvidence, gear_evidence
from reconcile.kinematics.judge import SECOND_SHARE, named, one_line, same
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.series import ShaftSeries
from reconcile.kinematics.shafts import ShaftChange
from reconcile.kinematics.unheard import deaf_limits, line_strength
from reconcile.kinematics.vague import BEFORE_TOO, IN_BOTH
from reconcile.report.action import BESIDE_BEARING, EXCHANGED, STRIKES
from reconcile.verdict import LineChange, NextExperiment, Report
from sim.terms import REGISTRY

WHICH = NextExperiment(sentence="Check which recording is of the sound machine.")
UNHEARD = (
    "Nothing stands out of noise on any channel, no line of the spectrum nor of the envelope: the machine was not "
    "heard, so nothing can be said of it."
)
WHAT = "anything about the machine: no line of it was heard"
LISTEN = NextExperiment(sentence="Check the sensors, their range and their mounting, and that the machine turned.")
CHANGED = ("ambiguous", "unknown_physics")
RACES = ("outer", "inner")
MODULATING = {"turn": "the turn", "cage": "the cage"}
"""What modulates a damaged part of a bearing, in words."""
ONLY_MODULATES = "more than what modulates a damaged bearing, as its shaft and cage do"
ANOTHER = "of another defect: no part of the named bearing turns so"
SAME_TURN = 1e-3
"""Relative difference of two orders that are one to the data."""
SAME_SPEED = 0.015
"""Relative difference of a baseline's speed up to which depths of modulation are compared without a word."""


def remarked(
    report: Report,
    tie: Ties,
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    every: Sequence[Candidate],
    seed: int,
) -> Report:
    """The report with these remarks: what may be a second defect is undecidable, the rest are limits. A baseline with
    lines that the tests have not makes no machine sound."""
    limits = [*_speeds_differ(tests, baselines)]
    if report.verdict == "nothing_missing":
        limits += _unconfirmed(tests)
    deeper = _deeper_before(report, tie, tests, baselines, every, seed)
    limits += deeper
    said = [*deeper, *_in_both_too(report, every)]
    if deeper and report.verdict == "nothing_missing":
        report = replace(report, verdict="not_decidable", next_experiment=WHICH)
    return replace(
        report,
        sentence=" ".join([_but_for(report.sentence, deeper), *(f"But {text}." for text in said)]),
        undecidable=(*report.undecidable, *_risen_too(report, every), *_modulating(report, every)),
        where=replace(report.where, limits=(*report.where.limits, *limits)),
    )


def _but_for(sentence: str, deeper: Sequence[str]) -> str:
    """The sentence without what it says to be deep in both, where the baseline alone turns out to have it."""
    for said in re.findall(rf" But ([^,]*) is {IN_BOTH}: {BEFORE_TOO}\.", sentence):
        if any(text.startswith(f"the baseline has deep lines of {said} that") for text in deeper):
            sentence = sentence.replace(f" But {said} is {IN_BOTH}: {BEFORE_TOO}.", "")
    return sentence


def if_heard(report: Report, tests: Sequence[Observation], baselines: Sequence[Observation]) -> Report:
    """The report; of a machine that no channel heard, where no baseline says what there is to hear, no sound one;
    with a limit for each channel that did not."""
    if baselines:
        return report
    if report.verdict != "nothing_missing" or any(_heard(t) for t in tests):
        deaf = deaf_limits([t.recording for t in tests], [t.label for t in tests])
        return replace(report, where=replace(report.where, limits=(*report.where.limits, *deaf)))
    return replace(report, verdict="not_decidable", sentence=UNHEARD, undecidable=(WHAT,), next_experiment=LISTEN)


def _heard(test: Observation) -> bool:
    """Whether any channel that hears the machine, no force that drives it, holds a line."""
    channels = test.recording.channels
    moved = [c.name for c in channels if c.quantity != "force"] or [c.name for c in channels]
    rate = test.recording.sampling_rate_hz
    return any(line_strength(test.recording.series(name).samples, rate) >= 1.0 for name in moved)


def _risen_too(report: Report, every: Sequence[Candidate]) -> list[str]:
    """Families half as firm as the named ones, which are neither named nor theirs; lines of two defects hide each
    other among the control orders, so their chances are not asked."""
    if report.verdict != "explained":
        return []
    spoken = [c for c in every if any(_is(c.family, x.term, x.site) for x in report.causes if x.named)]
    if not spoken:
        return []
    least = max(LEAST_Z, SECOND_SHARE * max(c.z for c in spoken))
    return [
        f"lines of {c.family.key} rose too ({_by(c)}): a second defect, or what the named one brings"
        for c in every
        if c.family.kind in DEFECTS
        and c.risen
        and not c.of_turn
        and c.z >= least
        and not any(
            c is s or one_line(c, s) or (c.family.kind == s.family.kind and same(c.family, s.family)) for s in spoken
        )
    ]


def _modulating(report: Report, every: Sequence[Candidate]) -> list[str]:
    """Turns and cages that are there and have risen beside named bearings, of which the answer does not speak yet: a
    load that turns and balls that differ modulate what a damaged part shows, so their own are no second name; those of
    another shaft or bearing modulate nothing of it."""
    if report.verdict != "explained":
        return []
    told: dict[tuple[str, float], Candidate] = {}
    for c in every:
        if c.family.kind not in MODULATING or not (c.present and c.risen):
            continue
        struck = f"{STRIKES} {c.family.site}{BESIDE_BEARING}"
        if c.family.kind == "turn" and any(text.startswith(struck) for text in report.undecidable):
            continue
        told.setdefault((c.family.kind, c.family.order), c)  # equal cages have one line
    own = _turning_with({c.site for c in report.causes if c.named}, every)
    alike = [c for c in told.values() if any(c.family.kind == f.kind and _as_fast(c.family, f) for f in own)]
    strange = [c for c in told.values() if c not in alike]
    return [*_rose_too(alike, ONLY_MODULATES), *_rose_too(strange, ANOTHER)]


def _turning_with(sites: set[str], every: Sequence[Candidate]) -> list[Family]:
    """Turn and cage of each bearing, as families; what modulates its inner race is the turn of its shaft."""
    here = [c.family for c in every if c.family.site in sites]
    turns = [replace(f, kind="turn", order=f.spacing) for f in here if f.kind == "inner"]
    return [*turns, *(f for f in here if f.kind == "cage")]


def _as_fast(one: Family, other: Family) -> bool:
    return abs(one.order / other.order - 1.0) <= SAME_TURN


def _rose_too(several: Sequence[Candidate], what: str) -> list[str]:
    if not several:
        return []
    parts = " and ".join(f"{MODULATING[c.family.kind]} of {c.family.site} ({_by(c)})" for c in several)
    return [f"whether {parts}, which rose too, {'is' if len(several) == 1 else 'are'} {what}"]


def _is(family: Family, key: str, site: str) -> bool:
    term = REGISTRY.get(key)
    return term is not None and term.strikes == family.kind and site == family.site


def _by(candidate: Candidate) -> str:
    growth = candidate.growth_db
    return f"{candidate.z:.1f} deviations" if growth is None else f"by {growth:.0f} dB, {candidate.z:.1f} deviations"


def _unconfirmed(tests: Sequence[Observation]) -> list[str]:
    stated = sorted({t.speed.speed_hz for t in tests if t.speed.method == "stated"})
    if len([t for t in tests if t.speed.method == "stated"]) < len(tests):
        return []
    told = ", ".join(f"{hz:.4g}" for hz in stated)
    return [
        f"no line confirms the stated speed ({told} Hz): if it is wrong, or nothing was heard, nothing could be seen"
    ]


def _in_both_too(report: Report, every: Sequence[Candidate]) -> list[str]:
    """Races that are deep in the tests and no deeper than in the baseline, where the answer does not tell them yet."""
    if report.verdict not in CHANGED or IN_BOTH in report.sentence:
        return []
    old = [c for c in every if c.family.kind in RACES and c.present and c.based and not c.risen and c.deep]
    keys = [c.family.key for c in old if c.family.key not in report.sentence]
    return [f"{', '.join(keys)} {'are' if len(keys) > 1 else 'is'} {IN_BOTH}: {BEFORE_TOO}"] if keys else []


def _deeper_before(
    report: Report,
    tie: Ties,
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    every: Sequence[Candidate],
    seed: int,
) -> list[str]:
    """A defect of the baseline that the tests have not; beside another answer also one that is told by itself, though
    the tests are noisy enough there to hide how much less they have."""
    if not baselines or report.verdict == "measurement_fault":
        return []
    chosen, own = named(baselines, tests, tie, seed)
    here = {c.family.key for c in every if c.present}
    alone = [c for c in own if c.family.kind in RACES and c.present and c.by_itself and c.family.key not in here]
    more = [*chosen, *(c for c in alone if c not in chosen and report.verdict != "nothing_missing")]
    less = [(c.family.key, c.growth_db) for c in more if not _told(c, report, every)]
    gears = [f"{g.gear}'s turn around {g.mesh}" for g in gear_evidence(baselines, tests, tie) if g.grown]
    rows = [
        *(f"{key} that the tests have not{'' if db is None else f', or {db:.0f} dB less'}" for key, db in less),
        *(f"{gear} that the tests have not" for gear in gears if report.verdict == "nothing_missing"),
    ]
    return [f"the baseline has deep lines of {row}; {EXCHANGED}" for row in rows[:1]]


def _told(one: Candidate, report: Report, every: Sequence[Candidate]) -> bool:
    """Whether the answer speaks of this part, or of one with the same lines."""
    kind = one.family.kind
    if any(_is(one.family, x.term, x.site) for x in report.causes):
        return True
    spoken = [c.family for c in every if any(_is(c.family, x.term, x.site) for x in report.causes)]
    return any(kind == f.kind and same(one.family, f) for f in spoken)


def _speeds_differ(tests: Sequence[Observation], baselines: Sequence[Observation]) -> list[str]:
    """Tests without a baseline at their speed."""
    known = [b.speed.speed_hz for b in baselines]
    lost = sorted(
        {t.speed.speed_hz for t in tests if not any(abs(hz / t.speed.speed_hz - 1.0) <= SAME_SPEED for hz in known)}
    )
    if not known or not lost:
        return []
    told, had = (", ".join(f"{hz:.4g}" for hz in sorted(set(values))) for values in (lost, known))
    return [f"tests at {told} Hz were compared with baselines at {had} Hz: depths change with the speed too"]


def with_rest(
    report: Report,
    gears: Sequence[GearEvidence],
    grown: Sequence[ShaftChange],
    tests: Sequence[Observation],
    series: Sequence[ShaftSeries],
) -> Report:
    """What changed besides the named defects is told, not explained by them."""
    rest = [f"{c.multiple:g} x {c.shaft} grew by {c.growth_db:.0f} dB" for c in grown]
    rest += [f"sidebands of {g.shaft} around {g.mesh} grew by {g.growth_db:.0f} dB" for g in gears if g.grown]
    rest += [
        f"{len(one.multiples)} multiples of {one.shaft} {'and halves ' if one.halves else ''}grew by "
        f"{one.middle_db:.0f} dB"
        for one in series
    ]
    if not rest:
        return report
    lines = tuple(
        LineChange(
            label=f"{c.multiple:g} x {c.shaft}",
            frequency_hz=c.order * next(t.speed.speed_hz for t in tests if t.label == c.label),
            change_db=c.growth_db,
            channel=c.channel,
            locked_to=c.shaft,
            speed_hz=next(t.speed.speed_hz for t in tests if t.label == c.label),
        )
        for c in grown
    )
    note = f"not explained by the defect: {', '.join(rest)} (load, unbalance or another mounting)"
    return replace(
        report,
        undecidable=(*report.undecidable, note),
        where=replace(report.where, lines=(*report.where.lines, *lines)),
    )
