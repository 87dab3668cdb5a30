"""Features where the bearing's geometry is known: how each family of lines stands out, by chance and by depth.

Left out on purpose: levels in any unit, the length of the recording, and lines of the shaft, which sound machines have
of every height.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from learn.bank import HIGHEST_ORDER, Bank
from learn.combs import SLIP, Comb, Search, away_from, grid, lift, logs, search, tail
from learn.orders import FaultOrders
from signals.series import FloatArray

FAMILIES = ("outer", "inner", "ball", "cage")
HIGHEST_BASE = 0.9 * HIGHEST_ORDER
"""Up to this order a family is searched for: its first line must be within the envelope's spectrum."""
LEAST_DEPTH = 1e-3
LINE_EXCESS = 14.0
"""Power over the floor from which a bin is a line: noise passes it in one bin of a million."""
HANN_BINS = 1.5
"""A line's power in the bins of a Hann window over that of its peak."""
NAMES = (
    *(f"chance_{f}" for f in FAMILIES),
    *(f"z_{f}" for f in FAMILIES),
    *(f"depth_{f}" for f in FAMILIES),
    "side_inner",
    "side_ball",
    "impulsive",
    "impulsive_middle",
    "erratic",
)


@dataclass(frozen=True, kw_only=True)
class Found:
    """A family in the bank: base order, slip, band, standardised score, log10 chance, depth."""

    family: str
    order: float
    slip: float
    band: int
    """Number in the bank."""
    band_hz: tuple[float, float]
    channel: int
    z: float
    chance: float
    lift: float
    depth: float
    searched: bool = True
    """False: the order is beyond the envelope's spectrum, and nothing is told."""


def combs(orders: FaultOrders) -> dict[str, Comb]:
    """The lines each family is looked for by."""
    return {
        "outer": Comb(harmonics=4),
        "inner": Comb(harmonics=3, spacings=(1.0,)),
        "ball": Comb(harmonics=3, spacings=(orders.cage,)),
        "cage": Comb(harmonics=4),
    }


def line_depths(bank: Bank, band: int, places: FloatArray) -> FloatArray:
    """Depth of the lines at `places` (orders), largest of three bins, noise subtracted, shape as places."""
    k = np.rint(np.abs(places) / bank.step).astype(np.int64)
    k = np.clip(k, 2, bank.depth.shape[1] - 2)
    near = np.stack([k - 1, k, k + 1])
    row = bank.depth[band]
    pick = np.take_along_axis(near, np.argmax(row[near], axis=0)[np.newaxis], axis=0)[0]
    square = row[pick] ** 2
    noise = square / np.maximum(bank.excess[band][pick], 1e-12)
    return np.asarray(np.sqrt(np.maximum(square - 3 * noise, 0.0)), dtype=np.float64)


def comb_depth(bank: Bank, band: int, base: float, comb: Comb) -> float:
    """Root of the summed squares of the comb's lines."""
    places = np.array([k * base + s for k, s, _ in comb.lines()])
    places = places[(np.abs(places) > 4 * bank.step) & (np.abs(places) < bank.step * (bank.depth.shape[1] - 3))]
    places = places[np.abs(places - np.rint(places)) > 1.5 * bank.step]
    return float(np.sqrt(np.sum(line_depths(bank, band, places) ** 2)))


def known_orders(orders: FaultOrders) -> tuple[float, ...]:
    """All base orders."""
    return orders.outer, orders.inner, orders.ball, orders.cage


def find(bank: Bank, orders: FaultOrders, doubt: float = 0.0) -> dict[str, Found]:
    """Every family; `doubt` (relative, of the speed) widens the search."""
    # the cage's own order is below the grid: its fourth harmonic is searched as a base
    sought = {"outer": orders.outer, "inner": orders.inner, "ball": orders.ball, "cage": 4 * orders.cage}
    values, base = logs(bank), grid(bank, [o for o in sought.values() if o <= HIGHEST_BASE])
    away = away_from(base, known_orders(orders))
    found = {}
    for family, comb in combs(orders).items():
        order = sought[family]
        if order > HIGHEST_BASE:
            found[family] = _unsearched(bank, family, order)
            continue
        s: Search = search(values, bank.step, base, comb, away)
        z, at, band = s.near(order, SLIP + doubt)
        tops = s.tops(away, SLIP + doubt)
        found[family] = Found(
            family=family,
            order=at,
            slip=at / order - 1,
            band=band,
            band_hz=(float(bank.bands_hz[band, 0]), float(bank.bands_hz[band, 1])),
            channel=bank.channel[band],
            z=z,
            chance=-tail(tops, z),
            lift=lift(tops, z),
            depth=comb_depth(bank, band, at, comb),
        )
    return found


def _unsearched(bank: Bank, family: str, order: float) -> Found:
    """Of a family beyond the spectrum: neither here nor there."""
    low, high = float(bank.bands_hz[0, 0]), float(bank.bands_hz[0, 1])
    return Found(
        family=family,
        order=order,
        slip=0.0,
        band=0,
        band_hz=(low, high),
        channel=bank.channel[0],
        z=0.0,
        chance=0.0,
        lift=0.0,
        depth=0.0,
        searched=False,
    )


def vector(bank: Bank, orders: FaultOrders, doubt: float = 0.0) -> tuple[FloatArray, dict[str, Found]]:
    """(features in the order of `NAMES`, what was found)."""
    found = find(bank, orders, doubt)
    rows = [found[f] for f in FAMILIES]
    side_inner = _side(bank, found["inner"].band, found["inner"].order, 1.0)
    side_ball = _side(bank, found["ball"].band, found["ball"].order, orders.cage)
    values = [
        *(f.chance for f in rows),
        *(f.z for f in rows),
        *(_db(f.depth) for f in rows),
        side_inner,
        side_ball,
        *impulsiveness(bank),
    ]
    return np.asarray(values, dtype=np.float64), found


def impulsiveness(bank: Bank) -> tuple[float, float, float]:
    """Log kurtosis of the most impulsive and of the middle band; log of what no line of the envelope makes of it.

    Squared envelope over its mean m(t) times exponential noise has kurtosis 2 var m; lines of depth d make d^2 / 2 of
    var m. What is left is impulses without a period.
    """
    kurtosis = np.maximum(bank.kurtosis, 0.0)
    clear = np.where(bank.excess > LINE_EXCESS, bank.depth, 0.0)
    erratic = np.maximum(0.5 * kurtosis - 0.5 * np.sum(clear**2, axis=1) / HANN_BINS, 0.0)
    return (
        float(np.log10(np.max(kurtosis) + 0.1)),
        float(np.log10(np.median(kurtosis) + 0.1)),
        float(np.log10(np.max(erratic) + 0.05)),
    )


def _db(depth: float) -> float:
    return float(np.log10(max(depth, LEAST_DEPTH)))


def _side(bank: Bank, band: int, order: float, spacing: float) -> float:
    """Log ratio of the first sidebands to the carrier over three harmonics."""
    if order > HIGHEST_BASE:
        return 0.0
    k = np.asarray(np.arange(1, 4) * order, dtype=np.float64)
    carrier = float(np.sqrt(np.sum(line_depths(bank, band, k) ** 2)))
    sides = float(np.sqrt(np.sum(line_depths(bank, band, np.concatenate([k - spacing, k + spacing])) ** 2)))
    return float(np.log10((sides + 0.01) / (carrier + 0.01)))
