"""Answers where no bearing family stands: tooth faults, foreign orders, nothing at all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.answer import NO_BASELINE, SOUND_TOO, WITHOUT, lines_of
from reconcile.kinematics.candidate import ALONE_DEPTH, DEFECTS, Candidate
from reconcile.kinematics.foreign import Foreign
from reconcile.kinematics.gears import NEAR_DB, GearEvidence, of_own_lines
from reconcile.kinematics.lines import matched
from reconcile.kinematics.measured import measured_lines
from reconcile.kinematics.new_lines import LOUDER
from reconcile.kinematics.observe import Observation
from reconcile.verdict import Cause, LineChange, NextExperiment, PlaceWeight, Report, Where

TOOTH_TERMS = ("tooth_crack", "tooth_spall", "missing_tooth")

SHAFTS_UNJUDGED = "what a shaft does (unbalance, a bend, looseness) is not judged without a baseline"


def gear_report(found: Sequence[GearEvidence], tests: Sequence[Observation]) -> Report:
    """Sidebands of a gear's shaft grew around its mesh."""
    first = found[0]
    near = [g for g in found if g.grown and g.mesh == first.mesh and first.growth_db - g.growth_db < NEAR_DB]
    first, *more = of_own_lines(near)
    # gears of one shaft turn together: sidebands say which shaft, not which mesh
    tied = [first, *more, *(g for g in found if g.grown and g.mesh != first.mesh and g.shaft == first.shaft)]
    twins = sorted({g.gear for g in found if g.shaft == first.shaft} - {g.gear for g in tied})
    other = (f"whether it is {' or '.join(twins)}, which turns with {first.gear}",) if twins else ()
    speed = next(t.speed.speed_hz for t in tests if t.label == first.label)
    total = sum(g.growth_db for g in tied)
    where = " or ".join(g.gear for g in tied)
    causes = tuple(
        Cause(
            term=term,
            site=g.gear,
            score=g.growth_db / g.error_db,
            reasons=("sidebands say that one tooth differs, not how; a model of the mesh is needed to tell",),
            values={"sideband_growth_db": g.growth_db, "mesh_growth_db": g.mesh_growth_db},
        )
        for g in tied
        for term in TOOTH_TERMS
    )
    return Report(
        verdict="ambiguous",
        sentence=f"A local tooth fault on {where}: {first.lines} sidebands of its shaft around {first.mesh} grew by "
        f"{first.growth_db:.0f} dB against it (the mesh itself {first.mesh_growth_db:+.0f} dB), most on "
        f"{first.channel}; whether the tooth is broken, cracked or pitted can't be told without a model.",
        level="kinematics",
        where=Where(
            sites=tuple(PlaceWeight(site=g.gear, weight=g.growth_db / total) for g in tied),
            lines=tuple(
                LineChange(
                    label=f"sidebands of {g.shaft} around {g.mesh}",
                    frequency_hz=speed,
                    change_db=g.growth_db,
                    channel=g.channel,
                    locked_to=g.shaft,
                    speed_hz=speed,
                )
                for g in tied
            ),
            angle_window=first.window,
        ),
        causes=tuple(sorted(causes, key=lambda c: -c.score)),
        undecidable=(
            *other,
            "broken, cracked or pitted: a model of the mesh is needed",
            "how large: a size can't be given without a model",
        ),
        next_experiment=NextExperiment(sentence="Add the gear data and loads to the machine to fit the tooth faults."),
    )


