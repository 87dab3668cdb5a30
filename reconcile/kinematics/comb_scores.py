"""Scores of combs: what lies at a family's lines, at many base orders at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from reconcile.compiled.combs import largest, placed, summed
from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.families import Family
from signals.series import FloatArray, IntArray

LEAST_SPREAD = 0.7
Bins = NDArray[np.int32]


@lru_cache(maxsize=64)
def _pattern(lowest: int, harmonics: int, sidebands: int, spacing: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Of a comb's lines: multiples of the base order, orders beside them, weights; shape (lines,) each."""
    multiples: list[float] = []
    beside: list[float] = []
    weights: list[float] = []
    for k in range(lowest, harmonics + 1):
        steps = [sign * m for m in range(1, sidebands + 1) for sign in (-1, 1)]
        multiples += [float(k)] * (1 + len(steps))
        beside += [0.0, *(step * spacing for step in steps)]
        weights += [float(1 / np.sqrt(k)), *[float(0.5 / np.sqrt(k))] * len(steps)]
    return np.array(multiples), np.array(beside), np.array(weights)


def _lines(family: Family) -> tuple[FloatArray, FloatArray, FloatArray]:
    return _pattern(family.lowest, family.harmonics, family.sidebands, family.spacing)


def comb(family: Family, base: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(orders (trials, lines), weights (lines,)) of the family's lines at base orders (trials,)."""
    multiples, beside, weights = _lines(family)
    lines = base[:, np.newaxis] * multiples
    lines += beside
    return lines, weights


def trials(family: Family, order: float, reach: float, order_step: float) -> FloatArray:
    """Base orders to try around `order`: the highest line moves by one bin from one to the next, shape (trials,)."""
    if reach == 0:
        return np.array([order])
    step = order_step / family.harmonics
    count = max(1, int(np.ceil(order * reach / step)))
    return np.asarray(order + np.arange(-count, count + 1) * (order * reach / count), dtype=np.float64)


def scores(values: FloatArray, envelopes: Envelopes, family: Family, base: FloatArray) -> FloatArray:
    """Comb scores, shape (bands, trials)."""
    found = np.empty((base.size, values.shape[0]))
    summed(*_placed(envelopes, family, base), _by_bin(values), found)
    return found.T


def _placed(envelopes: Envelopes, family: Family, base: FloatArray) -> tuple[Bins, FloatArray]:
    """(bins (trials, lines), weights (lines,)) of its lines at base orders (trials,)."""
    multiples, beside, weights = _lines(family)
    places = np.empty((base.size, weights.size), dtype=np.int32)
    placed(base, multiples, beside, envelopes.order_step, envelopes.excess.shape[1], places)
    return places, weights


def _by_bin(values: FloatArray) -> FloatArray:
    """(bins, bands): all bands of a bin lie together, so that a line is fetched once, not once a band."""
    return np.ascontiguousarray(values.T)


@dataclass(frozen=True, kw_only=True)
class Controls:
    """Control orders: bins (trials, lines) and weights (lines,) of all their trials, and the first trial of each order
    (controls,)."""

    places: Bins
    weights: FloatArray
    first: IntArray


def at_orders(envelopes: Envelopes, family: Family, orders: FloatArray, reach: float) -> Controls:
    """The control orders, each with its `trials`; spectra of one length share them."""
    count = np.zeros(orders.size, dtype=np.int64)
    if reach > 0:
        step = envelopes.order_step / family.harmonics
        count = np.maximum(1, np.ceil(orders * reach / step).astype(np.int64))
    first = np.cumsum(2 * count + 1) - (2 * count + 1)
    of = np.repeat(np.arange(orders.size), 2 * count + 1)
    steps = np.arange(of.size) - (first + count)[of]
    base = orders[of] + steps * (orders * reach / np.maximum(count, 1))[of]
    places, weights = _placed(envelopes, family, base)
    return Controls(places=places, weights=weights, first=first)


def best_at(values: FloatArray, foreign: Controls) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(best scores at the control orders (bands, controls), their medians and robust deviations (bands, 1))."""
    bands = values.shape[0]
    found = np.empty((foreign.first.size, bands))
    largest(foreign.places, foreign.weights, _by_bin(values), foreign.first, np.empty((1, bands)), found)
    control = np.ascontiguousarray(found.T)
    centre = np.median(control, axis=1, keepdims=True)
    spread = np.maximum(1.4826 * np.median(np.abs(control - centre), axis=1, keepdims=True), LEAST_SPREAD)
    return control, centre, spread
