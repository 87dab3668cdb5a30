"""Rows and layers of the stiffness tables: as far as a machine can move, and no farther than the teeth work."""

from __future__ import annotations

import math

import numpy as np

from sim.core.errors import SpecError
from sim.parts.gear.pair import GearPair
from sim.parts.gear.pair_table import ERROR_SHARE, legal_errors_m
from sim.parts.gear.tooth import FloatArray

ROWS = 33
TILT_RAD, TILT_STEP_RAD = 5e-4, 5e-5
"""Least reach of the tilts: five times what the paper's machine reaches. Step: 1e-3 of the stiffness (tests)."""
TILT_LIMIT_RAD = 5e-3
"""Largest tilt of a table: 0.12 mm over a face of 24 mm, far into edge contact."""
LAYERS = 81
"""Layers at most; beyond, the steps widen."""


def covering_errors_m(pair: GearPair, play_m: float) -> FloatArray:
    """Centre-distance errors in equal steps with a row at 0, over +-(0.1 module or `play_m`, whichever is more).

    Each side ends where the teeth stop working: contact ratio 1 when the centres part, a tip on the mate's base circle
    when they close (`ContactGeometry.problems`).
    """
    least = ERROR_SHARE * pair.pinion.module_m
    step = least / (ROWS // 2)
    wanted = max(least, step * math.ceil(play_m / step - 1e-9))
    low, high = (_limit_m(pair, side * wanted) for side in (-1.0, 1.0))
    if wanted == least and low == high == least:
        return legal_errors_m(pair, least, ROWS)
    count = (math.floor(low / step + 1e-9), math.floor(high / step + 1e-9))
    return np.asarray(step * np.arange(-count[0], count[1] + 1), dtype=np.float64)


def _limit_m(pair: GearPair, error_m: float) -> float:
    """Largest distance towards `error_m` at which the teeth work, m."""
    if _works(pair, error_m):
        return abs(error_m)
    low, high = 0.0, 1.0
    while high - low > 1e-9:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _works(pair, middle * error_m) else (low, middle)
    return low * abs(error_m)


def _works(pair: GearPair, error_m: float) -> bool:
    try:
        pair.contact(error_m)
    except SpecError:
        return False
    return True


def covering_tilts_rad(play_rad: float) -> FloatArray:
    """Tilts in equal steps, symmetric, over the least reach or `play_rad`, up to the limit."""
    steps = math.ceil(min(max(TILT_RAD, play_rad), TILT_LIMIT_RAD) / TILT_STEP_RAD - 1e-9)
    reach = TILT_STEP_RAD * steps
    return np.linspace(-reach, reach, min(2 * steps + 1, LAYERS))