def foreign_report(found: Foreign, tests: Sequence[Observation], baselines: Sequence[Observation]) -> Report:
    """Periodic impacts at an order of no part."""
    e = found.evidence
    wanted = [(f"{k} x order {found.order:.4g}", k * found.order) for k in (1, 2, 3)]
    return Report(
        verdict="unknown_physics",
        sentence=f"Impacts {found.order:.4g} times a turn in {e.band_hz[0]:.0f}-{e.band_hz[1]:.0f} Hz of {e.channel}, "
        f"{found.growth_db:.0f} dB deeper than in the baseline: no part of the specification has that order.",
        level="kinematics",
        where=Where(lines=measured_lines(wanted, e.channel, e.band_hz, tests[0], baselines)),
        undecidable=("which part it is: a bearing or gear that the specification lacks, or other sizes",),
        next_experiment=NextExperiment(sentence="Check the bearing sizes and teeth of the specification."),
    )


LOUDER_DB = 15.0
"""Growth of a channel's level from which a machine is not called sound: of the real controls (docs/proof-real.md) a
gear under full load against none is 3 dB louder."""
IN_BOTH = "deep in both"
SCALE = "unit, sensitivity or scale (a wav file holds shares of its full scale)"
BEFORE_TOO = "a defect of the baseline too, or how this bearing sounds when it is sound"
FULLER = (
    "Describe the whole machine (masses, stiffnesses, loads): looseness, clearances and shapes show in levels only."
)


def nothing_report(
    every: Sequence[Candidate],
    old: Sequence[Candidate],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
) -> Report:
    """No family is more than a sound machine shows; without a baseline clear lines that sound ones have too are open.

    `old`: defects that the baselines have as well.
    """
    shallow = [c for c in every if c.present and c.family.kind in DEFECTS]
    lines = tuple(line for c in shallow for line in lines_of(c, tests, baselines, 1))
    if not baselines:
        knocking = [c for c in every if c.family.kind == "turn" and c.present and c.risen]
        if shallow or knocking:
            return _without_baseline(shallow, knocking, tests, lines)
    against = "than in the baseline" if baselines else f"than sound bearings show; {SHAFTS_UNJUDGED}"
    louder = loudest(tests, baselines)
    if louder is not None:
        return _louder(louder, lines, old)
    quieter = _quieter_db(tests, baselines)
    if quieter is not None:
        return _quieter(quieter, lines, old)
    return Report(
        verdict="nothing_missing",
        sentence=f"No family of lines is firmer {against}; changes of level may be load, speed or mounting, or an "
        "effect that only a machine that can be simulated tells." + _in_both(old),
        level="kinematics",
        where=Where(lines=lines),
        undecidable=("changes of level",) if baselines else (f"changes of level: {NO_BASELINE}",),
        next_experiment=NextExperiment(sentence=FULLER),
    )


def loudest(tests: Sequence[Observation], baselines: Sequence[Observation]) -> tuple[str, float] | None:
    """Channel and growth, dB, of the one whose level has grown most, where that is more than load and mounting do."""
    most = max(_grown_db(tests, baselines), key=lambda one: one[1], default=None)
    return most if most is not None and most[1] > LOUDER_DB else None


def _quieter_db(tests: Sequence[Observation], baselines: Sequence[Observation]) -> float | None:
    """By how many decibels the channel that fell least fell, where all fell by more than load and mounting do."""
    least = max((db for _, db in _grown_db(tests, baselines)), default=0.0)
    return -least if least < -LOUDER_DB else None


def _grown_db(tests: Sequence[Observation], baselines: Sequence[Observation]) -> list[tuple[str, float]]:
    """Growth of the level of each channel of each test over the nearest baseline, dB."""
    found = []
    for test in tests:
        base = matched(test, baselines)
        for name in test.recording.names if base is not None else ():
            if base is None or name not in base.recording.names:
                continue
            now, before = (float(np.std(x.recording.series(name).samples)) for x in (test, base))
            if now > 0.0 and before > 0.0:
                found.append((name, 20.0 * float(np.log10(now / before))))
    return found


