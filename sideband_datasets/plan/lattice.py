"""A few of all combinations of levels: pairs of factors as evenly as their number allows."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache
from itertools import combinations

import numpy as np

from sideband_datasets.plan.quotas import IntArray
from sideband_datasets.plan.seeds import Stream, generator
from signals.series import FloatArray

GOLDEN = 0.6180339887498949
MOST_CHOSEN = 512
"""Combinations that are chosen one by one; more are taken in golden-ratio strides, which so many points fill evenly."""
CANDIDATES = 256
"""Of which the next is chosen, where there are more combinations than `ALL`."""
ALL = 1024


def factorial_point(levels: Sequence[int], k: int, count: int, seed: int, stream: Stream, number: int) -> FloatArray:
    """Combination k of all levels, each level's place from 0 to 1 (the middle where there is one level).

    As often as all combinations fit into `count` they come one after the other; of the rest each pair of levels of two
    factors is taken about as often as any other.
    """
    size = math.prod(levels)
    whole = count // size * size
    if k < whole:
        place = k % size
    elif count - whole <= MOST_CHOSEN:
        place = _chosen(tuple(levels), count - whole, seed, stream, number)[k - whole]
    else:
        place = (k - whole) * _stride(size) % size
    digits = _digits(place, levels)
    return np.asarray([d / (n - 1) if n > 1 else 0.5 for d, n in zip(digits, levels, strict=True)], dtype=np.float64)


def _digits(place: int, levels: Sequence[int]) -> list[int]:
    found = []
    for level in levels:
        place, digit = divmod(place, level)
        found.append(digit)
    return found


def _stride(size: int) -> int:
    step = max(1, round(GOLDEN * size))
    while math.gcd(step, size) != 1:
        step += 1
    return step


@lru_cache(maxsize=64)
def _chosen(levels: tuple[int, ...], count: int, seed: int, stream: Stream, number: int) -> tuple[int, ...]:
    """Different combinations, by their numbers: the next is always the one whose levels, then pairs of levels, were
    taken least; drawn among those alike."""
    size, rng = math.prod(levels), generator(seed, stream, number)
    pairs = list(combinations(range(len(levels)), 2))
    widths = [levels[a] * levels[b] for a, b in pairs]
    # Levels of each factor, then of each pair, in one table; a rare one (of many levels) counts for as much as another.
    sizes = np.asarray([*levels, *widths])
    first = np.cumsum(sizes) - sizes
    weight = sizes * np.where(np.arange(sizes.size) < len(levels), max(len(pairs), 1), 1)
    taken = np.zeros(int(sizes.sum()), dtype=np.int64)
    used: dict[int, None] = {}
    left = list(range(size)) if size <= ALL else []
    while len(used) < count:
        places = left if left else _others(size, used, rng)
        cells = first + _cells(places, levels, pairs)
        cost = (taken[cells] * weight).sum(axis=1)
        best = int(rng.choice(np.flatnonzero(cost == cost.min())))
        taken[cells[best]] += 1
        used[places[best]] = None
        if left:
            left.pop(best)
    return tuple(used)


def _others(size: int, used: dict[int, None], rng: np.random.Generator) -> list[int]:
    """Some combinations that were not taken yet."""
    found: list[int] = []
    while not found:
        # Sizes may be beyond any integer of the generator: a share of the whole is exact enough to draw by.
        found = [place for place in (int(u * size) for u in rng.random(CANDIDATES)) if place not in used]
    return found


def _cells(places: Sequence[int], levels: Sequence[int], pairs: Sequence[tuple[int, int]]) -> IntArray:
    """Level of each factor, then of each pair, shape (places, factors + pairs)."""
    digits = np.asarray([_digits(place, levels) for place in places], dtype=np.int64)
    joint = [digits[:, a] * levels[b] + digits[:, b] for a, b in pairs]
    return np.column_stack([digits, *joint])
