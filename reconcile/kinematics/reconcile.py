"""Reconcile a machine of which only the kinematics are known."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

from reconcile.gate.whole import whole_stretches
from reconcile.kinematics.answer import defect_report
from reconcile.kinematics.apart import with_speeds
from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.doubted import against_rivals, factor_of, restated, unconfirmed
from reconcile.kinematics.either import other_kind, with_other_kind
from reconcile.kinematics.elsewhere import left_out, told_elsewhere, turned_elsewhere, without
from reconcile.kinematics.ends import with_ends
from reconcile.kinematics.extent import Extent
from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.finish import fault_report, finished, refused_report
from reconcile.kinematics.gated import gated
from reconcile.kinematics.gears import gear_evidence
from reconcile.kinematics.good_runs import heard_gate
from reconcile.kinematics.grown import grown_defect, old_defects
from reconcile.kinematics.mains import electric, named_but_supply, told_beside
from reconcile.kinematics.new_lines import with_new_lines
from reconcile.kinematics.none_left import with_none_left
from reconcile.kinematics.observe import Observation, observe
from reconcile.kinematics.other_speeds import by_baseline, nominees
from reconcile.kinematics.remarks import if_heard, remarked, with_rest
from reconcile.kinematics.series import shaft_series, with_short
from reconcile.kinematics.shafts import shaft_changes
from reconcile.kinematics.shifted import with_shifted
from reconcile.kinematics.slowest import longer, with_slowest
from reconcile.kinematics.spec import KinematicSpec, of_machine
from reconcile.kinematics.struck import cut_alike, without_struck
from reconcile.kinematics.teeth import other_teeth, teeth_by_far, told_with, with_teeth
from reconcile.kinematics.tooth_turn import teeth_report, tooth_turns, with_sidebands
from reconcile.kinematics.turning import with_turn
from reconcile.kinematics.unheard import with_lost
from reconcile.kinematics.unplaced import with_risen, with_unplaced
from reconcile.kinematics.unread import ALIKE_Z, Judged
from reconcile.kinematics.whose_speed import of_one_shaft, usual_speeds
from reconcile.kinematics.without_part import without_a_part
from reconcile.origin import origin
from reconcile.report.action import EXCHANGED
from reconcile.told import about
from reconcile.verdict import Report
from signals.recording import Recording
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

FEW_TURNS = 20.0


Progress = Callable[[float, str], None]
GATE, FEATURES, LINES, SPEEDS, HELD_OUT = 0.4, 0.5, 0.6, 0.8, 0.9
"""Shares of the work at which stages begin (recordings of 0.1 million samples); a held speed is judged before."""


def _silent(share: float, stage: str) -> None:
    pass


def reconcile_kinematics(
    spec: KinematicSpec | MachineSpec,
    tests: Sequence[Recording],
    baselines: Sequence[Recording],
    *,
    seed: int,
    progress: Progress = _silent,
) -> Report:
    """What the tests have that the kinematics (and the baselines) do not explain.

    `progress` is told the share that is done and what comes next.

    The sensor gate comes first; a measurement fault is the answer if the cleaned recordings show nothing missing.
    Without baselines only what sound machines never show is named: bearing lines of a depth that none reached, and no
    impacts once a turn. Sizes are given only where the signal itself measures them.
    """
    started = time.process_time()
    report = _reconciled(spec, tests, baselines, seed, progress)
    provenance = {**origin(seed, time.process_time() - started), "level": "kinematics"}
    return replace(report, provenance=provenance)


def _reconciled(
    spec: KinematicSpec | MachineSpec,
    tests: Sequence[Recording],
    baselines: Sequence[Recording],
    seed: int,
    progress: Progress,
    corrected: bool = False,
) -> Report:
    progress(GATE, "sensor gate")
    known = of_machine(spec) if isinstance(spec, MachineSpec) else spec
    operating = tests[0].operating if tests else None
    tie = ties(known, operating.shaft if operating else None)
    tests, baselines = of_one_shaft(tests, tie), of_one_shaft(baselines, tie)
    stated = usual_speeds(known).get(tie.reference)
    gate, whole_tests, whole_baselines, cut = heard_gate(
        tests, baselines, lambda now, past: with_slowest(gated(now, past, tie, seed), tie), stated
    )
    if not gate.usable:
        return finished(fault_report(gate), gate, (), ())
    whole = whole_stretches(gate, whole_tests, whole_baselines, stated)
    gate = cut_alike(whole.gate)
    if not gate.usable:
        return finished(fault_report(gate), gate, (), ())
    progress(FEATURES, "speed and features")
    try:
        seen = _observed(gate.tests, "test", tie, stated, seed)
        past = _observed(gate.baselines, "baseline", tie, stated, seed)
    except SpecError as error:
        again = longer((*gate.tests, *gate.baselines), tie, stated)
        return finished(refused_report(error, again), gate, (), ())
    wrong = None if corrected else other_teeth(known, tie.reference, (*seen, *past))
    if wrong is not None:
        return told_with(_reconciled(with_teeth(known, wrong), tests, baselines, seed, _silent, True), wrong)
    gate, seen, past = without(gate, seen, past, with_lost(gate, whole.lost))
    far = turned_elsewhere((*seen, *past), tie, seed)
    wrong = None if corrected else teeth_by_far(known, tie.reference, (*seen, *past), far)
    if wrong is not None:
        return told_with(_reconciled(with_teeth(known, wrong), tests, baselines, seed, _silent, True), wrong)
    gate, seen, past, told = left_out(gate, seen, past, far)
    progress(LINES, "lines of bearings, teeth and shafts")
    first, every = _judged(known, tie, seen, past, seed)
    progress(SPEEDS, "other speeds")
    here, recordings = Judged(report=first, every=every), ((gate.tests, seen), (gate.baselines, past))
    elsewhere = told_elsewhere(here, seen, far, partial(_at_speeds, known, tie, *recordings, seed), past)
    at = partial(_at_rival, known, tie, *recordings, seed)
    report = elsewhere or against_rivals(here, seen, tie, at, stated, _other_speeds(here, seen, past, tie, seed))
    if report.sentence == first.sentence:  # else the speed is doubted already
        report = with_speeds(report, seen, past)
    progress(HELD_OUT, "held-out data")
    if report.verdict != "measurement_fault":
        report = with_risen(with_unplaced(remarked(report, tie, seen, past, every, seed), tie, seen), every, seen)
        report = if_heard(report, seen, past)
    gate, came = without_struck(gate, seen, every)
    report = with_ends(with_shifted(report, gate, came, past), gate, every, came, past, tie)
    report = with_none_left(report, given=bool(baselines), left=bool(past))
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, *told, *cut, *whole.told)))
    quiet = report.verdict in ("nothing_missing", "not_decidable") and EXCHANGED not in report.sentence
    report = with_new_lines(report, gate, seen, past, tie)
    report = fault_report(gate, report) if quiet and gate.fault is not None else report
    return finished(report, gate, seen, every, past)


def _observed(
    several: Sequence[Recording], kind: str, tie: Ties, stated_hz: float | None, seed: int
) -> list[Observation]:
    """Each recording; SpecError says which one cannot be read."""
    found = []
    for i, one in enumerate(several, 1):
        label = f"{kind} {i}"
        with about(one.label or label):
            found.append(observe(one, tie, label, stated_hz=stated_hz, seed=seed))
    return found


def _judged(
    known: KinematicSpec, tie: Ties, tests: list[Observation], baselines: list[Observation], seed: int
) -> tuple[Report, tuple[Candidate, ...]]:
    """The first answer that stands: bearing defects, teeth, impacts of a turn, a foreign order, impacts, shafts."""
    chosen, every, supply = named_but_supply(tests, baselines, tie, seed)
    gears = gear_evidence(tests, baselines, tie)
    changes = shaft_changes(tests, baselines, tie)
    series = shaft_series(tests, baselines, tie)
    grown = tuple(c for c in changes if c.grown)
    if chosen:
        told = defect_report(chosen, tests, baselines, tie, seed)
        rival = other_kind(chosen[0], every) if len(chosen) == 1 else None
        told = told if rival is None else with_other_kind(told, chosen[0], rival)
        told = with_turn(told, chosen, every, tie, based=bool(baselines))
        report = with_rest(told, gears, grown, tests, series)
    elif (growth := grown_defect(old_defects(every), tests, baselines, tie)) is not None:
        report = _regrown(growth, tests, baselines, tie, seed)
    else:
        turns = tooth_turns(tests, baselines, tie)
        teeth = teeth_report(turns, gears, tests)
        others = teeth or without_a_part(known, tie, tests, baselines, every, supply, grown, seed, series)
        report = others if teeth is not None else with_sidebands(others, turns, gears)
    rare = [f"{c.multiple:g} x {c.shaft} grew by {c.growth_db:.0f} dB in {c.label}" for c in changes if c.seldom]
    rare += [f"sidebands of {g.shaft} around {g.mesh} by {g.growth_db:.0f} dB in {g.label}" for g in gears if g.seldom]
    report = with_short(report, tests, baselines, tie)
    if rare:
        report = replace(
            report, undecidable=(*report.undecidable, f"at fewer than half of the speeds: {', '.join(rare)}")
        )
    return told_beside(report, electric(supply, False)), every


def _at_rival(
    known: KinematicSpec,
    tie: Ties,
    tests: tuple[Sequence[Recording], Sequence[Observation]],
    baselines: tuple[Sequence[Recording], Sequence[Observation]],
    seed: int,
    factor: float,
    firmly: bool,
) -> Judged | None:
    """The answer at `factor` times the speed of the recordings whose lines allow that (`firmly`: of all without
    pulses); None if they can't carry it."""
    several = (*tests[1], *baselines[1])
    speeds = {o.label: factor * o.speed.speed_hz for o in several if _allows(o, tie, factor, firmly)}
    return _at_speeds(known, tie, tests, baselines, seed, speeds)


