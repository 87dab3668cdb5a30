"""An element's forces over the angle of the shaft that it follows: excitations, and resistances that turn."""

from __future__ import annotations

import numpy as np

from sim.core.response import FloatArray
from sim.core.spec import ForceLoad
from sim.solve.law_picture.along import Place, resting
from sim.solve.law_picture.bench import Bench
from sim.solve.law_picture.panel import Axis, Curve, Panel
from sim.solve.law_picture.scale import differs_along
from sim.solve.law_picture.side import Side
from sim.solve.law_picture.way import FORCE, Way, offsets

POINTS = 721
TEETH = 3
"""Mesh periods shown of what repeats with every tooth."""
USUAL_HZ = 20.0


def angle_panels(here: Side, bench: Bench, ways: list[Way], moved: FloatArray) -> list[Panel]:
    """One panel for the forces and one for the torques, where the angle changes them.

    What no motion changes is an excitation and shown as a force on the machine; anything else as a resistance with the
    coordinates `moved` (size,) off their places.
    """
    axis, values, times = _turn(here, bench)
    places = [place.moved(moved) for place in resting(here, bench, times)]
    rows = [bench.row(place.time_s, place.u) for place in places]
    forces = np.array([bench.force(row, place.u, place.ud) for row, place in zip(rows, places, strict=True)])
    panels = []
    for unit in dict.fromkeys(way.unit for way in ways):
        most = max(float(np.max(np.abs(forces[:, way.i]))) for way in ways if way.unit == unit)
        mine = [way for way in ways if way.unit == unit and np.max(np.abs(forces[:, way.i])) > 1e-9 * most]
        if not any(differs_along(forces[:, way.i]) for way in mine):
            continue
        driven = not np.any(places[0].u) and all(_given(bench, rows[0], way.i) for way in mine)
        panels.append(
            Panel(
                title=f"{FORCE[unit].label} over the {'time' if axis.unit == 's' else 'angle'}",
                caption=_driven_caption(mine, unit) if driven else _caption(mine, places[0]),
                x=axis,
                values=values,
                y=FORCE[unit],
                curves=tuple(_curve(way, forces, places, driven=driven, alone=len(mine) == 1) for way in mine),
            )
        )
    return panels


def _turn(here: Side, bench: Bench) -> tuple[Axis, FloatArray, FloatArray]:
    """Axis, values (n,) and times (n,) of one turn, of a few teeth, or of two periods of what follows time."""
    speed = bench.speed_rad_per_s
    if speed == 0.0:
        rates = [x.frequency_hz for x in here.machine.loads if isinstance(x, ForceLoad) and x.frequency_hz > 0.0]
        t = np.linspace(0.0, 2.0 / min(rates, default=USUAL_HZ), POINTS)
        return Axis(label="Time", unit="s"), t, t
    turn = 2.0 * np.pi
    law = here.laws.meshes.get(bench.element.site)
    if law is not None:
        turn *= TEETH / law.teeth[0]
    angle = np.linspace(0.0, turn, POINTS)
    return Axis(label=f"Angle of {bench.element.shafts[0]}", unit="rad"), angle, angle / speed


def _curve(way: Way, forces: FloatArray, places: list[Place], *, driven: bool, alone: bool) -> Curve:
    name = "" if alone else way.coordinate.name.rsplit(".", 1)[-1]
    mine = forces[:, way.i]
    if driven:
        return Curve(name=name, here=-mine, without=np.zeros(mine.size))
    others = np.array([way.without.held(place) for place in places])
    return Curve(name=name, here=mine + way.here.stiffness * places[0].u[way.i], without=others)


def _driven_caption(mine: list[Way], unit: str) -> str:
    parts = dict.fromkeys(way.name if len(mine) == 1 else way.part for way in mine)
    return f"{FORCE[unit].label} on {', '.join(parts)} that the effect brings with it, whatever the motion."


def _caption(mine: list[Way], place: Place) -> str:
    names = " and ".join(dict.fromkeys(way.name if len(mine) == 1 else way.part for way in mine))
    return f"Resistance at {names}{offsets(mine[0], place)}.{mine[0].beside}"


def _given(bench: Bench, row: FloatArray, i: int) -> bool:
    """Whether neither displacements nor velocities change a force."""
    u = bench.zeros()
    return bool(bench.force(row, u + 1e-5, u + 1e-2)[i] == bench.force(row, u)[i])
