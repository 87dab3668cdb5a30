"""Which bearing, where several share the orders: the channels that stand at one hear it best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.kinematics.judge import Candidate, same
from reconcile.kinematics.observe import Observation
from reconcile.verdict import PlaceWeight

DECIDED = 0.8


def places(candidate: Candidate, tests: Sequence[Observation], ties: Ties) -> tuple[PlaceWeight, ...]:
    """Sites that make the candidate's lines with their weights, the likeliest first; they sum to one.

    Bearings of one geometry on shafts of one speed have equal orders: then the score in the channels located at each
    of them decides; without such channels they weigh the same.
    """
    sites = [f.site for f in ties.families if f.kind == candidate.family.kind and same(f, candidate.family)]
    if len(sites) == 1:
        return (PlaceWeight(site=sites[0], weight=1.0),)
    heard = []
    for site in sites:
        scores = [
            e.channel_z[c.name]
            for e, t in zip(candidate.evidence, tests, strict=True)
            for c in t.recording.channels
            if c.location == site and c.name in e.channel_z
        ]
        heard.append(max(scores) if scores else np.nan)
    values = np.asarray(heard)
    if np.any(np.isnan(values)):
        return tuple(PlaceWeight(site=s, weight=1 / len(sites)) for s in sites)
    # a deviation of lead is worth e^(1/2) only: scores of one source differ by a few between sensors
    weight = np.exp((values - np.max(values)) / 2)
    weight /= np.sum(weight)
    order = np.argsort(-weight)
    return tuple(PlaceWeight(site=sites[i], weight=float(weight[i])) for i in order)


def decided(weights: Sequence[PlaceWeight]) -> bool:
    """Whether one site holds nearly all."""
    return bool(weights) and weights[0].weight >= DECIDED
