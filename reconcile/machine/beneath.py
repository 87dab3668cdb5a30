"""A pattern beneath the burst of a tooth: where one tooth differs for sure and all else that changed is another's.

The burst is evidence of a fault of a tooth alone, and none against what moves the lines of the machine: added to a
tooth's own faint pattern it makes that lead what explains the change.
"""

from __future__ import annotations

from reconcile.judge.screen import Screen
from reconcile.machine.weigh import FAR_AHEAD, HOPELESS, LEAST_EVIDENCE, variants
from sim.terms import REGISTRY


def beneath_a_tooth(screen: Screen, sure: float) -> tuple[str, ...]:
    """The effect whose pattern leads that of every other, faults of teeth among them, by `FAR_AHEAD`, and is more than
    `HOPELESS`, where the first is a fault of a tooth with impacts of `sure` log evidence or more; else none.

    A loose fit of 44 um beside a crack of a tooth: patterns of 18 and 4.3, and 23 of the burst, with which the tooth
    led and the fit was not asked (m038 of the proof)."""
    first = max(range(len(screen.names)), key=lambda k: float(screen.evidence[k]))
    term = REGISTRY.get(screen.names[first].split("@", maxsplit=1)[0])
    if term is None or term.strikes != "tooth" or screen.direct[first] < sure:
        return ()
    patterns = dict(zip(screen.names, map(float, screen.patterns), strict=True))
    heard = dict(zip(screen.names, map(float, screen.direct), strict=True))
    best = max(patterns, key=lambda name: patterns[name])
    others = [value for name, value in patterns.items() if name != best and not variants(name, best)]
    if heard[best] >= LEAST_EVIDENCE or patterns[best] < HOPELESS:
        return ()
    return (best,) if patterns[best] >= max(others, default=0.0) + FAR_AHEAD else ()
