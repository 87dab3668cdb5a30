"""The feature-level model of a local defect: an impulse train at a fitted rate, heard through a smooth path.

Harmonics fall by a power of their number, sidebands stand at one ratio, lines widen with their order as slip smears
them; where entry and exit of a spall were told apart every impulse is a pair, and the comb has their interference.
Impulses whose strength follows a turn have the lines of that turn too (P.D. McFadden and J.D. Smith, Model for the
vibration produced by a single point defect in a rolling element bearing, J. Sound Vib. 96, 1984, 69-82: the products of
a part's rate and the load's orders, that of no rate among them); what is uneven from one to the next, in strength or
pace, spreads over all orders evenly (J. Antoni and R.B. Randall, A stochastic model for simulation and diagnostics of
rolling element bearings with localized faults, J. Vib. Acoust. 125, 2003, 282-289).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from scipy.optimize import least_squares

from reconcile.kinematics.families import Family
from signals.series import FloatArray

SMOOTH = 4
"""Coefficients of the smooth re-scaling."""
PARAMETERS = 7
"""Of the comb: log level, fall with harmonic, log sideband ratio, log smear, slip, share of the second impulse, log
floor: what impacts of uneven strength and pace spread evenly over all orders."""
MAIN_LOBE = 1.1
"""Standard deviation of an averaged Hann main lobe, bins."""
NOTHING = 39.0
"""Standard deviations from the middle of a line from which on it is exactly nothing."""
KEPT = 2 * (PARAMETERS + SMOOTH)
"""Powers a fit keeps: those of a step and of its slopes."""
LOW = (-30.0, -1.0, -6.0, -4.0, -0.004, 0.0, -30.0)
START = (0.0, 1.0, -1.0, -1.5, 0.0, 0.1, -10.0)
HIGH = (10.0, 6.0, 0.5, 1.0, 0.004, 0.9, 10.0)


@dataclass(frozen=True, kw_only=True)
class Stretch:
    """Log power (bins,) of the envelope's order spectrum, averaged over segments, and its orders."""

    log_power: FloatArray
    orders: FloatArray

    @property
    def step(self) -> float:
        """Distance of the bins."""
        return float(self.orders[1] - self.orders[0])

    @cached_property
    def basis(self) -> FloatArray:
        """Chebyshev polynomials over the orders, (bins, SMOOTH)."""
        place = 2 * self.orders / self.orders[-1] - 1
        return np.asarray(np.polynomial.chebyshev.chebvander(place, SMOOTH - 1), dtype=np.float64)


@dataclass(frozen=True, kw_only=True)
class Train:
    """A family at its order as found; `pair`: distance of the two impulses over the period, 0 for single ones."""

    family: Family
    order: float
    pair: float = 0.0


def comb_power(train: Train, on: Stretch, parameters: FloatArray) -> FloatArray:
    """Power (bins,) of the comb's lines and of its floor."""
    level, fall, side, smear, slip, second, floor = (float(p) for p in parameters)
    family, base = train.family, train.order * (1 + slip)
    total = np.full(on.orders.size, np.exp(floor))
    for k in range(int(on.orders[-1] / base) + 1):
        width = on.step * np.hypot(MAIN_LOBE, np.exp(smear) * k)
        both = 1 + second**2 + 2 * second * np.cos(2 * np.pi * k * train.pair) if train.pair else 1.0
        height = both * np.exp(level - fall * np.log(max(k, 1))) * on.step / width
        lines = [(k * base, height)] if k else []
        for m in range(1, family.sidebands + 1):
            lines += [
                (k * base + s * m * family.spacing, height * float(np.exp(side))) for s in ((-1, 1) if k else (1,))
            ]
        for place, power in lines:
            first, last = np.searchsorted(on.orders, (place - NOTHING * width, place + NOTHING * width))
            total[first:last] += power * np.exp(-0.5 * ((on.orders[first:last] - place) / width) ** 2)
    return total


def predicted(train: Train, on: Stretch, before: FloatArray, p: FloatArray) -> FloatArray:
    """Log power (bins,) of the expected spectrum `before`, re-scaled, with the comb added."""
    return np.asarray(
        np.log(_base(on, before, p[PARAMETERS:]) + comb_power(train, on, p[:PARAMETERS])), dtype=np.float64
    )


def _base(on: Stretch, before: FloatArray, smooth: FloatArray) -> FloatArray:
    """Power (bins,) of `before` re-scaled by coefficients (SMOOTH,)."""
    return np.asarray(np.exp(np.clip(before + on.basis @ smooth, -60.0, 60.0)), dtype=np.float64)


def fitted(train: Train, fit: Stretch, before: FloatArray) -> FloatArray:
    """Parameters of the comb and of the re-scaling, (PARAMETERS + SMOOTH,), least squares of the log spectrum."""
    smooth = rescaled(fit, before)[1]
    smooth[0] -= 1.0
    start = np.concatenate((START, smooth))
    start[0], start[PARAMETERS - 1] = float(np.max(fit.log_power)), float(np.percentile(fit.log_power, 10))
    low = np.concatenate((LOW, np.full(SMOOTH, -20.0)))
    high = np.concatenate((HIGH, np.full(SMOOTH, 20.0)))

    # a slope moves one parameter at a time, of the comb or of the re-scaling: the other is as it was
    comb = lru_cache(maxsize=KEPT)(lambda p: comb_power(train, fit, np.frombuffer(p)))
    base = lru_cache(maxsize=KEPT)(lambda p: _base(fit, before, np.frombuffer(p)))

    def residual(p: FloatArray) -> FloatArray:
        power = base(p[PARAMETERS:].tobytes()) + comb(p[:PARAMETERS].tobytes())
        return np.asarray(np.log(power) - fit.log_power, dtype=np.float64)

    found = least_squares(residual, np.clip(start, low + 1e-9, high - 1e-9), bounds=(low, high), max_nfev=200)
    return np.asarray(found.x, dtype=np.float64)


def rescaled(fit: Stretch, before: FloatArray) -> tuple[FloatArray, FloatArray]:
    """(`before` smoothly re-scaled to the stretch (bins,), its coefficients (SMOOTH,))."""
    columns = fit.basis
    smooth = np.asarray(np.linalg.lstsq(columns, fit.log_power - before, rcond=None)[0], dtype=np.float64)
    return np.asarray(before + columns @ smooth, dtype=np.float64), smooth
