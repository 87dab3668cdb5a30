"""How likely each fault is where the bearing is not known: every usual bearing is tried, and all answers are summed.

A classifier of known bearings says, for each geometry, how much likelier the recording is with a fault than without
one. Weighted with how common the geometry is and summed, that is the likelihood of the fault itself: no single comb has
to be chosen, and a fault that only an unheard-of bearing would explain counts less. All geometries are searched for in
the same spectra, and their scores are compared with the same foreign orders, so trying many costs little.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.ndimage import maximum_filter1d

from learn import unknown, whole
from learn.bank import Bank
from learn.combs import (
    SHAFT_BINS,
    SLIP,
    Comb,
    Search,
    away_from,
    grid,
    logs,
    middle_and_spread,
    of_mains,
    scores,
    search,
    tail,
)
from learn.features import LEAST_DEPTH, combs, impulsiveness
from learn.model import Head
from learn.orders import FaultOrders, of_ratio
from signals.series import BoolArray, FloatArray
from sim.parts.bearing.catalogue import catalogue

FREE = 0.25
"""Weight of bearings that the catalogue lacks: from 6 to 16 balls, which fill this much of the pitch circle:"""
FILLS = (1.55, 1.75, 1.95, 2.15)
"""Balls times the ratio of diameters; pi would be a full circle."""
BALLS = range(6, 17)
LEAST = 1e-6
MIDDLE = of_ratio(9, 0.2)
"""Whose combs' scores are the measure of foreign orders: those of other bearings are scattered alike."""
MOST_COMBS = 3
NAMES = (*(f"likelier_{f}" for f in whole.RACES), *unknown.NAMES)


@dataclass(frozen=True, kw_only=True)
class Geometry:
    """Orders of a bearing, and how common it is."""

    orders: FaultOrders
    weight: float


@cache
def usual() -> tuple[Geometry, ...]:
    """Ball bearings of the catalogue by balls and ratio of diameters, then free ones; the weights' sum is 1."""
    rows = [r for r in catalogue().values() if r.element == "ball"]
    sizes = Counter(
        (r.balls, round(r.ball_diameter_m / r.pitch_diameter_m * float(np.cos(r.contact_angle_rad)), 2)) for r in rows
    )
    known = [(z, ratio, (1 - FREE) * n / len(rows)) for (z, ratio), n in sorted(sizes.items())]
    free = [(z, fill / z, FREE / (len(BALLS) * len(FILLS))) for z in BALLS for fill in FILLS]
    return tuple(Geometry(orders=of_ratio(z, ratio), weight=w) for z, ratio, w in (*known, *free))


@dataclass(frozen=True, kw_only=True)
class Peaks:
    """The best of one family near its order in every geometry, (geometries,) each: z, order, band."""

    z: FloatArray
    order: FloatArray
    band: np.ndarray[tuple[int, ...], np.dtype[np.int64]]


def vector(bank: Bank, head: Head) -> FloatArray:
    """Features in the order of `NAMES`; `head` answers for known bearings, from the features of `learn.whole`."""
    return np.concatenate([log_ratios(rows(bank), head), unknown.vector(bank)[0]])


def log_ratios(found: FloatArray, head: Head) -> FloatArray:
    """Log of how much likelier each fault is than none, over all geometries as common as they are, (faults,)."""
    p = np.log(np.maximum(head.probabilities(found), LEAST))
    weights = np.log([g.weight for g in usual()])[:, np.newaxis]
    return np.asarray(np.logaddexp.reduce(weights + p[:, 1:] - p[:, :1], axis=0), dtype=np.float64)


def rows(bank: Bank) -> FloatArray:
    """Features of `learn.whole` in every geometry of `usual`, (geometries, features)."""
    values, base = logs(bank), grid(bank)
    first = search(values, bank.step, base, Comb(harmonics=4), away_from(base, ()))
    z, order, _ = unknown.strongest(bank, first)
    away = away_from(base, (order,) if z >= whole.CLEAR else ())
    barred = of_mains(bank, base)
    chances, lifts, depths = [], [], []
    for family in whole.RACES:
        peaks, tops = _family(bank, values, base, away, barred, family)
        chances.append([-tail(tops, float(x)) for x in peaks.z])
        lifts.append(peaks.z - np.median(tops))
        depths.append(np.log10(np.maximum(_depths(bank, peaks, family), LEAST_DEPTH)))
    _without_races(bank, values, base, first)
    table = [*chances, *lifts, *depths, *_cages(values, bank.step)]
    table += [np.full(len(usual()), x) for x in impulsiveness(bank)]
    return np.asarray(table, dtype=np.float64).T


