"""Answers for bearing defects: the sentence, the lines, the size and what it predicts."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.carried import carried, shared, told_exchanged, told_heard, told_open
from reconcile.kinematics.extent import Extent, as_severity, spall_extent, told_extent
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.heldout import held_out
from reconcile.kinematics.measured import measured_lines
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.record_at import record_at
from reconcile.kinematics.sites import decided, places
from reconcile.shares import from_drawing
from reconcile.verdict import NO_GAIN, Cause, HeldOut, LineChange, NextExperiment, PlaceWeight, Report, Severity, Where

TERMS = {"outer": "outer_spall", "inner": "inner_spall", "ball": "ball_spall"}
PARTS = {"outer": "the outer race", "inner": "the inner race", "ball": "a ball"}
SYMBOLS = {"outer": "BPFO", "inner": "BPFI", "ball": "2 BSF", "cage": "FTF", "turn": "shaft"}
BOUND = "width_below_m"
"""Key of the values of a cause of which only an upper bound of its length is known: a bound is no size."""
ALIKE = " if both its edges strike alike"
"""A ball that sinks in slowly is not heard at the near edge: then only the far one strikes, however long the way."""
MERGED = "entry and exit are not told apart"
REBOUND = "what strikes second may be the far edge or a rebound: another speed would tell"
ANOTHER_SPEED = NextExperiment(
    sentence="Record at another speed, a quarter off this one or more: over a defect what strikes second keeps its "
    "angle, a rebound does not."
)
NO_BASELINE, WITHOUT = "there is no baseline", "without a baseline"
SOUND = NextExperiment(sentence="Record the machine in a sound state, or each bearing on its own.")
SOUND_TOO = NextExperiment(sentence="Record the same machine in a sound state as a baseline.")
WHOSE = NextExperiment(sentence="Look which sensor is which channel.")
HANGS = " The place hangs on which sensor is which."
NO_SIZE = "how large the defect is: a size can't be given from these lines without a model of the machine"


def defect_report(
    chosen: Sequence[Candidate],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    ties: Ties,
    seed: int,
) -> Report:
    """One or two bearing defects that stand."""
    weights = [places(c, tests, ties, baselines) for c in chosen]
    words = [carried(w, tests, baselines) for w in weights]
    opened = [told_open(w) for w, word in zip(weights, words, strict=True) if word == "open"]
    opened += [told_exchanged(w) for w, word in zip(weights, words, strict=True) if word == "exchanged"]
    weights = [shared(w) if word == "exchanged" else w for w, word in zip(weights, words, strict=True)]
    sizes = [_size(c, tests, ties) for c in chosen]
    one_site = all(decided(w) for w in weights)
    causes = tuple(
        cause
        for c, w, s in zip(chosen, weights, sizes, strict=True)
        for cause in _causes(c, w, s[1], one_site, _bound_m(c, s[0], ties))
    )
    held = _held(chosen[0], tests, baselines, ties, np.random.default_rng(seed), seed)
    undecidable = (*_undecided(chosen, weights, sizes, baselines, ties), *opened)
    first, *others = (_phrase(c, w, s[0], ties) for c, w, s in zip(chosen, weights, sizes, strict=True))
    what = " and ".join((first + gained(held), *others))
    return Report(
        verdict="explained" if one_site else "ambiguous",
        sentence=f"{what}.{HANGS}" if "open" in words else f"{what}.",
        level="kinematics",
        where=Where(
            sites=_merged(weights),
            lines=tuple(line for c in chosen for line in lines_of(c, tests, baselines)),
            limits=told_heard(weights, words)
            if one_site
            else ("bearings whose orders lie within slip of each other make the same lines",),
        ),
        causes=causes,
        held_out=held,
        undecidable=undecidable,
        next_experiment=WHOSE if "exchanged" in words else _next(weights, tests, sizes, baselines),
    )


def gained(held: HeldOut | None) -> str:
    """What the sentence adds where the defect predicts nothing of the data held out: its lines name it all the same."""
    return NO_GAIN if held is not None and held.gain <= 0.0 else ""


def lines_of(
    candidate: Candidate, tests: Sequence[Observation], baselines: Sequence[Observation], harmonics: int = 3
) -> tuple[LineChange, ...]:
    """Those of the family's first lines that stand out in the recording that shows it best, as measured there."""
    e, family = candidate.best, candidate.family
    symbol = SYMBOLS[family.kind]
    wanted = []
    for k in range(1, harmonics + 1):
        wanted.append((f"{k} {symbol}", k * e.order))
        for m in range(1, family.sidebands + 1):
            name = "shaft" if family.kind == "inner" else "FTF"
            wanted += [
                (f"{k} {symbol} {s}{m} {name}", k * e.order + (m if s == "+" else -m) * family.spacing) for s in "-+"
            ]
    locked = family.site if family.kind == "turn" else f"{family.site}.{family.kind}"
    return measured_lines(wanted, e.channel, e.band_hz, tests[candidate.strongest], baselines, locked)


def _size(candidate: Candidate, tests: Sequence[Observation], ties: Ties) -> tuple[Extent | None, Severity | None]:
    """The length that entry and exit say; else the tightest bound, which is no size."""
    pairs = zip(candidate.evidence, tests, strict=True)
    chosen = told_extent([(t.speed.speed_hz, x) for e, t in pairs if (x := spall_extent(e, t, ties)) is not None])
    if chosen is None:
        return None, None
    return chosen, as_severity(chosen, candidate.best, ties) if chosen.resolved else None


