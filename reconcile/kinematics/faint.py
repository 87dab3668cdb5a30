"""Answers where a bearing is the likely place but no part of it is certain: shallow lines, impacts without an order."""

from __future__ import annotations

import math
from collections.abc import Sequence

from reconcile.kinematics.answer import TERMS, lines_of
from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.shafts import Impulsiveness
from reconcile.kinematics.vague import loudest
from reconcile.verdict import Cause, NextExperiment, PlaceWeight, Report, Where

NO_SIZE = "a size can't be given without a model"
LONGER = "Record ten times as long, or under more load: lines of a race deepen."
NO_ORDER = "impulsiveness grew, but no order stands out"
LEAST, HINTED_Z = 0.4, 3.0
"""Score of what is only possible, and of a ball's own order from which it is likelier: made knocks at no order
reach 1.5."""
LIKELY = "a damaged ball, which strikes only when its spot meets a race, is likely; play or a rub can't be ruled out"
OPEN = "a damaged ball, play, a rub, or knocks from outside (a press, a tool, what it works on) are alike at this level"
MANY_TURNS = "Record ten times as long: cage sidebands of a ball fault need many turns."
WHICH, WHETHER = "which part strikes", "whether a part strikes or something outside"
STOP = "Record without the process and its neighbours."


def impulsive_report(found: Impulsiveness, every: Sequence[Candidate], bearings: Sequence[str]) -> Report:
    """More impulsive than the baseline, but at no order: ball faults strike irregularly as the ball turns."""
    ball = {c.family.site: c.z for c in every if c.family.kind == "ball"}
    heard = max((ball.get(b, 0.0) for b in bearings), default=0.0) >= HINTED_Z
    score = {b: max(ball.get(b, 0.0), LEAST) if heard else LEAST for b in bearings}
    total = sum(score.values()) or 1.0
    causes = [Cause(term="ball_spall", site=b, score=s, reasons=(NO_ORDER,)) for b, s in score.items()]
    causes += [Cause(term="radial_clearance", site=b, score=LEAST, reasons=(NO_ORDER,)) for b in bearings]
    which = LIKELY if heard else OPEN
    return Report(
        verdict="ambiguous",
        sentence=f"{found.band_hz[0]:.0f}-{found.band_hz[1]:.0f} Hz of {found.channel} became impulsive (excess "
        f"kurtosis {found.before or 0:.1f} to {found.now:.1f}) without keeping to the order of any race: {which}.",
        level="kinematics",
        where=Where(
            sites=tuple(PlaceWeight(site=b, weight=s / total) for b, s in score.items()),
            limits=("impacts without an order say when, not where",),
        ),
        causes=tuple(sorted(causes, key=lambda c: -c.score)),
        undecidable=(
            WHICH if heard else WHETHER,
            "how large: a size can't be given without a model",
        ),
        next_experiment=NextExperiment(sentence=MANY_TURNS if heard else f"{STOP} {MANY_TURNS}"),
    )


def shallow_report(
    risen: Sequence[Candidate],
    every: Sequence[Candidate],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
) -> Report:
    """Bearing lines rose, but stay shallower than a defect of that race makes them: the set is the answer."""
    sites = list(dict.fromkeys(c.family.site for c in risen))
    causes = [
        Cause(
            term=TERMS[c.family.kind],
            site=c.family.site,
            score=c.z,
            reasons=("its lines rose, but are shallower than a defect of that part alone makes them",),
            values={"depth": c.best.depth, "slip": c.best.slip},
        )
        for c in risen
    ]
    own = {c.site for c in causes if c.term == "ball_spall"}
    causes += [_ball(site, risen, every) for site in sites if site not in own]
    causes.sort(key=lambda c: -c.score)
    keys = ", ".join(f"{c.family.key} ({c.growth_db or 0:+.0f} dB)" for c in risen)
    louder = loudest(tests, baselines)
    which, advice = "a young race defect or a damaged ball", LONGER
    if louder is not None:
        grown = f"{louder[0]} is {louder[1]:.0f} dB louder"
        which = f"{grown}, too much for a young defect: a large one whose impacts overlap, or a damaged ball"
        advice = "Inspect the bearing at the next stop; what is left open is the part, not that it is damaged."
    total = sum(c.score for c in causes)
    return Report(
        verdict="ambiguous",
        sentence=f"Bearing lines rose over the baseline, {keys}, but stay shallow (depth "
        f"{max(c.best.depth for c in risen):.2f}): {which}.",
        level="kinematics",
        where=Where(
            sites=tuple(PlaceWeight(site=s, weight=sum(c.score for c in causes if c.site == s) / total) for s in sites),
            lines=tuple(line for c in risen for line in lines_of(c, tests, baselines, 2)),
        ),
        causes=tuple(causes),
        undecidable=("which part of the bearing: shallow lines of several are alike", "how large: " + NO_SIZE),
        next_experiment=NextExperiment(sentence=advice),
    )


def _ball(site: str, risen: Sequence[Candidate], every: Sequence[Candidate]) -> Cause:
    """A damaged ball of a bearing whose races' lines rose, by what of it was heard: both races together where both
    rose, which it strikes alike; the cage's order where impacts come and go with it; else its own lines alone."""
    here = {c.family.kind: c for c in every if c.family.site == site}
    races = [c.z for c in risen if c.family.site == site]
    cage = here.get("cage")
    heard = {"its own lines did not rise": here["ball"].z if "ball" in here else 0.0}
    if len(races) > 1:
        heard["lines of both races rose, which a damaged ball strikes both"] = math.hypot(*races)
    if cage is not None and cage.risen and cage.deep:
        heard["impacts come and go with the cage"] = cage.z
    reason, score = max(heard.items(), key=lambda one: one[1])
    return Cause(term="ball_spall", site=site, score=score, reasons=(reason,))
