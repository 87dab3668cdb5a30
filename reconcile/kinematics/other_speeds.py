"""At which other speeds would the impacts be those of another part? Asked where nothing confirms the stated one.

Without a line of the shaft a recording tells rates in Hz, not orders: outer races of two bearings whose orders are 17 %
apart are one to it if the speed may be 17 % off. Looked for first by the comb alone at every rate that the part has
at speeds whose label may be `SPAN` wrong, then, within its slip, at the speed that fits its sidebands and the shafts'
own lines in the envelopes best; then with all controls, as at the stated speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.candidate import DEFECTS, LEAST_Z
from reconcile.kinematics.comb_scores import LEAST_SPREAD, scores
from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.evidence import family_evidence, logs, without
from reconcile.kinematics.families import Family, Ties
from reconcile.kinematics.judge import HEARD_Z
from reconcile.kinematics.observe import MOST_DOUBT, Observation
from signals.series import FloatArray

SPAN = 0.2
"""Share by which a stated speed may be wrong for the right one to be looked at: twice the interval in which the lines
of the shaft are looked for (`reconcile.speed`); labels 7 % off have been met. Twice and half are looked at apart."""
NEAR = 0.015
"""Relative difference up to which two recordings are at one speed, as for baselines and tests."""
CHUNK = 4096
"""Trials at a time, which bounds the memory."""
RATES = 3
"""Strongest rates of a family that are looked at with sidebands."""
SHARPEST = 4
"""Harmonic of a shaft that moves by a bin from one speed to the next: lines are looked for a bin to either side."""
USUAL_SLIP = 0.01
"""Standard deviation of an order from the drawing's: 1 to 2 % are common (Randall & Antoni 2011, section 2)."""
MOST = 3
"""Other speeds that are judged in full, the firmest first: each costs as much as the stated one."""
BEHIND_Z = 4.5
"""Of the firmest: one this far behind is not judged. Of those judged none is told that is 3 behind (`unread`); the
scores here and there scatter apart by 1.5."""


@dataclass(frozen=True, kw_only=True)
class Nominee:
    """`family` would make the impacts at `factor` times the stated speed, with a score `z` over orders of no part."""

    factor: float
    family: Family
    z: float


def by_baseline(tests: Sequence[Observation], baselines: Sequence[Observation]) -> bool:
    """Whether the lines of a baseline say that each stated speed of the tests is the one the machine turns at."""
    sure = [b.speed.speed_hz for b in baselines if b.speed.method != "stated"]
    open_ones = [t.speed.speed_hz for t in tests if t.speed.method == "stated"]
    return all(any(abs(hz / own - 1.0) <= NEAR for hz in sure) for own in open_ones)


def nominees(tests: Sequence[Observation], ties: Ties, least: float, seed: int) -> tuple[Nominee, ...]:
    """At most `MOST` other speeds, by the parts that are firmest there: `least` and what a name needs, the firmest
    first, no two within the slip of each other."""
    stated = [t for t in tests if t.speed.method == "stated"]
    found = []
    for family in (f for f in ties.families if f.kind in DEFECTS):
        for factor in _factors(stated, ties, family):
            z = _score(stated, ties, family, factor, seed)
            if z >= max(least, LEAST_Z):
                found.append(Nominee(factor=factor, family=family, z=z))
    chosen: list[Nominee] = []
    for one in sorted(found, key=lambda n: -n.z):
        near = not chosen or one.z > chosen[0].z - BEHIND_Z
        if near and len(chosen) < MOST and all(abs(one.factor / c.factor - 1.0) > one.family.slip for c in chosen):
            chosen.append(one)
    return tuple(chosen)


def at_speed(ties: Ties, factor: float) -> Ties:
    """All orders as those of the stated speed, where the shaft really turns `factor` times as fast."""
    return replace(
        ties,
        shafts={name: ratio * factor for name, ratio in ties.shafts.items()},
        families=tuple(replace(f, order=f.order * factor, spacing=f.spacing * factor) for f in ties.families),
    )


