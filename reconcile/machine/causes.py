"""The causes of a report, with their sizes, and the machine that has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from reconcile.machine.decide import Decision
from reconcile.machine.refine import best_draws
from reconcile.machine.second import Beside, Together, strikes
from reconcile.machine.setting import Found
from reconcile.machine.severity import estimated_severity, joined
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
    measured: Mapping[str, Severity] | None = None,
    levels: Mapping[str, Severity] | None = None,
    strikes_apart: Mapping[str, Severity] | None = None,
) -> tuple[Cause, ...]:
    """The effects the verdict stands on, a second one with what it explains, those that share the impacts of another
    part (`struck`), and the rest by score. `sought`: the best of several seconds, where sizes had to be searched;
    `measured`: sizes by what is heard of pits and faults of teeth; `levels`: where machines were simulated to tell them
    by levels (else the nearest draws do); `strikes_apart`: sizes by both edges of a pit, beside which no other counts.
    """
    heard, edges = measured or {}, strikes_apart or {}
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
        by_levels = (levels or {}).get(name) or estimated_severity(found.view(name), found.known, name, observed)
        alone = edges.get(name) or joined(by_levels, heard.get(name))
        size = _between(alone, together if named and name not in {*heard, *edges} else None)
        causes.append(
            Cause(
                term=term,
                site=site,
                score=told[name],
                severity=size,
                named=named,
                reasons=(ITS_IMPACTS,) if name in struck else _reasons(decision, name),
                values=_sized(drawn[0] if drawn else None, size),
            )
        )
    if other is not None:
        causes.insert(1, _beside(found, other, heard, edges))
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


def _beside(found: Found, other: Beside, measured: Mapping[str, Severity], edges: Mapping[str, Severity]) -> Cause:
    """The second named cause, measured by what the first one leaves, and by what is heard of it."""
    name, left, view = other.names[0], other.left, other.view
    term, site = name.split("@")
    if other.together is not None:
        return Cause(
            term=term,
            site=site,
            score=float(other.evidence[0]),
            severity=(size := edges.get(name) or joined(other.together.severity, measured.get(name))),
            named=True,
            reasons=(TOGETHER,),
            values=_sized(other.together.terms[0][1], size),
        )
    drawn = best_draws(view, found.known, name, left, count=1)
    size = edges.get(name) or joined(estimated_severity(view, found.known, name, left), measured.get(name))
    return Cause(
        term=term,
        site=site,
        score=float(other.evidence[0]),
        severity=size,
        named=True,
        reasons=(ITS_IMPACTS if strikes(name) else WHAT_IS_LEFT,),
        values=_sized(drawn[0] if drawn else None, size),
    )


def _sized(drawn: TermSpec | None, size: Severity | None) -> Mapping[str, float]:
    """Parameters of the nearest draw at the estimated size: a report says one size of an effect."""
    values = {} if drawn is None else dict(drawn.parameters)
    return values if size is None else {**values, size.name: size.value}


def cause_terms(causes: Sequence[Cause]) -> tuple[TermSpec, ...]:
    """The named effects, or else the likeliest, at their estimated sizes."""
    chosen = [c for c in causes if c.named] or causes[:1]
    return tuple(TermSpec(term=c.term, site=c.site, parameters=dict(c.values)) for c in chosen)
