"""Sizes of two effects searched together, where what they show alone says little of what they show beside each other.

A loose fit rattles otherwise under an unbalance than without: the first effect, fitted alone, is as large as it must be
to explain both, sums choose a second of the wrong size, and machines moved from there by what they show get nowhere.
So starts are spread over the sizes of both, and machines between the likeliest of all that were simulated are tried, in
turns. What counts are the last, which were not chosen.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.candidates import size_parameter, sought_range
from reconcile.calibrate.uncertain import Offsets
from reconcile.machine.asked import TEMPER, Asked
from reconcile.machine.assimilate import Ensemble, packed, simulated_again, unpacked
from reconcile.machine.library import Catalogued
from reconcile.machine.pairs import Simulated
from reconcile.machine.refine import known_term
from reconcile.machine.setting import Setting
from sim.core.params import Param
from sim.core.spec import TermSpec

VARIED = 6
"""Draws of the second from which its other parameters are taken, in turn."""
SMALLEST_FIRST = 0.25
"""Of the first's size alone, from which on it is sought beside the second."""
APART = 4.0
"""Times by which the second's sizes are spread about those of its best sums."""
PARENTS, TURNS = 4, 6
"""Machines between so many of the likeliest are tried, so often at most;"""
NEAR, NEARER = 0.3, 0.7
"""at first so far aside, in logarithms, and each time so much less."""
ENOUGH = 60.0
"""Log likelihood over the first alone, of the better half of one turn's machines, from which no further are tried;"""
HOPELESS, HOPELESS_AFTER = -100.0, 3
"""and of the best of all after so many turns, below which none are."""


@dataclass(frozen=True, kw_only=True)
class Trial:
    """A machine with both effects."""

    offsets: Offsets
    first: TermSpec
    second: TermSpec


def searched(asked: Asked, start: Ensemble, rows: Sequence[int], beat: float = 0.0) -> Simulated | None:
    """The last machines with both effects; None where too few run. `start`: machines with the first alone, the nearest
    first; `rows`: of `asked.every`, draws of the second, the best first; `beat`: what another second adds, beyond which
    these must be enough."""
    every, count = asked.every, 2 * asked.members
    own = [(start.offsets[k % len(start.terms)], start.terms[k % len(start.terms)]) for k in range(count)]
    draws = [every.terms[rows[k % min(VARIED, len(rows))]] for k in range(count)]
    trials = spread(
        asked.setting, [Trial(offsets=o, first=a, second=b) for (o, a), b in zip(own, draws, strict=True)], asked.first
    )
    rng = np.random.default_rng([asked.setting.seed, 29, *f"{asked.first}+{draws[0].term}@{draws[0].site}".encode()])
    pool: list[tuple[float, Trial]] = []
    turn = 0
    while (more := _shown(asked, start, trials)) is not None:
        told = asked.left.likelihood(more.library.changes) - asked.left.base
        pool += [(float(value), trials[k]) for value, k in zip(told, more.pairs, strict=True)]
        pool = sorted(pool, key=lambda one: -one[0])[:PARENTS]
        if turn > 0 and _settled(turn, float(np.sort(told)[told.size // 2 :].mean()) - beat, pool[0][0]):
            return Simulated(known=more, also=tuple(t.second for t in trials), gains=told / TEMPER)
        trials = tuple(_between([t for _, t in pool], NEAR * NEARER**turn, rng) for _ in range(asked.members))
        turn += 1
    return None


def _settled(turn: int, level: float, best: float) -> bool:
    """Whether these machines are good enough, none after so many turns comes near, or no turn is left."""
    return level >= ENOUGH or (turn >= HOPELESS_AFTER and best < HOPELESS) or turn == TURNS


def _shown(asked: Asked, start: Ensemble, trials: Sequence[Trial]) -> Catalogued | None:
    offsets, terms = [t.offsets for t in trials], [t.first for t in trials]
    also = [t.second for t in trials]
    return simulated_again(asked.setting, start.candidate, offsets, terms, asked.mapper, also=also)


def spread(setting: Setting, firsts: Sequence[Trial], label: str) -> tuple[Trial, ...]:
    """As many machines whose sizes are spread over both ranges, every stretch of each once, as `firsts` are in all
    else; `label` is the first effect's."""
    count = len(firsts)
    rng = np.random.default_rng([setting.seed, 31, *label.encode()])
    own, other = _size(firsts[0].first), _size(firsts[0].second)
    sought = sought_range(setting.machine, known_term(firsts[0].second.term), firsts[0].second.site)
    middle = float(np.exp(np.mean([np.log(abs(t.second.parameters[other.name])) for t in firsts[:PARENTS]])))
    low, high = max(sought[0], middle / APART), min(sought[1], middle * APART)
    shares = [(rng.permutation(count) + 0.5) / count for _ in range(2)]
    found = []
    for k in range(count):
        start = firsts[k % len(firsts)]
        smaller = start.first.parameters[own.name] * SMALLEST_FIRST ** shares[0][k]
        size = low ** (1.0 - shares[1][k]) * high ** shares[1][k]
        found.append(
            Trial(
                offsets=start.offsets, first=sized(start.first, own, smaller), second=sized(start.second, other, size)
            )
        )
    return tuple(found)


def _between(parents: Sequence[Trial], spread: float, rng: np.random.Generator) -> Trial:
    """Somewhere between two of them, and a little aside: `spread` of logarithms, and of angles."""
    one, other = (parents[int(k)] for k in rng.integers(0, len(parents), 2))
    share = rng.uniform()

    def mixed(a: TermSpec, b: TermSpec) -> TermSpec:
        middle = share * packed(a) + (1.0 - share) * packed(b)
        return unpacked(a, middle + spread * rng.standard_normal(middle.size))

    return Trial(
        offsets=one.offsets.mixed(Offsets(values=other.offsets.values - one.offsets.values), 1.0 - share),
        first=mixed(one.first, other.first),
        second=mixed(one.second, other.second),
    )


def _size(term: TermSpec) -> Param:
    return size_parameter(known_term(term.term))


def sized(term: TermSpec, size: Param, value: float) -> TermSpec:
    """The same effect of another size, within what the size may be."""
    bounded = float(np.copysign(np.clip(abs(value), size.low, size.high), value))
    return term.model_copy(update={"parameters": {**term.parameters, size.name: bounded}})