def _score(tests: Sequence[Observation], ties: Ties, family: Family, factor: float, seed: int) -> float:
    """Root mean square over the tests of the family's score with its controls at that speed."""
    number = ties.families.index(family)
    scaled = at_speed(ties, factor)
    rows = []
    for i, test in enumerate(tests):
        rng = np.random.default_rng((seed, i, number))
        own = scaled.families[number]
        rows.append(max(family_evidence(test.channels, scaled, own, MOST_DOUBT, rng, certain_z=HEARD_Z).z, 0.0))
    return float(np.sqrt(np.mean(np.square(rows))))


def _factors(tests: Sequence[Observation], ties: Ties, family: Family) -> list[float]:
    """The one best factor of the family, away from the stated speed: there the rates within the slip are the part's as
    it is."""
    own = family.slip + MOST_DOUBT
    step = min(e.order_step for t in tests for e in t.channels) / (family.harmonics * family.order)
    grid = np.arange((1.0 - family.slip) / (1.0 + SPAN), (1.0 + family.slip) / (1.0 - SPAN), step)
    grid = grid[np.abs(grid - 1.0) > own]
    bare = replace(family, sidebands=0)
    total = np.zeros(grid.size)
    for test in tests:
        total += np.max([_standing(e, ties, bare, grid) for e in test.channels], axis=0)
    rates: list[float] = []
    for place in np.argsort(-total):
        if len(rates) == RATES:
            break
        if all(abs(grid[place] / r - 1.0) > own for r in rates):
            rates.append(float(grid[place]))
    score, factor = max(_spaced(tests, ties, family, rate) for rate in rates)
    return [] if np.isinf(score) else [factor]


def _standing(e: Envelopes, ties: Ties, bare: Family, grid: FloatArray) -> FloatArray:
    """Standardised comb scores at the rates `grid` times the family's, the best band of each, shape (grid,)."""
    values = logs(e, ties, shaft_lines=False)
    table = np.concatenate(
        [scores(values, e, bare, grid[i : i + CHUNK] * bare.order) for i in range(0, grid.size, CHUNK)], axis=1
    )
    centre = np.median(table, axis=1, keepdims=True)
    spread = np.maximum(1.4826 * np.median(np.abs(table - centre), axis=1, keepdims=True), LEAST_SPREAD)
    return np.asarray(np.max((table - centre) / spread, axis=0), dtype=np.float64)


def _spaced(tests: Sequence[Observation], ties: Ties, family: Family, rate: float) -> tuple[float, float]:
    """(score, factor) of the speed at which `rate` times the family's order, its sidebands and the shafts' own lines in
    the envelopes fit best, within the slip.

    At a speed a little off, the shafts' lines would not be taken out: the fifth of a shaft lies where the inner race of
    a 6203 would be. The family's own harmonics are left out of them: seven turns may be two periods of an outer race.
    """
    step = min(e.order_step for t in tests for e in t.channels) / SHARPEST
    count = max(1, int(np.ceil(family.slip / step)))
    slips = np.arange(-count, count + 1) * (family.slip / count)
    factors = np.asarray(rate / (1.0 + slips), dtype=np.float64)
    within = (factors >= 1.0 / (1.0 + SPAN)) & (factors <= 1.0 / (1.0 - SPAN))
    if not np.any(within):
        return -np.inf, 1.0
    slips, factors = slips[within], factors[within]
    base = np.full(1, rate * family.order)
    total = -0.5 * (slips / USUAL_SLIP) ** 2
    turns = [f for f in ties.families if f.kind == "turn"]
    for test in tests:
        rows = []
        for e in test.channels:
            values = logs(e, ties, shaft_lines=False)
            rest = without(logs(e, ties, shaft_lines=True), e, [], float(base[0]))
            at = [scores(values, e, replace(family, spacing=family.spacing * f), base)[:, 0] for f in factors]
            shaft = [np.max(scores(rest, e, turn, factors * turn.order), axis=0) for turn in turns]
            rows.append(np.max(np.stack(at), axis=1) + np.sum(shaft, axis=0))
        total += np.max(rows, axis=0)
    best = int(np.argmax(total))
    return float(total[best]), float(factors[best])
