"""Which bearing, where several share the orders: the channels that stand at one hear it best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.judge import like_spacing, same
from reconcile.kinematics.lines import matched
from reconcile.kinematics.observe import Observation
from reconcile.verdict import PlaceWeight
from signals.series import FloatArray
from signals.units import UNCALIBRATED

DECIDED = 0.8
USUAL_SLIP = 0.01
"""Standard deviation of an order about its drawing's (R. B. Randall, J. Antoni, Mech. Syst. Signal Process. 25 (2011)
485-520, section 2: 1 to 2 %)."""

DB_OF_A_NAT = 6.0
"""Of level between two sensors for one unit of log odds: the nearer one hears some 10 dB more, but a resonance under
the other may make up for that."""
LEAST_SHARE = 1e-3
"""Of a level, below which its growth is not read."""
TINY = 1e-300


def places(
    candidate: Candidate, tests: Sequence[Observation], ties: Ties, baselines: Sequence[Observation] = ()
) -> tuple[PlaceWeight, ...]:
    """Sites that make the candidate's lines with their weights, the likeliest first; they sum to one.

    Bearings of one geometry on shafts of one speed have equal orders: then the score in the channels located at each
    of them decides, and how much louder these are; without such channels they weigh the same. Of bearings whose orders
    both lie within slip of the lines the one nearer to its drawing is likelier.
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
    told = drawn if np.any(np.isnan(values)) else drawn + values / 2 + _louder(sites, tests, baselines)
    weight = np.exp(told - np.max(told))
    weight /= np.sum(weight)
    order = np.argsort(-weight)
    return tuple(PlaceWeight(site=sites[i], weight=float(weight[i])) for i in order)


def _louder(sites: Sequence[str], tests: Sequence[Observation], baselines: Sequence[Observation]) -> FloatArray:
    """Log odds of each site by how loud its channels are, shape (sites,); 0 where the channels' levels cannot be
    compared.

    Channels of one quantity and known unit by the power that came over the baseline (all of it without one), others by
    their growth.
    """
    here = [c for t in tests for c in t.recording.channels if c.location in sites]
    absolute = len({(c.quantity, c.unit) for c in here}) == 1 and here[0].unit != UNCALIBRATED
    total = np.zeros(len(sites))
    for test in tests:
        base = matched(test, baselines)
        if base is None and not absolute:
            return np.zeros(len(sites))
        level = np.full(len(sites), -np.inf)
        for i, site in enumerate(sites):
            for name in (c.name for c in test.recording.channels if c.location == site):
                now = float(np.var(test.recording.series(name).samples))
                before = 0.0
                if base is not None and name in base.recording.names:
                    before = float(np.var(base.recording.series(name).samples))
                come = max(now - before, LEAST_SHARE * now)
                level[i] = max(level[i], 10.0 * float(np.log10(come if absolute else now / max(before, TINY))))
        if not np.all(np.isfinite(level)):
            return np.zeros(len(sites))
        total += (level - np.max(level)) / DB_OF_A_NAT / len(tests)
    return total


def _reaches(family: Family, named: Family, measured: float) -> bool:
    """Whether a family has the lines of the named one, or may have what was measured."""
    near = abs(measured / family.order - 1.0) <= family.slip and like_spacing(family, named)
    return near or same(family, named)


def decided(weights: Sequence[PlaceWeight]) -> bool:
    """Whether one site holds nearly all."""
    return bool(weights) and weights[0].weight >= DECIDED
