"""Units and swapped channels beside a fault of the machine: only by what such a fault leaves alone.

A fault adds power, in some bands and at some moments. So the level of the quiet moments of a band falls by the sensor
alone, and where it did not rise it stays what it was. A unit moves the floor of all bands by its ratio; the signal of
another channel misses the floor of this one in bands that a fault did not touch, or falls below it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from reconcile.gate.levels import Pair
from reconcile.gate.steps import exchanged_steps
from reconcile.gate.units import possible
from signals.series import BoolArray, FloatArray

LEAST_BANDS = 8
DRIFT_DB = 2.5
"""By which a channel's gain may drift (1.5 dB) and its floor be found wrong."""
FLOOR_PERCENTILE = 10.0
FLOOR_DB = 2.5
"""Half width of the bands that count as the floor of the changes."""
BELOW_SHARE = 0.05
"""Of the bands may lie below it: a machine's fault takes nothing away, a mount does."""
EVEN_DB = 1.0
EVEN_SHARE, HALF_SHARE = 0.4, 0.2
"""Of the bands and of each half of them, within `EVEN_DB` of the median of those on the floor: what is above then needs
no impacts to be told from a mount, which falls on and on, or from noise that a fault adds, here more and there less."""
IMPACT_DB, IMPACT_SHARE = 1.0, 0.6
"""By which impacts raise a band's mean over its quiet moments, more than noise of any level; in most bands above."""
DROWNED_DB = 5.0
"""The same on the floor: from there on impacts overlap and raise the quiet moments too (made impacts: up to 5.0 dB
where the floor rose by less than 3 dB, from 6.5 on where by more)."""
LIFT = 0.5
"""By which, of that, impacts may have raised the floor."""
SPREAD_DB = 1.0
REACH_DB = 40.0
"""By which a fault may raise a band."""
OUTLIER = 1e-4
CLEARLY = 0.45
"""Mean log likelihood of a band by which exchanged channels must fit better (made gears with faults that raise bands by
up to 35 dB: what is not exchanged fits better by at least -0.1, what is by 0.6 where a quarter of the bands is left
alone)."""
FITS = -3.2
"""Mean log likelihood of a band from which a channel is recognised at all (untouched -1.7, all raised -4.4)."""


@dataclass(frozen=True, kw_only=True)
class Floor:
    """The change, dB, of the bands of a channel that no fault raised, and by how much impacts may have raised it."""

    change_db: float
    lift_db: float

    def may_be(self, gain_db: float) -> bool:
        """Whether a gain explains the change."""
        return -DRIFT_DB <= self.change_db - gain_db <= DRIFT_DB + self.lift_db


def robust_unit_gain(pairs: Sequence[Pair], c: int) -> float | None:
    """The ratio of two units, dB, by which the floor of channel `c` changed while another channel kept its own, or all
    changed by the same; else None. A lone channel has nothing to be held against."""
    floors = [_floor(pairs, k) for k in range(len(pairs[0].names))]
    ratios = [_ratio(f, channel.quantity) for f, channel in zip(floors, pairs[0].channels, strict=True)]
    if ratios[c] is None or len(floors) < 2:
        return None
    kept = any(f is not None and f.may_be(0.0) for k, f in enumerate(floors) if k != c)
    return ratios[c] if kept or all(r == ratios[c] for r in ratios) else None


def _ratio(floor: Floor | None, quantity: str) -> float | None:
    """The signed ratio of units, dB, that explains a change of a channel of a quantity."""
    exact = [sign * 20 * float(np.log10(r)) for r in possible(quantity).values() for sign in (-1, 1)]
    fitting = [x for x in exact if floor is not None and floor.may_be(x)]
    return fitting[0] if len(fitting) == 1 else None


