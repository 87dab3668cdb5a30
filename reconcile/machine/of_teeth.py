"""Which fault of a tooth is said first, where only the burst of one tooth tells that there is one."""

from __future__ import annotations

from dataclasses import replace

from reconcile.judge.screen import Screen
from reconcile.machine.decide import AS_GOOD, Decision
from sim.terms import REGISTRY

CRACK = "tooth_crack"
AS_GOOD_TEETH = 2 * AS_GOOD
"""Log evidence by which which machine happens to be near decides between faults of one tooth: of ten cracked teeth of
the proof a broken tooth of a fifth of the width led the crack by 0.1 to 1.6."""


def crack_first(decision: Decision, screen: Screen) -> Decision:
    """A set of nothing but faults of the teeth of one gear, with the crack in front where it is as good as the first.

    All of them soften one tooth, and soften it alike while that is little. A crack grows from nothing; what breaks off
    or out is seldom so small. That is no reason to leave the others out.
    """
    chosen = decision.chosen
    teeth = {term.key for term in REGISTRY if term.strikes == "tooth"}
    sites = {name.split("@")[1] for name in chosen}
    cracks = [name for name in chosen if name.split("@")[0] == CRACK]
    if (
        decision.word != "ambiguous"
        or not cracks
        or len(sites) != 1
        or any(n.split("@")[0] not in teeth for n in chosen)
    ):
        return decision
    told = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    if max(told[n] for n in chosen) - told[cracks[0]] > AS_GOOD_TEETH:
        return decision
    return replace(decision, chosen=(cracks[0], *(n for n in chosen if n != cracks[0])))
