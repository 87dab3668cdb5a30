"""Which fault of a tooth it is, where one tooth of a gear differs: mostly open, and then the crack is said first."""

from __future__ import annotations

from dataclasses import replace

from reconcile.judge.screen import Screen
from reconcile.machine.decide import AS_GOOD, MECHANISM_OPEN, Decision
from sim.terms import REGISTRY

CRACK = "tooth_crack"
ALIKE_TEETH = {"missing_tooth", "tooth_spall"}
AS_GOOD_TEETH = 2 * AS_GOOD
"""Log evidence by which which machine happens to be near decides between faults of one tooth: of ten cracked teeth of
the proof a broken tooth of a fifth of the width led the crack by 0.1 to 1.6."""
APART = 12.0
"""Log evidence by which one fault of a tooth must lead the others of that gear to be named alone: a pitted flank was
named a broken tooth, 7.7 ahead of a crack and 10.2 ahead of a pit (g003 of the proof)."""


def of_teeth(decision: Decision, screen: Screen) -> Decision:
    """A name that is a fault of a tooth as the set of those that are not far behind it; a set of nothing but faults of
    the teeth of one gear with the crack in front where it is as good as the first.

    All of them soften one tooth, and soften it alike while that is little. A crack grows from nothing; what breaks off
    or out is seldom so small. That is no reason to leave the others out.
    """
    told = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    if decision.word == "explained" and _of_a_tooth(decision.chosen[0]):
        first = decision.chosen[0]
        near = [n for n in told if of_one_gear(n, first) and (told[n] > told[first] - APART or look_alike(n, first))]
        if len(near) == 1:
            return decision
        chosen = tuple(sorted(near, key=lambda n: -told[n]))
        decision = replace(decision, word="ambiguous", chosen=chosen, reasons=(MECHANISM_OPEN,))
    return _crack_first(decision, told)


def _crack_first(decision: Decision, told: dict[str, float]) -> Decision:
    chosen = decision.chosen
    cracks = [name for name in chosen if name.split("@")[0] == CRACK]
    others = [name for name in chosen if not _of_a_tooth(name)]
    if decision.word != "ambiguous" or not cracks or others or len({_site(n) for n in chosen}) != 1:
        return decision
    if max(told[n] for n in chosen) - told[cracks[0]] > AS_GOOD_TEETH:
        return decision
    return replace(decision, chosen=(cracks[0], *(n for n in chosen if n != cracks[0])))


def of_one_gear(name: str, other: str) -> bool:
    """Whether both effects (`effect@site`) are faults of a tooth of one gear."""
    return _of_a_tooth(name) and _of_a_tooth(other) and _site(name) == _site(other)


def look_alike(name: str, other: str) -> bool:
    """Whether they are a broken and a pitted tooth of one gear: a pit of most of a flank carries as little as a tooth
    that is gone. One of 0.89 of the flank was named a broken tooth, 33 ahead of a crack (g007 of the proof)."""
    return looks_like(name) == other


def looks_like(name: str) -> str:
    """The other of a broken and a pitted tooth of that gear; empty for what is neither."""
    term, site = name.split("@")
    other = ALIKE_TEETH - {term}
    return f"{other.pop()}@{site}" if term in ALIKE_TEETH else ""


def _of_a_tooth(name: str) -> bool:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    return term is not None and term.strikes == "tooth"


def _site(name: str) -> str:
    return name.split("@")[1]
