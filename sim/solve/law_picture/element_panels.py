"""Pictures of an element that an effect brings along or changes: over displacement, velocity and the shaft's angle."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.elements import Element
from sim.solve.law_picture.along import Along, Place, resting
from sim.solve.law_picture.angle_panels import angle_panels
from sim.solve.law_picture.bench import Bench
from sim.solve.law_picture.panel import Axis, Curve, Panel
from sim.solve.law_picture.scale import USUAL, differs_along, telling_reach
from sim.solve.law_picture.side import Side
from sim.solve.law_picture.way import FORCE, RATE, Way, offsets, ways_of

POINTS = 241
TOUCH = 0.02
"""Share of the largest force with which two parts are held together while their speed varies."""


@dataclass(frozen=True, kw_only=True)
class Pressed:
    """A way, how far it was moved, and what came of it."""

    way: Way
    reach: float
    panel: Panel
    standing: bool
    """Whether the force was there without any motion."""

    @property
    def contrast(self) -> float:
        """How much the effect changes the force, N or N m."""
        (curve,) = self.panel.curves
        return float(np.max(np.abs(curve.here - (0.0 if curve.without is None else curve.without))))


def standing_panels(bench: Bench, ways: list[Way], place: Place) -> tuple[list[Panel], Place]:
    """Force over displacement and over velocity; and the place at which the element is pressed most tellingly."""
    found = [pressed for way in ways if (pressed := _over_displacement(way, place)) is not None]
    best = max(found, key=lambda p: round(p.contrast, 12), default=None)
    # of ways that are alike the first, whatever their rounding
    best = next((p for p in found if best is not None and p.contrast > 0.99 * best.contrast), None)
    panels = [] if best is None else [best.panel]
    if bench.element.rates:
        touching = place
        if best is not None and best.standing:
            touching = place.at(best.way.i, x=_touching(best, place))
        for way in ways:
            panel = _over_velocity(way, touching)
            if panel is not None and not any(_alike(panel, other) for other in panels):
                panels.append(panel)
    if best is None or not best.standing:
        return panels, place
    return panels, place.at(best.way.i, x=best.reach)


def _alike(one: Panel, other: Panel) -> bool:
    """Whether two panels show the same, as for the two axes of a round thing."""
    if one.title != other.title or one.values[-1] != other.values[-1]:
        return False
    pairs = zip(one.curves, other.curves, strict=True)
    return all(np.allclose(a.here, b.here, rtol=1e-6, atol=1e-6 * float(np.ptp(a.here))) for a, b in pairs)


def _over_displacement(way: Way, place: Place) -> Pressed | None:
    """At rest, else while it moves where there is no force without motion."""
    for rate in (0.0, USUAL[RATE[way.unit]]):
        start = place.at(way.i, v=rate)

        def law(x: float, side: Along = way.here, start: Place = start, rate: float = rate) -> float:
            return (side.moving if rate else side.held)(start.at(way.i, x=x))

        reach = telling_reach(law, way.unit, beyond=1.0 if rate else 1.5)
        x = np.linspace(-reach, reach, POINTS)
        y = np.array([law(float(value)) for value in x])
        other = np.array([law(float(value), way.without) for value in x])
        if not (differs_along(y) and differs_along(y - other)):
            continue
        moving = f" while it moves at {rate:g} {RATE[way.unit]}" if rate else ""
        beside = "" if rate else way.beside
        panel = Panel(
            title=f"{FORCE[way.unit].label} over displacement",
            caption=f"Resistance to the displacement of {way.moved}{moving}, all else at rest.{beside}",
            x=Axis(label="Displacement" if way.unit == "m" else "Twist", unit=way.unit),
            values=x,
            y=FORCE[way.unit],
            curves=(Curve(name="", here=y, without=other),),
        )
        if panel.telling:
            return Pressed(way=way, reach=reach, panel=panel, standing=not rate)
    return None


def _touching(pressed: Pressed, place: Place) -> float:
    """Displacement at which a small share of the force at the reach acts."""
    x = np.linspace(0.0, pressed.reach, POINTS)
    y = np.array([abs(pressed.way.here.held(place.at(pressed.way.i, x=float(value)))) for value in x])
    return float(x[int(np.argmax(y >= TOUCH * y[-1]))])


def _over_velocity(way: Way, place: Place) -> Panel | None:
    def law(v: float, side: Along = way.here) -> float:
        return side.moving(place.at(way.i, v=v))

    reach = telling_reach(law, RATE[way.unit])
    v = np.linspace(-reach, reach, POINTS)
    y = np.array([law(float(value)) for value in v])
    other = np.array([law(float(value), way.without) for value in v])
    if not (differs_along(y) and differs_along(y - other)):
        return None
    return Panel(
        title=f"{FORCE[way.unit].label} over velocity",
        caption=f"Resistance to the velocity of {way.name}{offsets(way, place)}.",
        x=Axis(label="Velocity", unit=RATE[way.unit]),
        values=v,
        y=FORCE[way.unit],
        curves=(Curve(name="", here=y, without=other),),
    )


def element_panels(here: Side, without: Side, element: Element) -> list[Panel]:
    """Force over displacement, velocity and angle, as far as they tell something."""
    bench = Bench(system=here.system, element=element)
    ways = ways_of(here, without, bench)
    (place,) = resting(here, bench, np.zeros(1))
    panels, pressed = standing_panels(bench, ways, place)
    turning = angle_panels(here, bench, ways, bench.zeros())
    turning = turning or angle_panels(here, bench, ways, pressed.u - place.u)
    return [panel for panel in (*panels, *turning) if panel.telling]
