"""The causes of a report, with their sizes, and the machine that has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reconcile.machine.decide import Decision
from reconcile.machine.refine import best_draws
from reconcile.machine.second import Beside, Together, strikes
from reconcile.machine.setting import Found
from reconcile.machine.severity import estimated_severity
from reconcile.verdict import Cause, Severity
from sim.core.spec import TermSpec

MOST_CAUSES = 10
WHAT_IS_LEFT = "it explains what the first effect leaves of the lines of the mesh"
TOGETHER = "fitted together with the first effect it explains what that one alone does not"
ITS_IMPACTS = "impacts come at the lines of this part too"


def ranked_causes(
    found: Found,
    decision: Decision,
    weights: Mapping[str, float],
    observed: np.ndarray,
    other: Beside | None,
    struck: Sequence[str] = (),
    sought: Together | None = None,
) -> tuple[Cause, ...]:
    """The effects the verdict stands on, a second one with what it explains, those that share the impacts of another
    part (`struck`), and the rest by score. `sought`: the best of several seconds, where sizes had to be searched."""
    apart = {*decision.chosen, *(other.names[:1] if other else ())}
    told = dict(zip(found.screen.names, map(float, found.screen.evidence), strict=True))
    rest = sorted((n for n in weights if n not in struck), key=lambda n: -told[n])
    listed = list(decision.chosen) + [n for n in dict.fromkeys((*struck, *rest)) if n not in apart]
    together = other.together if other is not None else sought
    causes = []
    for name in listed[:MOST_CAUSES]:
        term, site = name.split("@")
        drawn = best_draws(found.view(name), found.known, name, observed, count=1)
        named = decision.word == "explained" and name == decision.chosen[0]
        size = estimated_severity(found.view(name), found.known, name, observed)
        causes.append(
            Cause(
                term=term,
                site=site,
                score=told[name],
                severity=_between(size, together if named else None),
                named=named,
                reasons=(ITS_IMPACTS,) if name in struck else _reasons(decision, name),
                values=dict(drawn[0].parameters) if drawn else {},
            )
        )
    if other is not None:
        causes.insert(1, _beside(found, other))
    return tuple(causes)


def _between(alone: Severity | None, together: Together | None) -> Severity | None:
    """The size of a first effect: as it is alone, where a second one was not fitted with it; beside the second, where
    the sizes of both were searched; else between both, with an interval that holds either. Of three pairs of the proof
    two unbalances were nearer beside the second (25 and 15 % off for 46 and 25 %), a loose fit was not (2.6 and 4.7 um
    of 9.6)."""
    beside = together.own if together is not None else None
    if alone is None or beside is None:
        return alone
    if together is not None and together.searched:
        return beside
    return replace(
        alone,
        value=float(np.sqrt(alone.value * beside.value)),
        low=min(alone.low, beside.low),
        high=max(alone.high, beside.high),
    )


def _reasons(decision: Decision, name: str) -> tuple[str, ...]:
    """What the verdict is based on, of all it leaves open; of a name, of that name alone."""
    return decision.reasons if decision.word != "explained" or name in decision.chosen else ()


def _beside(found: Found, other: Beside) -> Cause:
    """The second named cause, measured by what the first one leaves."""
    name, left, view = other.names[0], other.left, other.view
    term, site = name.split("@")
    if other.together is not None:
        return Cause(
            term=term,
            site=site,
            score=float(other.evidence[0]),
            severity=other.together.severity,
            named=True,
            reasons=(TOGETHER,),
            values=dict(other.together.terms[0][1].parameters),
        )
    drawn = best_draws(view, found.known, name, left, count=1)
    return Cause(
        term=term,
        site=site,
        score=float(other.evidence[0]),
        severity=estimated_severity(view, found.known, name, left),
        named=True,
        reasons=(ITS_IMPACTS if strikes(name) else WHAT_IS_LEFT,),
        values=dict(drawn[0].parameters) if drawn else {},
    )


def cause_terms(causes: Sequence[Cause]) -> tuple[TermSpec, ...]:
    """The named effects, or else the likeliest, at their estimated sizes."""
    terms = []
    for cause in [c for c in causes if c.named] or causes[:1]:
        values = dict(cause.values)
        if cause.severity is not None:
            values[cause.severity.name] = cause.severity.value
        terms.append(TermSpec(term=cause.term, site=cause.site, parameters=values))
    return tuple(terms)
