"""Waves around a race: what both rings' waviness declares alike."""

from __future__ import annotations

import numpy as np

from sim.core.laws import RACE_POINTS
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.terms import Values

MOST_WAVES = 100
"""Twenty points of the profile's table a wave; beyond, the table would cut the waves."""
WAVE_PARAMS = (
    Param(
        name="amplitude",
        unit="m",
        default=1e-6,
        low=0.0,
        high=2e-5,
        sentence="Peak height of the waves, half of peak to valley.",
        scale="log",
    ),
    Param(
        name="order",
        unit="1",
        default=8.0,
        low=1.0,
        high=float(MOST_WAVES),
        sentence="Waves per turn of the race, a whole number.",
        choices=tuple(float(n) for n in range(1, MOST_WAVES + 1)),
    ),
    Param(name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Phase of the waves at angle 0."),
)


def waves_m(values: Values) -> FloatArray:
    """Gap over the race angle, m, shape (RACE_POINTS,): amplitude * sin(order * angle + phase)."""
    angle = 2.0 * np.pi * np.arange(RACE_POINTS) / RACE_POINTS
    return np.asarray(values["amplitude"] * np.sin(values["order"] * angle + values["phase"]), dtype=np.float64)


def passes(order: int, balls: int, farthest: int = 3) -> tuple[tuple[int, int], ...]:
    """(k, order - k Z) of the multiples k >= 0 of the ball pass that waves of an order excite, nearest first.

    All balls together answer a wave only where order -+ 1 is a multiple of their number (Wardle 1988); a load zone,
    itself a sum of harmonics, lets the next ones through.
    """
    found = sorted(((k, order - k * balls) for k in range(order // balls + 2)), key=lambda pair: abs(pair[1]))
    return tuple(pair for i, pair in enumerate(found) if i == 0 or abs(pair[1]) <= farthest)
