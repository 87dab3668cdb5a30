"""Which bearing, where several share the orders: the channels that stand at one hear it best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.judge import like_spacing, same
from reconcile.kinematics.observe import Observation
from reconcile.verdict import PlaceWeight

DECIDED = 0.8
USUAL_SLIP = 0.01
"""Standard deviation of an order about its drawing's (R. B. Randall, J. Antoni, Mech. Syst. Signal Process. 25 (2011)
485-520, section 2: 1 to 2 %)."""


def places(candidate: Candidate, tests: Sequence[Observation], ties: Ties) -> tuple[PlaceWeight, ...]:
    """Sites that make the candidate's lines with their weights, the likeliest first; they sum to one.

    Bearings of one geometry on shafts of one speed have equal orders: then the score in the channels located at each
    of them decides; without such channels they weigh the same. Of bearings whose orders both lie within slip of the
    lines the one nearer to its drawing is likelier.
    """
    measured = candidate.best.order
    alike = [f for f in ties.families if f.kind == candidate.family.kind and _reaches(f, candidate.family, measured)]
    sites = [f.site for f in alike]
    if len(sites) == 1:
        return (PlaceWeight(site=sites[0], weight=1.0),)
    slip = np.array([measured / f.order - 1.0 if not same(f, candidate.family) else candidate.best.slip for f in alike])
    drawn = -0.5 * (slip / USUAL_SLIP) ** 2
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
    # a deviation of lead is worth e^(1/2) only: scores of one source differ by a few between sensors
    told = drawn if np.any(np.isnan(values)) else drawn + values / 2
    weight = np.exp(told - np.max(told))
    weight /= np.sum(weight)
    order = np.argsort(-weight)
    return tuple(PlaceWeight(site=sites[i], weight=float(weight[i])) for i in order)


def _reaches(family: Family, named: Family, measured: float) -> bool:
    """Whether a family has the lines of the named one, or may have what was measured."""
    near = abs(measured / family.order - 1.0) <= family.slip and like_spacing(family, named)
    return near or same(family, named)


def decided(weights: Sequence[PlaceWeight]) -> bool:
    """Whether one site holds nearly all."""
    return bool(weights) and weights[0].weight >= DECIDED