def _causes(
    candidate: Candidate,
    weights: Sequence[PlaceWeight],
    severity: Severity | None,
    named: bool,
    bound_m: float | None,
) -> list[Cause]:
    reasons = () if named else ("another bearing makes the same lines",)
    e = candidate.best
    bound = {} if bound_m is None else {BOUND: bound_m}
    return [
        Cause(
            term=TERMS[candidate.family.kind],
            site=w.site,
            score=float(candidate.z * w.weight),
            severity=severity,
            named=named and w.weight == max(x.weight for x in weights),
            reasons=reasons,
            values={"slip": e.slip, "depth": e.depth, "chance": candidate.chance} | bound,
        )
        for w in weights
        if not named or w.weight > 0.05
    ]


def _held(
    candidate: Candidate,
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    ties: Ties,
    rng: np.random.Generator,
    seed: int,
) -> HeldOut | None:
    """The recording that shows it best fitted, the others predicted; placebo: another family of the bearing."""
    ranked = [tests[candidate.strongest], *(t for i, t in enumerate(tests) if i != candidate.strongest)]
    others = [f for f in ties.families if f.site == candidate.family.site and f.kind in DEFECTS]
    placebo: Family | None = next((f for f in others if f.kind != candidate.family.kind), None)
    return held_out(candidate.family, placebo, ranked, baselines, ties, rng, seed)


def _phrase(candidate: Candidate, weights: Sequence[PlaceWeight], extent: Extent | None, ties: Ties) -> str:
    kind, e = candidate.family.kind, candidate.best
    where = weights[0].site if decided(weights) else "one of " + ", ".join(w.site for w in weights)
    text = f"A local defect on {PARTS[kind]} of {where}: {SYMBOLS[kind]} at order {e.order:.4g} ("
    text += f"{from_drawing(e.slip)}) modulates {e.band_hz[0]:.0f}-{e.band_hz[1]:.0f} Hz of {e.channel}"
    growth = candidate.growth_db
    text += f", its depth of modulation {growth:.0f} dB above the baseline's" if growth is not None else ""
    if extent is None:
        return text
    if not extent.resolved:
        return f"{text}; it covers {_less_than(extent, _bound_m(candidate, extent, ties))}{ALIKE}"
    span = f"{extent.low_deg:.1f} to {extent.high_deg:.1f}"
    rebound = ", unless what strikes second is a rebound" if extent.struck else ""
    return f"{text}; entry and exit say {extent.degrees:.1f} degrees of the race ({span}){rebound}"


def _bound_m(candidate: Candidate, extent: Extent | None, ties: Ties) -> float | None:
    """Length along the race that the defect stays below, m, where no more than that is known."""
    if extent is None or extent.resolved:
        return None
    bound = as_severity(extent, candidate.best, ties)
    return bound.high if bound.unit == "m" else None


def _less_than(extent: Extent, bound_m: float | None) -> str:
    length = "" if bound_m is None else f" ({1e3 * bound_m:.2g} mm)"
    return f"less than {extent.high_deg:.1f} degrees{length} of the race"


def _merged(weights: Sequence[Sequence[PlaceWeight]]) -> tuple[PlaceWeight, ...]:
    total: dict[str, float] = {}
    for row in weights:
        for w in row:
            total[w.site] = total.get(w.site, 0.0) + w.weight / len(weights)
    return tuple(PlaceWeight(site=s, weight=v) for s, v in sorted(total.items(), key=lambda item: -item[1]))


def _undecided(
    chosen: Sequence[Candidate],
    weights: Sequence[Sequence[PlaceWeight]],
    sizes: Sequence[tuple[Extent | None, Severity | None]],
    baselines: Sequence[Observation],
    ties: Ties,
) -> list[str]:
    found = []
    if not all(decided(w) for w in weights):
        found.append("which of these bearings it is: their lines coincide, or lie within slip of each other")
    if any(extent is None for extent, _ in sizes):
        found.append(NO_SIZE)
    found += [
        f"how large the defect is: {_less_than(x, _bound_m(c, x, ties))}{ALIKE}, but {REBOUND if x.struck else MERGED}"
        for c, (x, _) in zip(chosen, sizes, strict=True)
        if x is not None and not x.resolved
    ]
    if any(x is not None and x.resolved and x.struck for x, _ in sizes):
        found.append(f"how large the defect is: {REBOUND}")
    if any(c.family.kind == "outer" for c in chosen):
        found.append("where on the outer ring it sits: a rate has no angle")
    if not baselines:
        found.append(f"what of it was there before: {NO_BASELINE}")
    return found


def _next(
    weights: Sequence[Sequence[PlaceWeight]],
    tests: Sequence[Observation],
    sizes: Sequence[tuple[Extent | None, Severity | None]],
    baselines: Sequence[Observation],
) -> NextExperiment | None:
    if not all(decided(w) for w in weights):
        return record_at(weights, tests)
    if not baselines:
        return SOUND
    if any(s[0] is None or not s[0].resolved for s in sizes):
        return NextExperiment(sentence="Record at half the speed: entry and exit of the defect move apart in time.")
    return ANOTHER_SPEED if any(x is not None and x.struck for x, _ in sizes) else None
