"""Lines that two parts of a bearing make within slip of each other: neither part alone is the answer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.kinematics.answer import PARTS, TERMS
from reconcile.kinematics.beside_turn import ONE_LINE
from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.judge import LIKE_SHARE
from reconcile.kinematics.sites import DECIDED, USUAL_SLIP
from reconcile.shares import from_drawing
from reconcile.verdict import Cause, PlaceWeight, Report

REASON = "another part of the bearing makes the same lines within slip"


def other_kind(first: Candidate, every: Sequence[Candidate]) -> Candidate | None:
    """The firmest other part that reads the first's line as its own, if score and slip do not decide between them:
    the ball of a 7208 and its outer race are 3 % apart."""
    rivals = [c for c in every if _reads_too(c, first)]
    rival = max(rivals, key=lambda c: c.z, default=None)
    return rival if rival is not None and _weight(first, rival) < DECIDED else None


def _reads_too(one: Candidate, first: Candidate) -> bool:
    other = one.family.kind in DEFECTS and one.family.kind != first.family.kind
    near = abs(one.best.order / first.best.order - 1.0) < ONE_LINE
    return other and near and one.present and one.risen and one.deep and one.z >= LIKE_SHARE * first.z


def _weight(first: Candidate, rival: Candidate) -> float:
    """Of the first; a deviation of lead is worth e^(1/2), as between places."""
    lead = (first.z - rival.z - (first.best.slip / USUAL_SLIP) ** 2 + (rival.best.slip / USUAL_SLIP) ** 2) / 2
    return float(1.0 / (1.0 + np.exp(-np.clip(lead, -50.0, 50.0))))


def with_other_kind(report: Report, first: Candidate, rival: Candidate) -> Report:
    """The answer as a set of both."""
    weight = _weight(first, rival)
    kind = rival.family.kind
    further = Cause(
        term=TERMS[kind],
        site=rival.family.site,
        score=rival.z * (1.0 - weight),
        reasons=(REASON,),
        values={"slip": rival.best.slip, "depth": rival.best.depth, "chance": rival.chance},
    )
    shares = {w.site: w.weight * weight for w in report.where.sites}
    shares[rival.family.site] = shares.get(rival.family.site, 0.0) + 1.0 - weight
    sites = [PlaceWeight(site=site, weight=share) for site, share in sorted(shares.items(), key=lambda w: -w[1])]
    own = [replace(c, score=c.score * weight, named=False, reasons=(*c.reasons, REASON)) for c in report.causes]
    or_else = f"{PARTS[kind]} of {rival.family.site} ({from_drawing(rival.best.slip)}) makes the same lines"
    return replace(
        report,
        verdict="ambiguous",
        sentence=f"{report.sentence} But {or_else}: which of both it is is not decided.",
        where=replace(report.where, sites=tuple(sites)),
        causes=tuple(sorted((*own, further), key=lambda c: -c.score)),
        undecidable=(f"which part it is: {or_else}", *report.undecidable),
    )
