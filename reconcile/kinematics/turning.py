"""Answers about a shaft as such: impacts once a turn, one of its multiples that grew, many of them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.kinematics.answer import WITHOUT, lines_of
from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.families import Ties
from reconcile.kinematics.foreign import Foreign
from reconcile.kinematics.in_step import InStep
from reconcile.kinematics.judge import TURN_DEPTH
from reconcile.kinematics.measured import measured_lines
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.series import ShaftSeries
from reconcile.kinematics.shaft_lines import SHAFT_TERMS
from reconcile.kinematics.shafts import Impulsiveness, ShaftChange
from reconcile.kinematics.slow import SlowTurn
from reconcile.kinematics.vague import TOOTH_TERMS
from reconcile.report.action import BESIDE_BEARING, STRIKES, STRIKES_OPEN
from reconcile.verdict import Cause, LineChange, NextExperiment, PlaceWeight, Report, Where

TURNING = ("unbalance", "bent_shaft")
LOOSE = ("pedestal_looseness", "rub")
BESIDE = "Beside it"
TURN_FLAT = 0.1
"""Mean power of the third and higher lines of a turn over that of its first two, of impacts beside a bearing's: made
ones of a tooth have 0.18 and more, what swells once a turn with a race in its load zone 0.02 at most."""
ALIKE = 1e-3
"""Relative difference of two turns below which they are one."""
NOT_WHAT = "once a turn says where it turns, not what strikes"
UNHEARD = 0.5
"""Share of the score of a part that strikes once a turn for a race whose own line is not heard."""


def turn_report(
    candidate: Candidate,
    ties: Ties,
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    carried: Sequence[str],
    *,
    foreign: Foreign | None = None,
    line: ShaftChange | None = None,
) -> Report:
    """Impacts once a turn that the baseline has not; `carried`: bearings on that shaft; `foreign`: a comb at
    an order of no part beside them, as an inner race makes whose numbers are not those of the specification; `line`:
    growth of the turn's own line, as an unbalance brings, which strikes too where a bearing has play."""
    shaft = candidate.family.site
    gears = _gears_on(shaft, ties)
    causes = [(term, shaft, 1.0) for term in TURNING if line is not None]
    # where the file has no bearing on the shaft its lines could not be looked for
    causes += [*_once_a_turn(shaft, gears, carried), *(("inner_spall", b, UNHEARD) for b in carried or (shaft,))]
    return Report(
        verdict="ambiguous",
        sentence=f"Impacts once a turn of {shaft} that no known rolling element makes: a rub, a loose part"
        + (", a damaged tooth" if gears else "")
        + " or a badly damaged bearing are alike at this level."
        + ("" if line is None else _with_line(line))
        + ("" if foreign is None else _beside_turn(foreign)),
        level="kinematics",
        where=Where(sites=_places(causes), lines=lines_of(candidate, tests, baselines)),
        causes=tuple(Cause(term=t, site=s, score=candidate.z * w, reasons=(NOT_WHAT,)) for t, s, w in causes),
        undecidable=(
            STRIKES_OPEN,
            *(() if carried else (f"whether a bearing of {shaft} is damaged: the file has none there",)),
            *(() if foreign is None else ("whether the bearings' numbers are those of the machine",)),
            "how large: a size can't be given without a model",
        ),
        next_experiment=NextExperiment(sentence=_next_of_turn(tests, foreign)),
    )


DRIVEN = "pistons, vanes, blades, lobes or the jaws of a coupling"


def driven_report(found: InStep, growth_db: float | None, tests: Sequence[Observation]) -> Report | None:
    """Blows several times a turn that keep step with a shaft and that the baseline has not; None without one."""
    if growth_db is None:
        return None
    low, high = found.band_hz
    wanted = [(f"{k * found.number} x {found.shaft}", k * found.order) for k in (1, 2, 3)]
    return Report(
        verdict="unknown_physics",
        sentence=f"Impacts {found.number} times a turn of {found.shaft} in {low:.0f}-{high:.0f} Hz of {found.channel}, "
        f"{growth_db:.0f} dB deeper than in the baseline, keep step with it: no bearing does, what a shaft drives "
        f"does ({DRIVEN}); the specification has no such part.",
        level="kinematics",
        where=Where(
            sites=(PlaceWeight(site=found.shaft, weight=1.0),),
            lines=measured_lines(wanted, found.channel, found.band_hz, tests[0], (), found.shaft),
        ),
        undecidable=(f"which part strikes {found.number} times a turn of {found.shaft}",),
        next_experiment=NextExperiment(
            sentence=f"Look for what {found.shaft} drives {found.number} times a turn; record it without that load."
        ),
    )


