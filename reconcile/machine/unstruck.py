"""A pit that nothing strikes in is none: whether impacts are heard of the local defects that fit best.

A blow in its own time or a hard stop rings the structure as a pit does, and levels of bands and lines cannot tell them
apart. But balls meet a pit at a frequency of their own, at every speed.
"""

from __future__ import annotations

from dataclasses import replace

from reconcile.kinematics.candidate import DEFECTS
from reconcile.machine.decide import FEW_VIEWS, Decision
from reconcile.machine.direct import UNHEARD, Direct
from sim.terms import REGISTRY

FEWEST_POINTS = 2
SILENT = "a pit in a bearing fits best, and nothing strikes at its frequency"


def unless_silent(decision: Decision, direct: Direct, *, points: int, views: int) -> Decision:
    """None of the known effects, where all of those in the answer are pits of bearings whose impacts are not heard;
    `direct`: of a machine with teeth, against a baseline; `points`: operating points, `views`: those times sensors."""
    if decision.word not in ("explained", "ambiguous") or not direct.looked:
        return decision
    if points < FEWEST_POINTS or views <= FEW_VIEWS or not all(_silent(n, direct) for n in decision.chosen):
        return decision
    return replace(decision, word="unknown_physics", chosen=decision.chosen[:3], reasons=(SILENT,))


def _silent(name: str, direct: Direct) -> bool:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    if term is None or term.strikes not in DEFECTS or name in direct.present:
        return False  # a pit that has grown strikes before and after
    return abs(direct.evidence.get(name, 0.0)) < UNHEARD
