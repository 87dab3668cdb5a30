"""How much each effect counts against the others: forms of one, sets, places, parts that strike."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.judge.screen import Screen
from sim.terms import REGISTRY

FAR_AHEAD = 8.0
"""Log evidence by which an effect leads all others so that what it leaves is its size's or model's fault: clearances in
which rings strike are the least repeatable (s065 leads by 25 and leaves 5.9); unknown effects lead by 0.1 to 7.1."""
HOPELESS = 12.0
"""Log evidence behind the best effect from which one is not simulated again."""
SET_WEIGHT = 0.95
"""The answer is the smallest set of candidates that carries this weight: one name leads its next rival by 3 of log
evidence. A loose fit of 11 um was named a support that stiffens, 2.8 ahead of the fit (f007 of the proof); right names
looked at since lead by 4 and more."""
MOST_NAMED = 6
"""A set larger than this says nothing: the place or the mechanism is then not decidable."""
LEAST_EVIDENCE = 3.0
"""Log evidence a named cause needs over nothing missing."""
ALIKE = {"bent_shaft", "unbalance"}
"""An unbalance u and a bow u/m of one body are the same force on its bearings at every speed."""


def lead(screen: Screen) -> float:
    """Log evidence by which the best effect leads all that are not forms of it."""
    best = int(np.argmax(screen.evidence))
    others = [
        float(e)
        for name, e in zip(screen.names, screen.evidence, strict=True)
        if name != screen.names[best] and not variants(screen.names[best], name)
    ]
    return float(screen.evidence[best]) - max(others, default=-np.inf)


def of_the_place(screen: Screen) -> tuple[str, ...]:
    """The effects at the best one's site that lead all elsewhere, where the best leads those by `FAR_AHEAD`: a known
    kind of change in a form that none of them has. Unknown effects lead those elsewhere by 0.1 to 5.3, a loose fit and
    a pit beside a loose support, which no one effect met, by 12 and 13."""
    best = screen.names[int(np.argmax(screen.evidence))]
    site = best.split("@")[1]
    known = sorted(zip(screen.evidence, screen.names, strict=True), reverse=True)
    elsewhere = max((float(e) for e, name in known if name.split("@")[1] != site), default=-np.inf)
    if screen.evidence.max() < elsewhere + FAR_AHEAD:
        return ()
    least = max(elsewhere, 0.0) + LEAST_EVIDENCE
    chosen = tuple(name for e, name in known if name.split("@")[1] == site and e >= least)
    return chosen if len(chosen) > 1 else ()


def exclusive(first: str, second: str) -> bool:
    """Whether two labels cannot act together: one's term excludes the other's at that site."""
    (a, here), (b, there) = first.split("@"), second.split("@")
    one, other = REGISTRY.get(a), REGISTRY.get(b)
    if here != there or one is None or other is None or a == b:
        return False
    return b in one.excludes or a in other.excludes


def variants(first: str, second: str) -> bool:
    """Whether two labels are forms of one effect at one site: their terms exclude each other there. Where one alone
    excludes the other (a loose pedestal the loose fit, which has no support) they are two effects."""
    (a, _), (b, _) = first.split("@"), second.split("@")
    one, other = REGISTRY.get(a), REGISTRY.get(b)
    if one is None or other is None or not exclusive(first, second):
        return False
    return b in one.excludes and a in other.excludes


def merged_weights(screen: Screen) -> dict[str, float]:
    """Weight of each effect; forms of one effect at one site count together under the stronger."""
    order = np.argsort(-screen.weights)
    merged: dict[str, float] = {}
    for k in order:
        name = screen.names[int(k)]
        twin = next((m for m in merged if variants(m, name)), None)
        if twin is None:
            merged[name] = float(screen.weights[k])
        else:
            merged[twin] += float(screen.weights[k])
    return dict(sorted(merged.items(), key=lambda item: -item[1]))


def of_one_part(weights: dict[str, float], struck: Sequence[frozenset[str]]) -> dict[str, float]:
    """Where impacts come at the lines of several parts, what strikes at other lines than the likeliest effect is no
    rival of it but stands beside it."""
    best = next(iter(weights))
    if not any(best in part for part in struck):
        return weights
    others = {name for part in struck if best not in part for name in part}
    left = {name: weight for name, weight in weights.items() if name not in others}
    total = sum(left.values())
    return {name: weight / total for name, weight in left.items()}


def credible_set(weights: dict[str, float], level: float = SET_WEIGHT) -> tuple[str, ...]:
    """The smallest set of effects that carries `level` of the weight."""
    total, chosen = 0.0, []
    for name, weight in weights.items():
        chosen.append(name)
        total += weight
        if total >= level:
            break
    return tuple(chosen)


def of_the_set(weights: dict[str, float], chosen: Sequence[str]) -> dict[str, float]:
    """Weights of an answer that leaves `chosen` open, as sure as it is.

    Where these are not the set that the weights make (only impacts tell, or so few views that nothing which explains
    half as much is excluded), the answer does not trust what chooses among them, and they share alike.
    """
    own = set(credible_set(weights))
    if set(chosen) == own or not chosen or (len(chosen) == MOST_NAMED and set(chosen) < own):
        return weights
    if set(chosen) < own:
        total = sum(weights[name] for name in chosen)
        return {name: weights[name] / total for name in chosen}
    return {name: 1.0 / len(chosen) for name in chosen}


def plausible(screen: Screen) -> list[str]:
    """Effects that are not out of the question, the best first."""
    order = [int(k) for k in np.argsort(-screen.evidence)]
    return [screen.names[k] for k in order if screen.evidence[k] >= screen.evidence[order[0]] - HOPELESS]


def alike(first: str, second: str) -> bool:
    """Whether two effects (`effect@site`) are a bow and an unbalance of one body."""
    (a, here), (b, there) = first.split("@"), second.split("@")
    return here == there and {a, b} <= ALIKE
