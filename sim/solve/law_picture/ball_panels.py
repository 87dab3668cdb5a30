"""Pictures of a bearing's balls: marks on the races, force over displacement, force over the angle of the shaft."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sim.core.laws import RACE_POINTS, BallLaw
from sim.core.response import FloatArray
from sim.solve.law_picture.bench import Bench
from sim.solve.law_picture.panel import Axis, Curve, Panel, told
from sim.solve.law_picture.scale import rounded
from sim.solve.law_picture.side import Side

POINTS, TURN_POINTS = 241, 721
PRESSED_M = 1e-5
"""How far beyond the clearance the inner ring is pressed for the picture over the angle."""
DIRECTIONS = {"x": (0, 1.0), "-x": (0, -1.0), "y": (1, 1.0), "-y": (1, -1.0)}
RACES = {
    "outer_profile_m": "outer race",
    "inner_profile_m": "inner race",
    "ball_profile_m": "first ball (outer and inner contact)",
}
AROUND = 4.0
"""A mark is shown with so many of its widths around it."""


def ball_panels(here: Side, without: Side | None, name: str) -> list[Panel]:
    """Every picture of the bearing's contacts that shows the effect."""
    law = here.laws.balls[name]
    bench = Bench(system=here.system, element=here.elements[name])
    before = None if without is None else Bench(system=without.system, element=without.elements[name])
    panels = [] if without is None else _profiles(law, without.laws.balls[name])
    if without is None or law.gap_m != without.laws.balls[name].gap_m:
        panels.append(_over_displacement(bench, before, law))
    panels.append(_over_angle(bench, before, law))
    return [panel for panel in panels if panel.telling]


def _profiles(law: BallLaw, sound: BallLaw) -> list[Panel]:
    panels = []
    for field, race in RACES.items():
        mine, other = (_table(getattr(one, field)) for one in (law, sound))
        if np.array_equal(mine, other):
            continue
        angle, part = _window(mine - other)
        panels.append(
            Panel(
                title=f"Profile of the {race}",
                caption=f"How far the surface stands back from a sound one, over the angle on the {race}.",
                x=Axis(label="Angle on the surface", unit="rad"),
                values=angle,
                y=Axis(label="Gap", unit="m"),
                curves=(Curve(name="", here=mine[part], without=other[part]),),
            )
        )
    return panels


def _table(profile: FloatArray | None) -> FloatArray:
    return np.zeros(RACE_POINTS) if profile is None else profile


def _window(change: FloatArray) -> tuple[FloatArray, NDArray[np.int64]]:
    """Angles and places in the table: around a mark that takes little of the turn, else the whole turn."""
    n = change.size
    marked = np.flatnonzero(np.abs(change) > 1e-3 * np.max(np.abs(change)))
    centre = math.atan2(*(float(np.sum(f(2.0 * np.pi * marked / n))) for f in (np.sin, np.cos)))
    middle = round(centre * n / (2.0 * np.pi))
    off = (marked - middle + n // 2) % n - n // 2
    half = int(np.max(np.abs(off)) * AROUND) + 2
    if half > n // 4:
        return 2.0 * np.pi * np.arange(n) / n, np.arange(n)
    places = np.arange(middle - half, middle + half + 1)
    return 2.0 * np.pi * places / n, places % n


def _pressed(bench: Bench, way: str, displacement_m: float) -> FloatArray:
    axis, sign = DIRECTIONS[way]
    u = bench.zeros()
    u[axis] = sign * displacement_m
    return u


def _resistance(bench: Bench, row: FloatArray, way: str, displacement_m: float) -> float:
    axis, sign = DIRECTIONS[way]
    return sign * float(bench.force(row, _pressed(bench, way, displacement_m))[axis])


def _over_displacement(bench: Bench, before: Bench | None, law: BallLaw) -> Panel:
    reach = rounded(2.0 * (max(law.gap_m, 0.0) + PRESSED_M))
    x = np.linspace(-reach, reach, POINTS)

    def curve(one: Bench) -> FloatArray:
        row = one.row(0.0)
        return np.array([_resistance(one, row, "y", float(value)) for value in x])

    return Panel(
        title="Force over displacement",
        caption=f"Resistance of the balls of {law.name} to the inner ring's motion along y, shaft at the angle 0.",
        x=Axis(label="Inner ring against outer ring", unit="m"),
        values=x,
        y=Axis(label="Force", unit="N"),
        curves=(Curve(name="", here=curve(bench), without=None if before is None else curve(before)),),
    )


def _over_angle(bench: Bench, before: Bench | None, law: BallLaw) -> Panel:
    """The ring held where it is; the direction is the one in which the effect is felt most."""
    held_m = max(law.gap_m, 0.0) + PRESSED_M
    angle = np.linspace(0.0, 2.0 * np.pi, TURN_POINTS)
    times = angle / bench.speed_rad_per_s
    rows = [bench.row(float(t)) for t in times]
    others = None if before is None else [before.row(float(t)) for t in times]

    def curves(way: str) -> Curve:
        here = np.array([_resistance(bench, row, way, held_m) for row in rows])
        if before is None or others is None:
            return Curve(name="", here=here, without=None)
        return Curve(name="", here=here, without=np.array([_resistance(before, row, way, held_m) for row in others]))

    def felt(curve: Curve) -> float:
        return float(np.ptp(curve.here if curve.without is None else curve.here - curve.without))

    found = {way: curves(way) for way in DIRECTIONS}
    way = "-y" if before is None else max(found, key=lambda key: felt(found[key]))
    return Panel(
        title="Force over the angle of the shaft",
        caption=f"Resistance of the balls of {law.name}, inner ring held {told(held_m, 'm')} towards {way}.",
        x=Axis(label=f"Angle of {law.body}", unit="rad"),
        values=angle,
        y=Axis(label="Force", unit="N"),
        curves=(found[way],),
    )