def _at_speeds(
    known: KinematicSpec,
    tie: Ties,
    tests: tuple[Sequence[Recording], Sequence[Observation]],
    baselines: tuple[Sequence[Recording], Sequence[Observation]],
    seed: int,
    speeds_hz: Mapping[str, float],
) -> Judged | None:
    """The answer where each recording that `speeds_hz` has by its label turned as fast as there; None if they can't
    carry it."""
    again = [
        [
            restated(r, o, speeds_hz[o.label] / o.speed.speed_hz) if o.label in speeds_hz else r
            for r, o in zip(*several, strict=True)
        ]
        for several in (tests, baselines)
    ]
    try:
        seen = _observed(again[0], "test", tie, None, seed)
        past = _observed(again[1], "baseline", tie, None, seed)
    except SpecError:
        return None
    report, every = _judged(known, tie, seen, past, seed)
    return Judged(report=report, every=every)


def _other_speeds(
    here: Judged, tests: Sequence[Observation], baselines: Sequence[Observation], tie: Ties, seed: int
) -> list[float] | None:
    """Factors of the speed at which other parts are as firm; None where pulses, lines or a baseline tell the speed."""
    if not unconfirmed(tests) or by_baseline(tests, baselines):
        return None
    if min(t.recording.duration_s * t.speed.speed_hz for t in tests) < FEW_TURNS:
        return []  # so short a record has lines of some part at some speed
    return [n.factor for n in nominees(tests, tie, max(here.z, here.heard_z) - 2 * ALIKE_Z, seed)]


def _allows(seen: Observation, tie: Ties, factor: float, firmly: bool) -> bool:
    return seen.speed.method == "stated" or factor_of(seen, tie) == factor or (firmly and seen.speed.method != "tacho")


def _regrown(
    growth: tuple[Candidate, Extent, Extent],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    tie: Ties,
    seed: int,
) -> Report:
    """A defect of the baseline that has become longer."""
    candidate, now, before = growth
    report = defect_report((candidate,), tests, baselines, tie, seed)
    was = f"{before.degrees:.1f}" if before.resolved else f"less than {before.high_deg:.1f}"
    sentence = f"{report.sentence} The baseline has this defect too; it grew from {was} to {now.degrees:.1f} degrees."
    return replace(report, sentence=sentence)
