"""Fit a resistance to a measured force, from several starts, with block-robust intervals."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.optimize import least_squares

from reconcile.driven.channels import FloatArray
from reconcile.driven.fit import INTERVAL, block_covariance
from reconcile.driven.prescribed.resistance import DRY, GRADUAL, LINEAR, STOPS, Motion, Structure, resistance

POSITIVE = frozenset({"friction", "elastic", "backlash", "slack", "contact", "gap_up", "gap_down", *GRADUAL.names[1:]})
MOST_LEAN = 0.5
PLAYS = (0.05, 0.2, 0.4)
"""Starts of the play, as shares of the motion's amplitude."""
GAPS = (0.2, 0.5, 0.8)
"""Starts of the gaps before stops, over the amplitude."""
REACHED, NEVER = 0.98, 100.0
"""A gap wider than this share of the way on its side was not seen to close: it is then put so many amplitudes away."""
SPEEDS = (0.02, 0.2)
"""Starts of the speed at which dry friction is developed, over the fastest."""
REACHES = (0.5, 1.5)
"""Starts of the longest stretch of a friction that sets in gradually, over the amplitude."""
BOUNDS = {"elastic": (1e-4, np.inf), "asymmetry": (-MOST_LEAN, MOST_LEAN), "speed": (1e-3, 1.0), "reach": (0.05, 2.5)}
"""In units of the scales."""
ELASTICS = (5.0, 20.0)
"""Starts of the spring: friction over this share of the amplitude."""


@dataclass(frozen=True, kw_only=True)
class Resisting:
    """A fitted resistance: parameters with 90 % intervals, and the error left, (n,)."""

    structure: Structure
    values: Mapping[str, float]
    intervals: Mapping[str, tuple[float, float]]
    error: FloatArray

    def on(self, motion: Motion) -> FloatArray:
        """Force it predicts for a motion, N."""
        return resistance(self.structure, dict(self.values), motion)


def _scales(names: tuple[str, ...], motion: Motion, force: FloatArray) -> FloatArray:
    size = float(np.std(force)) or 1.0
    x = float(np.max(np.abs(motion.displacement - motion.displacement.mean()))) or 1.0
    v = float(np.max(np.abs(motion.velocity))) or 1.0
    known = {
        "stiffness": size / x, "damping": size / v, "offset": size, "friction": size, "elastic": size / x,
        "asymmetry": 1.0, "backlash": x, "slack": size / x, "drag": size / v**2, "cubic": size / x**3,
        "speed": v, "contact": size / x, "gap_up": x, "gap_down": x, "reach": x,
        **dict.fromkeys(GRADUAL.names[1:], size),
    }  # fmt: skip
    return np.array([known[name] for name in names])


def _starts(structure: Structure) -> list[dict[str, float]]:
    """In units of the scales."""
    plain = dict.fromkeys((*LINEAR, *structure.names), 0.0)
    if "friction" in plain:
        plain["friction"] = 1.0
    if structure.key == DRY.key:
        return [plain | {"speed": s} for s in SPEEDS]
    if structure.key == STOPS.key:
        return [plain | {"contact": 1.0, "gap_up": g, "gap_down": g} for g in GAPS]
    if structure.key == GRADUAL.key:
        return [dict.fromkeys(plain, 0.2) | {"reach": r} for r in REACHES]
    if "elastic" not in plain:
        return [plain]
    plays = PLAYS if "backlash" in plain else (0.0,)
    return [plain | {"elastic": e} | ({"backlash": p, "slack": 0.3} if p else {}) for e, p in product(ELASTICS, plays)]


def fit_resistance(structure: Structure, motion: Motion, force: FloatArray, skip: int) -> Resisting:
    """Least squares on the force after the first `skip` samples, where the memory's start no longer counts."""
    names = (*LINEAR, *structure.names)
    scale = _scales(names, motion, force)
    size = float(np.std(force)) or 1.0
    ends = [BOUNDS.get(n, (0.0 if n in POSITIVE else -np.inf, np.inf)) for n in names]
    low, high = np.array(ends).T

    def residual(p: FloatArray) -> FloatArray:
        values = dict(zip(names, (p * scale).tolist(), strict=True))
        return np.asarray((force - resistance(structure, values, motion))[skip:] / size)

    best = None
    for start in _starts(structure):
        first = np.clip(np.array([start[n] for n in names]), low + 1e-6, high - 1e-6)
        # The slip makes the error kinked: steps of the derivative must be larger than rounding asks.
        found = least_squares(
            residual, first, bounds=(low, high), x_scale="jac", diff_step=np.full(first.size, 1e-4), max_nfev=60
        )
        best = found if best is None or found.cost < best.cost else best
    assert best is not None
    values = dict(zip(names, (best.x * scale).tolist(), strict=True))
    spread = np.sqrt(np.maximum(np.diag(block_covariance(np.asarray(best.jac), best.fun)), 0.0)) * scale
    intervals = {
        n: (values[n] - INTERVAL * float(s), values[n] + INTERVAL * float(s))
        for n, s in zip(names, spread, strict=True)
    }
    if structure.key == STOPS.key:
        x = motion.displacement[skip:]
        for name, most in (("gap_up", float(x.max())), ("gap_down", -float(x.min()))):
            if values[name] > REACHED * most:
                values[name] = NEVER * float(np.max(np.abs(motion.displacement)))
                intervals[name] = (values[name], values[name])
    return Resisting(
        structure=structure, values=values, intervals=intervals, error=force - resistance(structure, values, motion)
    )


def in_standard_errors(found: Resisting, name: str) -> float:
    """Parameter over its standard error."""
    low, high = found.intervals[name]
    return found.values[name] / max((high - low) / (2 * INTERVAL), 1e-300) if math.isfinite(high - low) else 0.0
