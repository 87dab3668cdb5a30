"""What is drawn of a background: once a machine, by the recipe's seed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sideband_datasets.plan.machines import Machine
from sideband_datasets.plan.seeds import Stream, generator
from sideband_datasets.recipe.background import Background, FreeAxis, Knocks, Neighbours, Rolling
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.values import Value, drawn
from signals.background import Train

FOLLOWED = ("shaft", "twice_shaft", "outer", "inner", "ball", "cage", "foreign")


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Rolling noise: its level, what depth it follows each of `FOLLOWED` by, and the order of the foreign line."""

    level: float
    depths: Mapping[str, float]
    foreign_order: float


@dataclass(frozen=True, kw_only=True)
class Axis:
    """How the axes of the balls are free."""

    stay_s: float
    slip: float
    inside: float


@dataclass(frozen=True, kw_only=True)
class Ground:
    """What sounds beside one machine. Levels of ingredients are relative to `level`, which is relative to the RMS
    acceleration of the sound machine; `trains` count impulses per turn of the driven shaft instead of per second."""

    level: float
    rolling: Noise | None = None
    knocks: tuple[float, float] | None = None
    """Level, number a second."""
    neighbours: tuple[float, tuple[Train, ...]] | None = None
    """Level, trains."""
    axis: Axis | None = None


def ground_of(recipe: Recipe, machine: Machine) -> Ground | None:
    """The background of a machine, a pure function of the recipe and the machine; None without one."""
    block = recipe.background
    if block is None:
        return None
    rng = generator(recipe.seed, Stream.BACKGROUND, machine.seed)
    level = _one(rng, block.level)
    # Each ingredient has numbers of its own: what another one draws does not move them.
    own = dict(zip(("rolling", "knocks", "neighbours", "free_axis"), rng.spawn(4), strict=True))
    return Ground(
        level=level,
        rolling=_rolling(own["rolling"], block),
        knocks=_knocks(own["knocks"], block),
        neighbours=_neighbours(own["neighbours"], block),
        axis=_axis(own["free_axis"], block),
    )


def _one(rng: np.random.Generator, value: Value) -> float:
    return float(drawn(value, float(rng.random()), None, "background"))


def _has(rng: np.random.Generator, block: Rolling | Knocks | Neighbours | FreeAxis) -> bool:
    return bool(rng.random() < block.share)


def _rolling(rng: np.random.Generator, block: Background) -> Noise | None:
    found = block.rolling
    if found is None or not _has(rng, found):
        return None
    level, foreign = _one(rng, found.level), _one(rng, found.foreign_order)
    return Noise(level=level, foreign_order=foreign, depths={n: _one(rng, getattr(found, n)) for n in FOLLOWED})


def _knocks(rng: np.random.Generator, block: Background) -> tuple[float, float] | None:
    found = block.knocks
    if found is None or not _has(rng, found):
        return None
    return _one(rng, found.level), _one(rng, found.per_s)


def _neighbours(rng: np.random.Generator, block: Background) -> tuple[float, tuple[Train, ...]] | None:
    found = block.neighbours
    if found is None or not _has(rng, found):
        return None
    level, count = _one(rng, found.level), round(_one(rng, found.trains))
    values = (found.order, found.slip, found.swing, found.slow, found.size)
    names = ("per_s", "slip", "swing", "slow", "size")
    trains = [Train(**{n: _one(rng, v) for n, v in zip(names, values, strict=True)}) for _ in range(count)]
    return level, tuple(trains)


def _axis(rng: np.random.Generator, block: Background) -> Axis | None:
    found = block.free_axis
    if found is None or not _has(rng, found):
        return None
    return Axis(stay_s=_one(rng, found.stay_s), slip=_one(rng, found.slip), inside=_one(rng, found.inside))