def with_driven(report: Report, found: InStep) -> Report:
    """The report of recordings without a baseline, with the blows that keep step with a shaft."""
    text = f"impacts {found.number} times a turn of {found.shaft} ({DRIVEN})"
    note = f"whether {text} are as strong as they should be: they keep step with it, no bearing's, and {WITHOUT}"
    said = f"{text[0].upper()}{text[1:]} keep step with it: they are no bearing's."
    quiet = report.verdict == "nothing_missing"
    return replace(
        report,
        sentence=f"{report.sentence} {said}" if quiet else report.sentence,
        undecidable=(*report.undecidable, f"{note} nothing tells"),
    )


def _gears_on(shaft: str, ties: Ties) -> list[str]:
    return [name for mesh in ties.meshes for s, name in zip(mesh[2], mesh[3], strict=True) if s == shaft]


def _places(struck: Sequence[tuple[str, str, float]]) -> tuple[PlaceWeight, ...]:
    """Of a set that a turn leaves open all places alike: the shaft, its gears and its bearings."""
    sites = list(dict.fromkeys(site for _, site, _ in struck))
    return tuple(PlaceWeight(site=site, weight=1.0 / len(sites)) for site in sites)


def _once_a_turn(shaft: str, gears: Sequence[str], carried: Sequence[str]) -> list[tuple[str, str, float]]:
    """(term, site, weight) of what strikes once a turn of a shaft."""
    teeth = [(term, g, 1.0) for g in gears for term in TOOTH_TERMS]
    loose = [("pedestal_looseness", site, 1.0) for site in (shaft, *carried)]
    return [*teeth, ("rub", shaft, 1.0), *loose]


def with_turn(
    report: Report, told: Sequence[Candidate], every: Sequence[Candidate], ties: Ties, *, based: bool
) -> Report:
    """The answer of bearings, with the impacts once a turn that rose beside the families it tells: they are no outer
    race's. An inner race meets the load once a turn of its shaft, and how hard a ball strikes hangs on more than that.
    Without a baseline nothing is said: sound gearboxes knock as well."""
    if not based or any(c.family.kind == "ball" for c in told):
        return report
    struck = [
        c
        for c in every
        if c.family.kind == "turn"
        and c.present
        and c.risen
        and c.depth >= TURN_DEPTH
        and c.best.flatness >= TURN_FLAT
        and not any(x.family.kind == "inner" and abs(x.family.spacing / c.family.order - 1.0) < ALIKE for x in told)
    ]
    for c in struck[:1]:
        gears = _gears_on(c.family.site, ties)
        what = f"{f'the teeth of {_and(gears)}, ' if gears else ''}a rub, a loose part or a load that turns"
        low, high = c.best.band_hz
        rose = f"rose, {c.growth_db or 0.0:.0f} dB over the baseline, in {low:.0f}-{high:.0f} Hz of {c.best.channel}"
        report = replace(
            report,
            sentence=f"{report.sentence} {BESIDE} impacts once a turn of {c.family.site} {rose}: {what}.",
            undecidable=(*report.undecidable, f"{STRIKES} {c.family.site}{BESIDE_BEARING}: {what}"),
        )
    return report


def _and(names: Sequence[str]) -> str:
    return " and ".join(names)