def _family(
    bank: Bank, values: FloatArray, base: FloatArray, away: BoolArray, barred: BoolArray, family: str
) -> tuple[Peaks, FloatArray]:
    """(the best of a family near its order in every geometry, what equally wide searches find at foreign orders)."""
    wanted = [getattr(g.orders, family) for g in usual()]
    middle = combs(MIDDLE)[family]
    table = scores(values, bank.step, base, middle)
    centre, spread = middle_and_spread(table, away)
    z = (table - centre) / spread
    found = Search(base=base, z=z, best=np.max(z, axis=0), band=np.argmax(z, axis=0))
    tops = found.tops(away)
    found.best[barred] = 0.0
    places = []
    for order, geometry in zip(wanted, usual(), strict=True):
        low, high = np.searchsorted(base, [order * (1 - SLIP), order * (1 + SLIP)])
        part = slice(int(low), max(int(high), int(low) + 1))
        if family == "ball":  # its sidebands lie at the cage's order, which is the geometry's own
            own = (scores(values, bank.step, base[part], combs(geometry.orders)[family]) - centre) / spread
            best, band = np.where(barred[part], 0.0, np.max(own, axis=0)), np.argmax(own, axis=0)
        else:
            best, band = found.best[part], found.band[part]
        k = int(np.argmax(best))
        places.append((float(best[k]), float(base[part][k]), int(band[k])))
    zs, orders, bands = zip(*places, strict=True)
    return Peaks(z=np.array(zs), order=np.array(orders), band=np.array(bands)), tops


def _depths(bank: Bank, peaks: Peaks, family: str) -> FloatArray:
    """`features.comb_depth` of every geometry, (geometries,)."""
    lines = [combs(g.orders)[family].lines() for g in usual()]
    places = np.array([[k * base + s for k, s, _ in own] for own, base in zip(lines, peaks.order, strict=True)])
    counted = (np.abs(places) > 4 * bank.step) & (np.abs(places) < bank.step * (bank.depth.shape[1] - 3))
    counted &= np.abs(places - np.rint(places)) > SHAFT_BINS * bank.step
    at = np.clip(np.rint(np.abs(places) / bank.step).astype(np.int64), 2, bank.depth.shape[1] - 2)
    near = np.stack([at - 1, at, at + 1])
    band = peaks.band[:, np.newaxis]
    pick = np.take_along_axis(near, np.argmax(bank.depth[band, near], axis=0)[np.newaxis], axis=0)[0]
    square = bank.depth[band, pick] ** 2
    clear = np.maximum(square - 3 * square / np.maximum(bank.excess[band, pick], 1e-12), 0.0)
    return np.asarray(np.sqrt(np.sum(np.where(counted, clear, 0.0), axis=1)), dtype=np.float64)


def _without_races(bank: Bank, values: FloatArray, base: FloatArray, found: Search) -> None:
    """Clear combs, one after the other, put to noise, in place: what is left may be a cage's."""
    for _ in range(MOST_COMBS):
        z, order, _ = unknown.strongest(bank, found)
        if z < whole.CLEAR:
            return
        whole.taken_out(values, bank.step, order)
        found = search(values, bank.step, base, Comb(harmonics=4), away_from(base, ()))


def _cages(values: FloatArray, step: float) -> list[FloatArray]:
    """How far the lines of each geometry's cage stand out: in the best band, in all; (geometries,) each."""
    base = whole.cage_grid(step)
    away = np.ones(base.size, dtype=np.bool_)
    for simple in whole.SIMPLE:
        away &= np.abs(base - simple) > whole.SIMPLE_REACH
    orders = np.array([g.orders.cage for g in usual()])
    width = max(1, int(2 * SLIP * float(np.median(orders)) / (base[1] - base[0])))
    lifts = []
    for pair in whole.cage_curves(values, step, away, base):
        wide = [maximum_filter1d(curve, width) for curve in pair]
        lifts.append([np.interp(orders, base, w) - np.median(w[away]) for w in wide])
    best = np.max(lifts, axis=0)
    return [np.log1p(np.maximum(one, 0.0)) for one in best]
