"""Impacts at one angle of a shaft that turned too seldom for lines: the envelope of a band, folded turn by turn.

Of ten turns no comb of lines stands out of the floor, but ten blows at one angle do: the mean over the turns of the log
envelope at each angle, its largest against turns that are rotated at random, which keeps what each turn holds and takes
away that they agree (a rotation test, as in circular scan statistics: J. Glaz, J. Naus and S. Wallenstein, Scan
Statistics, Springer 2001, chapter 1).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.families import Ties
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.shafts import Impulsiveness
from reconcile.verdict import AngleWindow
from signals.series import FloatArray

LEAST_TURNS, MOST_TURNS = 4, 50
"""Of more turns lines stand out, and blows at one angle are a comb of the turn; a train at another order that a load
which turns makes louder at one angle is none."""
BINS, STEPS_A_BIN = 60, 2
"""Angles of a turn that are looked at, and steps of the envelope in each at least."""
ROTATIONS = 999
CHANCE = 0.01
"""Over all shafts."""


@dataclass(frozen=True, kw_only=True)
class SlowTurn:
    """A shaft at one angle of which a band's envelope is high in all its `turns`: `score` in standard deviations of
    turns that are rotated at random, `chance` of as much among these, over all shafts."""

    shaft: str
    turns: int
    score: float
    chance: float
    window: AngleWindow


def slow_turn(tests: Sequence[Observation], impacts: Impulsiveness, ties: Ties, seed: int) -> SlowTurn | None:
    """The shaft at one angle of which the impacts come, the firmest; None where they keep to none."""
    test = next(t for t in tests if t.label == impacts.label)
    values, per_turn = band_turns(test, impacts.channel, impacts.band_hz)
    channel = test.channel(impacts.channel)
    assert channel is not None
    known = channel.angle_rad[np.isfinite(channel.angle_rad)]
    found = []
    for number, (shaft, ratio) in enumerate(ties.shafts.items()):
        table = folded(values, per_turn / ratio)
        if table is None or len(table) > MOST_TURNS:
            continue
        level, score, chance = agreement(table, np.random.default_rng((seed, 91, number)))
        step = 360.0 / table.shape[1]
        first = float(np.degrees(known[0] * ratio)) % 360.0
        centre = (first + (int(np.argmax(level)) + 0.5) * step) % 360.0
        window = AngleWindow(shaft=shaft, centre_deg=centre, low_deg=centre - step, high_deg=centre + step)
        found.append(SlowTurn(shaft=shaft, turns=len(table), score=score, chance=chance, window=window))
    firm = [one for one in found if one.chance * len(found) < CHANCE]
    return max(firm, key=lambda one: one.score, default=None)


def folded(values: FloatArray, period: float) -> FloatArray | None:
    """Log of the means of `values` (steps,) over equal angles of each whole turn of `period` steps, (turns, angles);
    None for a shaft of too few turns, or too fast for steps this wide."""
    turns, bins = int(values.size / period), min(BINS, int(period / STEPS_A_BIN))
    if turns < LEAST_TURNS or bins < BINS // 2:
        return None
    edges = np.rint((np.arange(turns)[:, np.newaxis] + np.arange(bins + 1) / bins) * period).astype(np.int64)
    edges = np.clip(edges, 0, values.size)
    total = np.concatenate(([0.0], np.cumsum(values)))
    means = (total[edges[:, 1:]] - total[edges[:, :-1]]) / np.maximum(np.diff(edges, axis=1), 1)
    tiny = max(float(np.mean(values)) * 1e-6, np.finfo(np.float64).tiny)
    return np.asarray(np.log(np.maximum(means, tiny)))


def agreement(table: FloatArray, rng: np.random.Generator) -> tuple[FloatArray, float, float]:
    """(mean over turns at each angle (angles,), deviations of its largest over that of turns (turns, angles) rotated at
    random, chance of as much)."""
    turns, bins = table.shape
    level = np.mean(table, axis=0)
    places = (np.arange(bins) + rng.integers(0, bins, (ROTATIONS, turns, 1))) % bins
    rotated = np.mean(table[np.arange(turns)[:, np.newaxis], places], axis=1).max(axis=1)
    highest = float(np.max(level))
    spread = max(float(np.std(rotated)), 1e-12)
    chance = (1.0 + float(np.sum(rotated >= highest))) / (ROTATIONS + 1.0)
    return level, (highest - float(np.mean(rotated))) / spread, chance