def slow_report(found: SlowTurn, impacts: Impulsiveness, ties: Ties, carried: Sequence[str]) -> Report:
    """Impacts at one angle of a shaft; `carried`: bearings on it."""
    gears = _gears_on(found.shaft, ties)
    what = "a damaged tooth, a rub or a loose part" if gears else "a rub or a loose part"
    struck = _once_a_turn(found.shaft, gears, carried)
    return Report(
        verdict="ambiguous",
        sentence=f"{impacts.band_hz[0]:.0f}-{impacts.band_hz[1]:.0f} Hz of {impacts.channel} became impulsive (excess "
        f"kurtosis {impacts.before or 0:.1f} to {impacts.now:.1f}), at one angle of {found.shaft} in its {found.turns} "
        f"turns: {what} are alike at this level.",
        level="kinematics",
        where=Where(
            sites=_places(struck),
            angle_window=found.window,
            limits=(f"{found.turns} turns of {found.shaft} are too few for its lines",),
        ),
        causes=tuple(Cause(term=t, site=s, score=found.score * w, reasons=(NOT_WHAT,)) for t, s, w in struck),
        undecidable=(STRIKES_OPEN, "how large: a size can't be given without a model"),
        next_experiment=NextExperiment(sentence=f"Record fifty turns of {found.shaft} or more, with a tacho."),
    )


def _with_line(line: ShaftChange) -> str:
    return (
        f" The turn's own line grew by {line.growth_db:.0f} dB: an unbalance or a bow of {line.shaft} brings that, and "
        "in a bearing with play it strikes once a turn too."
    )


def _beside_turn(foreign: Foreign) -> str:
    return (
        f" Impacts {foreign.order:.4g} times a turn stand beside them, an order of no part of the specification: the "
        "inner race of a bearing with other numbers than those given would bring both."
    )


def _next_of_turn(tests: Sequence[Observation], foreign: Foreign | None) -> str:
    if foreign is not None:
        return "Check the bearing sizes of the specification (balls, diameters, angle, or the catalogue number)."
    if any(t.speed.method == "tacho" for t in tests):
        return "Follow the angle of the impacts against the tacho over several recordings: a rub keeps it."
    return "Record with a tacho: the angle of the impacts tells a rub from play."


def series_report(several: Sequence[ShaftSeries], grown: Sequence[ShaftChange], tests: Sequence[Observation]) -> Report:
    """Many multiples of a shaft grew, the first of `several`; `grown`: those that stand out, with what they may be."""
    found = several[0]
    speed = next(t.speed.speed_hz for t in tests if t.label == found.label)
    single = [(t, c.shaft) for c in grown for t in SHAFT_TERMS[c.multiple]]
    causes = list(dict.fromkeys([*((t, one.shaft) for one in several for t in LOOSE), *single]))
    kinds = ", ".join(dict.fromkeys(t.replace("_", " ") for t, _ in causes))
    shown = ", ".join(f"{m:g}" for m in found.multiples)
    which = "and halves of them" if found.halves else "together"
    where = " or ".join(one.shaft for one in several)
    reason = "multiples of the turn say what turns, not what is loose"
    total = sum(len(one.multiples) for one in several)
    return Report(
        verdict="ambiguous",
        sentence=f"Multiples of the speed of {where} {which} grew, {found.middle_db:.0f} dB in the middle ({shown} "
        f"times that of {found.shaft}), most on {found.channel}: something is loose, lifts off or rubs once a turn, or "
        f"is mounted otherwise; {kinds} are alike at this level.",
        level="kinematics",
        where=Where(
            sites=tuple(PlaceWeight(site=one.shaft, weight=len(one.multiples) / total) for one in several),
            lines=tuple(
                LineChange(
                    label=f"{m:g} x {found.shaft}",
                    frequency_hz=m * found.ratio * speed,
                    change_db=growth,
                    channel=found.channel,
                    locked_to=found.shaft,
                    speed_hz=speed,
                )
                for m, growth in zip(found.multiples, found.growth_db, strict=True)
            ),
        ),
        causes=tuple(
            Cause(term=t, site=s, score=found.middle_db, score_unit="dB", reasons=(reason,)) for t, s in causes
        ),
        undecidable=("what is loose or rubs", "how large: a size can't be given without a model"),
        next_experiment=NextExperiment(
            sentence="Check bolts, feet and fits; record at two more speeds: a rub comes and goes, play stays."
        ),
    )
