"""Features where the bearing is not known: the strongest foreign comb, and which part of a usual bearing makes such.

The comb's base order is compared with the orders of all usual bearings (balls, diameter ratio): an outer race lies near
0.4 Z, an inner one near 0.6 Z. Sidebands decide what orders leave open: an inner-race defect turns with the shaft
through the load zone and so has sidebands at one order, a ball's at the cage's, an outer race's at neither.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from learn.bank import Bank
from learn.combs import Comb, Search, away_from, grid, logs, of_mains, search, tail
from learn.features import comb_depth, impulsiveness, line_depths
from learn.orders import of_ratio
from signals.series import FloatArray
from sim.parts.bearing.catalogue import catalogue

CAGES = np.arange(0.33, 0.451, 0.005)
PLAUSIBLE = {"outer": (2.0, 8.5), "inner": (3.6, 12.0), "ball": (2.8, 8.0)}
FLAT, CLOSE = 0.2, 0.012
"""Weight of unusual bearings beside the catalogue's; relative width of each catalogue order in the prior."""
NAMES = (
    "u_z",
    "u_chance",
    "u_depth",
    "u_prior_outer",
    "u_prior_inner",
    "u_prior_ball",
    "u_side_shaft",
    "u_side_cage",
    "u_z_shaft",
    "u_second",
    "u_z_outer",
    "u_z_inner",
    "u_z_ball",
    "u_impulsive",
    "u_impulsive_middle",
    "u_erratic",
)


@cache
def _usual() -> dict[str, FloatArray]:
    """Orders of the catalogue's ball bearings by family, shape (bearings,)."""
    rows = [r for r in catalogue().values() if r.element == "ball" and r.balls <= 14]
    found = [of_ratio(r.balls, r.ball_diameter_m / r.pitch_diameter_m * np.cos(r.contact_angle_rad)) for r in rows]
    return {
        "outer": np.array([o.outer for o in found]),
        "inner": np.array([o.inner for o in found]),
        "ball": np.array([o.ball for o in found]),
    }


def prior(family: str, order: float) -> float:
    """Log density of a family's base order over usual bearings (density over the logarithm of the order)."""
    known = _usual()[family]
    peaks = np.exp(-0.5 * (np.log(order / known) / CLOSE) ** 2) / (CLOSE * np.sqrt(2 * np.pi))
    low, high = PLAUSIBLE[family]
    flat = FLAT / np.log(high / low) if low <= order <= high else 1e-3
    return float(np.log((1 - FLAT) * np.mean(peaks) + flat))


def strongest(bank: Bank, s: Search, taken: float | None = None) -> tuple[float, float, int]:
    """(z, base order, band) of the strongest comb off the shaft's orders and the mains; relatives of the base `taken`
    left out."""
    off = np.abs(s.base - np.rint(s.base)) > max(0.02, 2 * bank.step)
    inside = off & ~of_mains(bank, s.base) & (s.base >= 1.8) & (s.base <= 12.5)
    if taken is not None:
        for m in (0.5, 1.0, 1.5, 2.0, 3.0):
            inside &= np.abs(s.base / (taken * m) - 1) > 0.02
        for side in (-2.0, -1.0, 1.0, 2.0):
            inside &= np.abs(s.base - taken - side) > 3 * bank.step
    if not np.any(inside):
        return 0.0, 3.5, 0
    places = np.flatnonzero(inside)
    k = int(places[np.argmax(s.best[places])])
    order, band = float(s.base[k]), int(s.band[k])
    return float(s.best[k]), _fundamental(bank, band, order), band


def _fundamental(bank: Bank, band: int, order: float) -> float:
    """The lowest of the order, its third, half and double whose own first line is not much weaker than the others'."""
    candidates = [c for c in (order / 3, 0.5 * order, order, 2.0 * order) if 1.8 <= c <= 12.5]
    first = [float(line_depths(bank, band, np.array([c]))[0]) for c in candidates]
    most = max(first)
    return next((c for c, d in zip(candidates, first, strict=True) if d >= 0.4 * most and d > 0), order)


def vector(bank: Bank) -> tuple[FloatArray, dict[str, float]]:
    """(features in the order of `NAMES`, the comb found: order, band, z, depth)."""
    values, base = logs(bank), grid(bank)
    everywhere = away_from(base, ())
    carriers = search(values, bank.step, base, Comb(harmonics=4), everywhere)
    z, order, band = strongest(bank, carriers)
    away = away_from(base, (order,))
    carriers = search(values, bank.step, base, Comb(harmonics=4), away)
    k = int(np.argmin(np.abs(base - order)))
    near = slice(max(0, k - 8), k + 9)
    band = int(carriers.band[near][np.argmax(carriers.best[near])])
    z = float(np.max(carriers.best[near]))
    chance = -tail(carriers.best[away], z)
    second, _, _ = strongest(bank, carriers, taken=order)
    shaft_side, cage_side = _sides(bank, band, order)
    with_shaft = search(values, bank.step, base, Comb(harmonics=3, spacings=(1.0,)), away)
    depth = comb_depth(bank, band, order, Comb(harmonics=4))
    row = [
        z,
        chance,
        float(np.log10(max(depth, 1e-3))),
        *(prior(f, order) for f in ("outer", "inner", "ball")),
        shaft_side,
        cage_side,
        float(np.max(with_shaft.best[near])),
        second,
        *(_best_within(bank, carriers if f != "inner" else with_shaft, f) for f in ("outer", "inner", "ball")),
        *impulsiveness(bank),
    ]
    return np.asarray(row, dtype=np.float64), {"order": order, "band": float(band), "z": z, "depth": depth}


def _best_within(bank: Bank, s: Search, family: str) -> float:
    """Largest z plus log prior over the orders a usual bearing's family has."""
    low, high = PLAUSIBLE[family]
    off = (np.abs(s.base - np.rint(s.base)) > 0.03) & ~of_mains(bank, s.base)
    inside = np.flatnonzero((s.base >= low) & (s.base <= high) & off)[::2]
    known = _usual()[family]
    closest = np.min(np.abs(np.log(s.base[inside][:, np.newaxis] / known)), axis=1)
    return float(np.max(s.best[inside] - 0.5 * np.minimum(closest / CLOSE, 4.0) ** 2))


def _sides(bank: Bank, band: int, order: float) -> tuple[float, float]:
    """(log ratio of sidebands at one order, at the best cage order) to the carriers over three harmonics."""
    k = np.asarray(np.arange(1, 4) * order, dtype=np.float64)

    def size(places: FloatArray) -> float:
        off = places[np.abs(places - np.rint(places)) > 1.5 * bank.step]
        return float(np.sqrt(np.sum(line_depths(bank, band, off) ** 2))) if off.size else 0.0

    carrier = size(k)
    shaft = size(np.concatenate([k - 1, k + 1]))
    cage = max(size(np.concatenate([k - c, k + c])) for c in CAGES)
    return float(np.log10((shaft + 0.01) / (carrier + 0.01))), float(np.log10((cage + 0.01) / (carrier + 0.01)))
