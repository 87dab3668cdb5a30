"""Features of a whole recording: what only many turns in one piece can show.

A defect keeps its order and slip from beginning to end, so its comb grows with every turn, while faint lines that
wander do not. Above all a ball's: it comes into the load zone once a turn of the cage whatever its own axis does, so
its impacts are modulated at the cage's order even where twice the spin makes no line (R. B. Randall and J. Antoni,
Mech. Syst. Signal Process. 25 (2011) 485-520, section 2.2), and the cage's order is far too low for short pieces.
"""

from __future__ import annotations

import numpy as np
from scipy.ndimage import maximum_filter1d

from learn.bank import Bank
from learn.combs import BEYOND, SLIP, lift, logs, standardised
from learn.features import Found, find, impulsiveness
from learn.orders import FaultOrders
from signals.series import BoolArray, FloatArray

RACES = ("outer", "inner", "ball")
CAGE_LOW, CAGE_HIGH = 0.2, 0.495
"""Orders at which a cage's comb is compared: 0.33 to 0.46 are usual."""
USUAL_CAGE = 0.4
SIMPLE, SIMPLE_REACH = (0.2, 0.25, 1 / 3, 0.5), 0.005
"""Orders whose harmonics are the shaft's too."""
CAGE_HARMONICS = 12
SHAFT_HARMONICS = 30
CLEAR = 4.0
"""A race's comb from this z on is taken out before the cage's is looked for."""
RACE_SIDES = 2
MASK_BINS = 2.5
TURNS = 160.0
"""At most so many at once: over more the speed wanders. Longer recordings are read in equal parts."""
NAMES = (
    *(f"long_{what}_{f}" for what in ("chance", "lift", "depth") for f in RACES),
    "long_cage",
    "long_cage_all",
    "long_impulsive",
    "long_impulsive_middle",
    "long_erratic",
)


def vector(bank: Bank, orders: FaultOrders, doubt: float = 0.0) -> tuple[FloatArray, dict[str, Found]]:
    """(features in the order of `NAMES`, what was found)."""
    found = find(bank, orders, doubt)
    rows = [found[f] for f in RACES]
    values = logs(bank)
    for family in ("outer", "inner"):
        if found[family].z >= CLEAR:
            taken_out(values, bank.step, found[family].order)
    base = cage_grid(bank.step, orders.cage)
    near = np.abs(base / orders.cage - 1) <= max(SLIP + doubt, 0.5 * bank.step / orders.cage)
    row = [
        *(f.chance for f in rows),
        *(f.lift for f in rows),
        *(np.log10(max(f.depth, 1e-3)) for f in rows),
        *(np.log1p(max(x, 0.0)) for x in cage(values, bank.step, near, foreign(base, orders.cage), base)),
        *impulsiveness(bank),
    ]
    return np.asarray(row, dtype=np.float64), found


def taken_out(values: FloatArray, step: float, order: float) -> None:
    """Bins of a race's comb and of its sidebands at the shaft's order put to noise, in place."""
    top = values.shape[1] * step
    centres = [k * order + m for k in range(1, int(top / order) + 1) for m in range(-RACE_SIDES, RACE_SIDES + 1)]
    at = np.arange(values.shape[1]) * step
    for centre in centres:
        values[:, np.abs(at - centre) < MASK_BINS * step] = 0.0


def cage_grid(step: float, order: float = USUAL_CAGE) -> FloatArray:
    """Orders the comb of a cage of this order is looked for at, shape (orders,). Where the outer ring turns, cages are
    faster than half of it: their orders are those usual ones from 1 down."""
    if order > 0.5:
        return np.arange(1 - CAGE_HIGH, max(1 - CAGE_LOW, order * (1 + BEYOND)), step / CAGE_HARMONICS)
    return np.arange(CAGE_LOW if order >= CAGE_LOW else order * (1 - BEYOND), CAGE_HIGH, step / CAGE_HARMONICS)


def foreign(base: FloatArray, order: float) -> BoolArray:
    """Orders of `base` whose lines are not also the cage's, nor the shaft's."""
    away = np.ones(base.size, dtype=np.bool_)
    for relative in (order, order / 2, abs(1 - order) / 2, abs(1 - 2 * order), 1 - order, 0.5 - order):
        if relative != 0.0:
            away &= np.abs(base / relative - 1) > SLIP + 0.01
    for simple in SIMPLE:
        away &= np.abs(base - (simple if order <= 0.5 else 1 - simple)) > SIMPLE_REACH
    return away


def cage_curves(
    values: FloatArray, step: float, away: BoolArray, base: FloatArray
) -> list[tuple[FloatArray, FloatArray]]:
    """How far the cage's own lines, and its sidebands about the shaft's, stand out at every order of `base`.

    Of each kind of lines (best band, all bands together), in robust deviations of the orders `away`.
    """
    own = [(m * base, 1 / np.sqrt(m)) for m in range(1, CAGE_HARMONICS + 1)]
    about = [(k + s * base, 1.0) for k in range(1, SHAFT_HARMONICS + 1) for s in (-2, -1, 1, 2)]
    found = []
    for lines in (own, about):
        table = np.zeros((values.shape[0], base.size))
        for places, weight in lines:
            bins = np.rint(np.abs(places) / step).astype(np.int64)
            inside = bins < values.shape[1]
            table[:, inside] += weight * values[:, bins[inside]]
        one = np.max(standardised(table, away), axis=0)
        found.append((one, standardised(np.sum(table, axis=0, keepdims=True), away)[0]))
    return found


def cage(values: FloatArray, step: float, near: BoolArray, away: BoolArray, base: FloatArray) -> tuple[float, float]:
    """The highest of these curves `near` the cage's order, over what equally wide searches find at foreign orders.

    In the best band, and in all bands together; the better of the two kinds of lines each.
    """
    width = max(1, int(np.sum(near)))
    lifts = [
        [lift(maximum_filter1d(curve, width)[away], float(np.max(curve[near]))) for curve in pair]
        for pair in cage_curves(values, step, away, base)
    ]
    return max(one for one, _ in lifts), max(every for _, every in lifts)