def _floor(pairs: Sequence[Pair], c: int) -> Floor | None:
    """The floor of the changes of channel `c` over all bands and pairs; None where none can be told."""
    heard = _with_bands(pairs)
    if not heard:
        return None
    change = np.concatenate([p.quiet_change[c] for p in heard])
    impacts = np.concatenate([p.crest_change[c] for p in heard])
    floor = float(np.percentile(change, FLOOR_PERCENTILE))
    near = change[np.abs(change - floor) <= FLOOR_DB]
    level = float(np.median(near)) if near.size else floor
    inside = [np.abs(p.quiet_change[c] - level) <= EVEN_DB for p in heard]
    above = change > floor + FLOOR_DB
    drowned = float(np.median(impacts[~above]))
    if np.mean(change < floor - FLOOR_DB) > BELOW_SHARE or drowned > DROWNED_DB:
        return None
    halves = [np.mean(part) for p in inside for part in np.array_split(p, 2)]
    even = np.mean(np.concatenate(inside)) >= EVEN_SHARE and min(halves) >= HALF_SHARE
    by_impacts = not np.any(above) or np.mean(impacts[above] > IMPACT_DB) >= IMPACT_SHARE
    return Floor(change_db=floor, lift_db=LIFT * max(drowned, 0.0)) if even or by_impacts else None


def _with_bands(pairs: Sequence[Pair]) -> list[Pair]:
    """The pairs whose records are both long enough for wide bands."""
    return [p for p in pairs if p.quiet_change.shape[1] >= LEAST_BANDS]


def robust_swap_order(pairs: Sequence[Pair], foreign: BoolArray) -> tuple[int, ...]:
    """For each channel of the tests the channel of the baselines whose signal it carries.

    `foreign` (channels, channels): pairs of channels that cannot be one for their units.
    """
    n = len(pairs[0].names)
    same = tuple(range(n))
    heard = _with_bands(pairs)
    if n < 2 or not heard:
        return same
    fit = np.array([[np.mean([fit_of(p, i, j) for p in heard]) for j in range(n)] for i in range(n)])
    rows, columns = linear_sum_assignment(np.where(foreign, -1e6, fit), maximize=True)
    moved = [(i, j) for i, j in zip(rows, columns, strict=True) if i != j]
    better = [fit[i, j] - fit[i, i] for i, j in moved]
    if len(moved) == 2 and float(np.mean(better)) > 0.0 and _by_steps(heard, int(moved[0][0]), int(moved[0][1])):
        return tuple(int(j) for j in columns)
    if not moved or float(np.mean(better)) < CLEARLY or min(better) < 0.0:
        return same
    if float(np.mean([fit[i, j] for i, j in moved])) < FITS:
        return same
    return tuple(int(j) for j in columns)


def _by_steps(heard: Sequence[Pair], i: int, j: int) -> bool:
    """Whether two channels have each other's steps in all tests: their electronics are exchanged, at least."""
    if any(len(p.steps_test) <= max(i, j) for p in heard):
        return False
    told = [
        exchanged_steps((p.steps_test[i], p.steps_test[j]), (p.steps_baseline[i], p.steps_baseline[j])) for p in heard
    ]
    return all(told)


def fit_of(p: Pair, i: int, j: int) -> float:
    """Mean log likelihood of a band that channel `i` of the test is channel `j` of the baseline: of its quiet moments,
    where the records are long enough, and of its floor."""
    quiet, floor = p.quiet_test[i] - p.quiet_baseline[j], p.test[i, 1] - p.baseline[j, 1]
    return _likelihood(floor) if quiet.size < LEAST_BANDS else 0.5 * (_likelihood(quiet) + _likelihood(floor))


def _likelihood(change: FloatArray) -> float:
    """Of changes, dB, (bands,): half of the bands as they were but for a gain, half raised by anything."""
    best = -np.inf
    for gain in np.arange(-DRIFT_DB, DRIFT_DB + 0.1, 0.5):
        rest = change - gain
        untouched = np.exp(-0.5 * (rest / SPREAD_DB) ** 2) / (SPREAD_DB * np.sqrt(2 * np.pi))
        raised = ((rest > 0) & (rest < REACH_DB)) / REACH_DB
        best = max(best, float(np.mean(np.log(0.5 * untouched + 0.5 * raised + OUTLIER))))
    return best
