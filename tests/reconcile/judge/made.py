"""A made library: effects are directions in a space of features, sizes move along them, machines scatter around."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.pooled import OneByOne, Pooling
from reconcile.judge.space import Library

FAMILIES, MEMBERS = 12, 5
FEATURES = FAMILIES * MEMBERS
PAIRS = 48
DRAWS = 12
MEASURED_DB = 1.0
EFFECTS = ("one@a", "one@b", "two@a", "three@a")


@dataclass(frozen=True, kw_only=True)
class World:
    """Which families an effect moves, dB at full size, (effects, families), and how machines differ."""

    patterns: np.ndarray
    drift_db: float = 1.0
    scatter_db: float = 1.0

    def effect(self, c: int, share: float, rng: np.random.Generator) -> np.ndarray:
        """Change (F,) of effect `c` at logarithmic size `share`."""
        rise = np.repeat(self.patterns[c], MEMBERS) * (0.4 + 0.6 * share)
        moved = rise != 0
        return rise + moved * rng.normal(0.0, self.scatter_db, FEATURES)

    def healthy(self, rng: np.random.Generator, n: int) -> np.ndarray:
        """Drift of `n` healthy machines, (n, F)."""
        return rng.normal(0.0, self.drift_db, (n, FEATURES))

    def noise(self, rng: np.random.Generator) -> np.ndarray:
        """Measurement noise and drift of one observation, (F,)."""
        return self.healthy(rng, 1)[0] + rng.normal(0.0, MEASURED_DB, FEATURES)


def world() -> World:
    """Four effects: two share a family, so that places look a little alike; the last family belongs to nobody."""
    patterns = np.zeros((len(EFFECTS), FAMILIES))
    patterns[0, [0, 1, 2]] = 14.0
    patterns[1, [0, 3, 4]] = 14.0
    patterns[2, [5, 6, 7]] = 14.0
    patterns[3, [8, 9]] = -14.0
    return World(patterns=patterns)


def library(made: World, seed: int = 0) -> Library:
    """`DRAWS` draws an effect over all sizes."""
    rng = np.random.default_rng(seed)
    shares = np.tile((np.arange(DRAWS) + 0.5) / DRAWS, len(EFFECTS))
    owner = np.repeat(np.arange(len(EFFECTS)), DRAWS)
    drawn = np.stack([made.effect(int(c), float(u), rng) for c, u in zip(owner, shares, strict=True)])
    return Library(
        changes=drawn + made.healthy(rng, shares.size),
        groups={name: tuple(np.flatnonzero(owner == c).tolist()) for c, name in enumerate(EFFECTS)},
        shares=shares,
    )


def changes(made: World, observed: np.ndarray, seed: int = 0, *, points: int = 1) -> Changes:
    """One channel; two groups of features; no wander."""
    family = np.repeat(np.arange(FAMILIES), MEMBERS)
    names = tuple(f"f{k:02d}" for k in range(FAMILIES))
    return Changes(
        observed=observed,
        halves=np.stack([observed, observed]),
        measured=np.full(FEATURES, MEASURED_DB),
        null=made.healthy(np.random.default_rng([seed, 9]), PAIRS),
        starts=(0, FEATURES),
        with_baseline=True,
        groups=(np.arange(FEATURES) >= FEATURES // 2).astype(int),
        pooling=Pooling(family=family, names=names, points=points, channels=1),
        single=OneByOne(chosen=np.ones(FEATURES, dtype=bool), points=points, channels=1),
        sides=OneByOne(chosen=np.arange(FEATURES) < MEMBERS, points=points, channels=1),
        twice=OneByOne(chosen=np.zeros(FEATURES, dtype=bool), points=points, channels=1),
        wander=np.zeros((1, FEATURES)),
        kind=np.zeros((0, FEATURES)),
    )
