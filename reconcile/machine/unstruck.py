"""A pit that nothing strikes in is none: whether impacts are heard of the local defects that fit best.

A blow in its own time or a hard stop rings the structure as a pit does, and levels of bands and lines cannot tell them
apart. But balls meet a pit at a frequency of their own, at every speed.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from reconcile.kinematics.candidate import DEFECTS
from reconcile.machine.decide import FEW_VIEWS, Decision
from reconcile.machine.direct import UNHEARD, Direct
from sim.terms import REGISTRY

FEWEST_POINTS = 2
SILENT = "a pit in a bearing fits best, and nothing strikes at its frequency"
TOO_FAINT = f"{SILENT}, which the little that changed does not exclude"
CLEAR = 15.0
"""Log evidence below which a silent pit is not excluded: one of 2.7 mm on an inner race of a slow shaft, whose edges
the balls roll over softly, fitted with 8 and left nothing, unheard at all three speeds (i050 of the proof), one of
2.3 mm with 9 (z053); a third was heard with 7.8 deviations (z025). Knocks told as pits fitted with 31 (z009)."""
BEHIND = 20.0
"""Log evidence behind the first from which another effect of the set is no other answer: more than what is added to a
set whatever its lead (`likelier.rivals`; a true loose fit 8.4 behind, m009). z009: 27."""


def unless_silent(
    decision: Decision, direct: Direct, evidence: Mapping[str, float], *, points: int, views: int
) -> Decision:
    """None of the known effects, where all of those in the answer that are not far behind are pits of bearings whose
    impacts are not heard; where the `evidence` of the first is too little to say so, no name, and a set says it beside.
    `direct`: of a machine with teeth, against a baseline; `points`: operating points, `views`: those times sensors."""
    if decision.word not in ("explained", "ambiguous") or not direct.looked:
        return decision
    most = max(evidence[name] for name in decision.chosen)
    near = [name for name in decision.chosen if evidence[name] > most - BEHIND]
    if points < FEWEST_POINTS or views <= FEW_VIEWS or not all(_silent(n, direct) for n in near):
        return decision
    if most < CLEAR:
        if decision.word == "ambiguous":
            return replace(decision, reasons=(*decision.reasons, TOO_FAINT))
        return replace(decision, word="not_decidable", reasons=(TOO_FAINT,))
    return replace(decision, word="unknown_physics", chosen=decision.chosen[:3], reasons=(SILENT,))


def _silent(name: str, direct: Direct) -> bool:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    if term is None or term.strikes not in DEFECTS or name in direct.present:
        return False  # a pit that has grown strikes before and after
    return abs(direct.evidence.get(name, 0.0)) < UNHEARD
