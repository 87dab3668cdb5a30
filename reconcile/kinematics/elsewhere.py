"""Recordings whose lines are those of a shaft at a speed far from the one that their description states.

Every order hangs on the stated speed, so nothing is named by it there. Such a test is left out where others remain,
and so is such a baseline; of tests alone the report says at which speed the lines stand, what the recordings show at
that speed, and that the description must be put right.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace

from reconcile.gate import Gate
from reconcile.gate.far import far_speeds
from reconcile.kinematics.doubted import CLEAR_Z
from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.unread import Judged, at_either, placed
from reconcile.speed.elsewhere import Elsewhere
from reconcile.verdict import NextExperiment, Report, SensorFault

QUIET = ("nothing_missing", "not_decidable")
ADVICE = NextExperiment(
    sentence="Correct the speed that the description states, or give a tacho; if another machine makes these lines, "
    "record with it off."
)
SHARED = NextExperiment(
    sentence="Correct the speed that the descriptions state, or give a tacho. Tests and baselines are wrong by one "
    "factor: check whether it is the speed of another shaft, the ratios of the machine file, and the sampling rate."
)
ONE_FACTOR = 0.03
"""Relative difference up to which labels are wrong by one factor."""


def turned_elsewhere(several: Sequence[Observation], tie: Ties, seed: int) -> dict[str, Elsewhere]:
    """By label, of the recordings whose stated speed nothing confirms, where their lines stand if that is clear: by
    themselves, or near the speed that the lines of another recording tell."""
    others = [r for name, r in tie.shafts.items() if name != tie.reference]
    recordings, speeds = [one.recording for one in several], [one.speed for one in several]
    found = far_speeds(recordings, speeds, ratios=others, teeth=tie.mesh_orders, seed=seed)
    return {one.label: far for one, far in zip(several, found, strict=True) if far is not None}


def left_out(
    gate: Gate, tests: Sequence[Observation], baselines: Sequence[Observation], far: Mapping[str, Elsewhere]
) -> tuple[Gate, list[Observation], list[Observation], tuple[str, ...]]:
    """Gate and recordings without those that surely turned elsewhere, and what is said of these; all of them where
    every test is one, or may be by one factor with them, and where most of all are by one factor and no baseline would
    be left: what is wrong with so many is wrong with the file or with every label."""
    sure = {label for label, found in far.items() if not found.own}
    known = [one for one in (*tests, *baselines) if one.label in far]
    if all(one.label in sure for one in tests) or (all(one.label in far for one in tests) and _alike(known, far)):
        return gate, list(tests), list(baselines), ()
    based = bool(baselines) and all(one.label in sure for one in baselines)
    if based and 2 * len(known) > len(tests) + len(baselines) and _alike(known, far):
        return gate, list(tests), list(baselines), ()
    told = tuple(
        f"{one.label} was left out: {_lines(one, far[one.label])}" for one in (*tests, *baselines) if one.label in sure
    )
    return *without(gate, tests, baselines, sure), told


def without(
    gate: Gate, tests: Sequence[Observation], baselines: Sequence[Observation], labels: Collection[str]
) -> tuple[Gate, list[Observation], list[Observation]]:
    """Gate and observations without the recordings of these labels."""
    kept = [[i for i, one in enumerate(several) if one.label not in labels] for several in (tests, baselines)]
    gate = replace(
        gate,
        tests=tuple(gate.tests[i] for i in kept[0]),
        baselines=tuple(gate.baselines[i] for i in kept[1]),
    )
    return gate, [tests[i] for i in kept[0]], [baselines[i] for i in kept[1]]


def told_elsewhere(
    stated: Judged,
    tests: Sequence[Observation],
    far: Mapping[str, Elsewhere],
    at: Callable[[Mapping[str, float]], Judged | None],
    baselines: Sequence[Observation] = (),
) -> Report | None:
    """The report where most tests have lines of a shaft far from their stated speed; None where they have not.

    `at(speeds)`: the answer at these speeds (Hz, by label). The verdict is a fault of the measurement where no line is
    near the stated speed and the bearings' lines do not speak for it; else nothing is named.
    """
    here = [one for one in tests if one.label in far]
    if 2 * len(here) <= len(tests):
        return None
    first = here[0]
    hz = far[first.label].speed_hz
    too = [one for one in baselines if one.label in far]
    advice = SHARED if _alike([*here, *too], far) and too else ADVICE
    there = at({label: found.speed_hz for label, found in far.items()})
    told = "; ".join(f"{one.label}: {_lines(one, far[one.label])}" for one in here)
    note = f"whether {first.speed.shaft} turns at {first.speed.stated_hz:.4g} Hz as stated: {told}"
    found_there = "" if there is None else f" At {hz:.4g} Hz: {there.report.sentence}"
    also = f" So it is with {'; '.join(f'{one.label}: {_lines(one, far[one.label])}' for one in too)}." if too else ""
    pairs = ((stated, first.speed.speed_hz), *(((there, hz),) if there is not None else ()))
    against = there is not None and stated.z > there.z + CLEAR_Z
    if not against and not any(far[one.label].own for one in here):
        return Report(
            verdict="measurement_fault",
            sentence=f"The stated speed does not hold: {told}, and none is near that.{also} Nothing is judged "
            f"by it.{found_there}",
            level="kinematics",
            where=stated.report.where if there is None else there.report.where,
            causes=at_either(*pairs[1:]),
            fault=SensorFault(kind="speed_mismatch", channel="", detail=told),
            undecidable=(note, *(() if there is None else there.report.undecidable)),
            next_experiment=advice,
        )
    if stated.report.verdict in QUIET and (there is None or there.z == 0.0):
        return replace(stated.report, undecidable=(note, *stated.report.undecidable))
    nearer = there is not None and there.z > stated.z
    shown, at_hz = (there.report, hz) if there is not None and nearer else (stated.report, first.speed.speed_hz)
    causes = at_either(*pairs)
    return replace(
        shown,
        verdict="ambiguous",
        sentence=f"The speed is not decided: {told}.{also} At {at_hz:.4g} Hz: {shown.sentence}",
        where=placed(shown.where, causes),
        causes=causes,
        undecidable=(note, *shown.undecidable),
        next_experiment=advice,
    )


def _alike(several: Sequence[Observation], far: Mapping[str, Elsewhere]) -> bool:
    """Whether the labels of all these are wrong by one factor."""
    factors = [far[one.label].speed_hz / one.speed.stated_hz for one in several if one.speed.stated_hz]
    return bool(factors) and max(factors) / min(factors) <= 1.0 + ONE_FACTOR


def _lines(one: Observation, found: Elsewhere) -> str:
    """Where they stand: `the lines of a shaft at 32 Hz (1, 2 and 3 times), the description states 25 Hz`."""
    *many, last = [str(k) for k in found.harmonics] or [""]
    which = [f"{', '.join(many)} and {last} times it" if many else f"{last} time it"] if last else []
    which += ["its teeth"] if found.by_teeth else []
    return (
        f"the lines of a shaft at {found.speed_hz:.4g} Hz ({', '.join(which)}), the description states "
        f"{one.speed.stated_hz:.4g} Hz"
    )
