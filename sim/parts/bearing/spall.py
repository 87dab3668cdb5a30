"""What a spall takes away: how far a ball sinks as it rolls over a pit with sharp edges, from geometry alone.

A ball of radius r leaves the race at the entry edge, turns about it while it sinks, and rises at the exit edge. With
the nearer edge an angle psi away, its centre stands where ball and edge are a radius apart; it sinks no deeper than
the floor. Small angles: drop = s^2 / 2 (1/r -+ 1/R), s the arc to the edge, R the race (- outer, + inner). The idea
of the ball's path over a spall as its geometry: Sawalhi & Randall 2011, Mech. Syst. Signal Process. 25(3), 846-870.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sim.core.laws import RACE_POINTS
from sim.core.response import FloatArray
from sim.parts.bearing.frequencies import Ring


@dataclass(frozen=True, kw_only=True)
class Contact:
    """Ball and race in the plane of rolling, m: the radii at the contact point."""

    ball_m: float
    race_m: float
    ring: Ring


def contact(*, pitch_m: float, ratio: float, ratio_cos: float, ring: Ring) -> Contact:
    """Contact of a bearing: race radius (D -+ d cos alpha) / 2."""
    side = 1.0 if ring == "outer" else -1.0
    return Contact(ball_m=0.5 * pitch_m * ratio, race_m=0.5 * pitch_m * (1.0 + side * ratio_cos), ring=ring)


def _inside(spread_rad: FloatArray, width_rad: float) -> FloatArray:
    """Angle to the nearer edge, rad, of points `spread_rad` from the middle; negative outside."""
    return np.asarray(0.5 * width_rad - np.abs(spread_rad), dtype=np.float64)


def _capped(drop_m: FloatArray, edge_rad: FloatArray, depth_m: float) -> FloatArray:
    return np.where(edge_rad > 0.0, np.minimum(drop_m, depth_m), 0.0)


def race_drop_m(at: Contact, spread_rad: FloatArray, *, width_rad: float, depth_m: float) -> FloatArray:
    """Drop of a ball `spread_rad` from the middle of a pit in the race, m, not negative."""
    edge = _inside(spread_rad, width_rad)
    r, race = at.ball_m, at.race_m
    span = r**2 - (race * np.sin(edge)) ** 2
    reach = np.sqrt(np.maximum(span, 0.0))
    side = 1.0 if at.ring == "outer" else -1.0
    drop = r - reach - side * race * (1.0 - np.cos(edge))
    return _capped(np.where((span > 0.0) & (edge < 0.5 * np.pi), drop, np.inf), edge, depth_m)


def ball_drop_m(at: Contact, spread_rad: FloatArray, *, width_rad: float, depth_m: float) -> FloatArray:
    """Approach of ball and race when a pit in the ball faces the race `spread_rad` (ball angle) off its middle, m."""
    edge = _inside(spread_rad, width_rad)
    r, race = at.ball_m, at.race_m
    bulge = race - np.sqrt(race**2 - np.minimum((r * np.sin(edge)) ** 2, race**2))
    side = -1.0 if at.ring == "outer" else 1.0
    return _capped(np.maximum(r * (1.0 - np.cos(edge)) + side * bulge, 0.0), edge, depth_m)


FINE = 16
"""Points within a cell of the table whose mean is kept."""


def pit_table_m(drop_m: Callable[[FloatArray], FloatArray], middle_rad: float) -> FloatArray:
    """Table (RACE_POINTS,) of a drop given over the angle from its middle, m.

    Each entry is the mean over the cell around it, so that the table holds the area of a pit of any width at any
    place. A cell is 0.18 degrees, 0.07 mm on a race of 46 mm: about the length of the contact itself.
    """
    cells = np.arange(RACE_POINTS * FINE) - 0.5 * (FINE - 1)
    angle = 2.0 * np.pi * cells / (RACE_POINTS * FINE) - middle_rad
    spread = (angle + np.pi) % (2.0 * np.pi) - np.pi
    return np.asarray(drop_m(spread).reshape(RACE_POINTS, FINE).mean(axis=1), dtype=np.float64)


def added(profile_m: FloatArray | None, more_m: FloatArray) -> FloatArray:
    """Two profiles on one surface: gaps add."""
    return more_m if profile_m is None else profile_m + more_m
