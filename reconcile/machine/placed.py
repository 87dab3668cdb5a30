"""Where to look: the places of what is named, or may be, with their weights."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from reconcile.machine.second import Beside
from reconcile.verdict import PlaceWeight

OPEN_SECOND = 1.0 / 3.0
"""Weight of the places of a second effect that is one of several: less than that of the one that is named."""


def places(weights: Mapping[str, float]) -> tuple[PlaceWeight, ...]:
    """Sites by the weight of the effects (`effect@site`) at them, the heaviest first."""
    total: dict[str, float] = {}
    for name, weight in weights.items():
        site = name.split("@")[1]
        total[site] = total.get(site, 0.0) + weight
    ordered = sorted(total.items(), key=lambda item: -item[1])
    return tuple(PlaceWeight(site=s, weight=w) for s, w in ordered if w > 0.01)


def with_second(weights: Mapping[str, float], other: Beside | None) -> dict[str, float]:
    """Half of the weight for each of two effects."""
    if other is None:
        return dict(weights)
    own = np.exp(other.evidence - other.evidence[0])
    second = {name: 0.5 * float(w) for name, w in zip(other.names, own / own.sum(), strict=True)}
    return {name: 0.5 * weights.get(name, 0.0) + second.get(name, 0.0) for name in {**weights, **second}}


def with_open(weights: Mapping[str, float], others: Sequence[str]) -> dict[str, float]:
    """A third of the weight for what stands beside a named effect and is one of several, alike."""
    beside = dict.fromkeys(others, OPEN_SECOND / max(len(others), 1))
    rest = 1.0 - OPEN_SECOND if others else 1.0
    return {name: rest * weights.get(name, 0.0) + beside.get(name, 0.0) for name in {**weights, **beside}}