def _quieter(fallen_db: float, lines: tuple[LineChange, ...], old: Sequence[Candidate]) -> Report:
    """No machine that has got worse: more likely is that the baseline is not the sound one."""
    return Report(
        verdict="not_decidable",
        sentence=f"Every channel is {fallen_db:.0f} dB quieter than in the baseline, or more, and no family of lines "
        f"is firmer: test and baseline may be exchanged, or a {SCALE} is wrong; load, speed or mounting seldom do so "
        "much." + _in_both(old),
        level="kinematics",
        where=Where(lines=lines),
        undecidable=(f"what was {fallen_db:.0f} dB louder when the baseline was recorded",),
        next_experiment=NextExperiment(
            sentence=f"Check which recording is of the sound machine, and every channel's {SCALE}."
        ),
    )


def _louder(most: tuple[str, float], lines: tuple[LineChange, ...], old: Sequence[Candidate]) -> Report:
    """What grew so far is no sound machine under another load, and no part of the drawing: which may be wrong."""
    channel, growth = most
    return Report(
        verdict="not_decidable",
        sentence=f"{channel} is {growth:.0f} dB {LOUDER} of the "
        "specification is firmer: load, speed or mounting seldom do so much; a bearing or gear of other numbers "
        "strikes at other orders, and some effects only a machine that can be simulated tells." + _in_both(old),
        level="kinematics",
        where=Where(lines=lines),
        undecidable=(f"what made {channel} {growth:.0f} dB louder",),
        next_experiment=NextExperiment(sentence=f"Check the bearing sizes and teeth of the specification. {FULLER}"),
    )


def _in_both(old: Sequence[Candidate]) -> str:
    if not old:
        return ""
    which = ", ".join(c.family.key for c in old)
    return f" But {which} is {IN_BOTH}: {BEFORE_TOO}."


def _without_baseline(
    shallow: Sequence[Candidate],
    knocking: Sequence[Candidate],
    tests: Sequence[Observation],
    lines: tuple[LineChange, ...],
) -> Report:
    """Lines that a sound machine may have made: only a baseline tells whether it did. A measured gearbox without a
    fault knocks once a turn of its input at each of four loads, 20 to 25 deviations over orders of no part."""
    said, undecidable = [], []
    deep = [c for c in shallow if c.deepest >= ALONE_DEPTH]
    faint = [c for c in shallow if c not in deep]
    if faint:
        keys = ", ".join(c.family.key for c in faint)
        said.append(f"Lines of {keys} are there but shallow, as sound bearings show them too")
        undecidable.append("whether shallow lines are a young defect or the bearing as made")
    struck = [c for c in deep if any(c.strikes(i) for i in range(len(c.evidence)))]
    smooth = [c for c in deep if c not in struck]
    if smooth:
        keys = ", ".join(c.family.key for c in smooth)
        said.append(
            f"Lines of {keys} are deep, but nothing strikes: balls that pass in a sound bearing may make such too"
        )
        undecidable.append("whether lines without blows are a defect or the bearing as made")
    if struck:
        keys = ", ".join(c.family.key for c in struck)
        said.append(f"Lines of {keys} are there, no deeper than other blows of the machine may leave them")
        undecidable.append(f"whether lines of {keys} are a defect's or what other blows leave there")
    if knocking:
        shafts = " and of ".join(c.family.site for c in knocking)
        said.append(f"Impacts once a turn of {shafts} are there, as sound gears, couplings and keys make them too")
    for c in knocking:
        undecidable.append(
            f"whether impacts once a turn of {c.family.site} ({c.best.band_hz[0]:.0f}-{c.best.band_hz[1]:.0f} Hz of "
            f"{c.best.channel}, {c.z:.0f} deviations) are a damaged tooth, a rub, a loose part, or the machine as made"
        )
        lines = (*lines, *lines_of(c, tests, (), 1))
    return Report(
        verdict="not_decidable",
        sentence=f"{'; '.join(said)}; {WITHOUT} it can't be told whether anything is missing.",
        level="kinematics",
        where=Where(lines=lines),
        undecidable=tuple(undecidable),
        next_experiment=SOUND_TOO,
    )
