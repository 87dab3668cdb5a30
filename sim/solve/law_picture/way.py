"""A coordinate of an element on the bench, and what resists along it with the effect and without."""

from __future__ import annotations

from dataclasses import dataclass

from sim.core.elements import Coordinate
from sim.solve.law_picture.along import Along, Place, against, along
from sim.solve.law_picture.bench import Bench
from sim.solve.law_picture.panel import Axis, told
from sim.solve.law_picture.side import Side

FORCE = {"m": Axis(label="Force", unit="N"), "rad": Axis(label="Torque", unit="N*m")}
RATE = {"m": "m/s", "rad": "rad/s"}


def measured(coordinate: Coordinate, *, axis: bool = True) -> str:
    """Degrees of freedom of a coordinate, those that count positive against the others."""
    sides: tuple[dict[str, None], dict[str, None]] = ({}, {})
    for dof, weight in coordinate.weights:
        sides[weight < 0.0][dof if axis else dof.rsplit(".", 1)[0]] = None
    return " against ".join(" and ".join(side) for side in sides if side)


@dataclass(frozen=True, kw_only=True)
class Way:
    """One forced coordinate of an element, and the law along it with the effect and without."""

    coordinate: Coordinate
    i: int
    here: Along
    without: Along

    @property
    def unit(self) -> str:
        """Of the coordinate, m or rad."""
        return self.coordinate.unit

    @property
    def name(self) -> str:
        """Where the coordinate is measured: `bearing1.outer.y`, or one against the other."""
        return measured(self.coordinate)

    @property
    def moved(self) -> str:
        """What is displaced: where a seat gives way, the part that rests on it."""
        return self.name if self.here.seat is None else self.coordinate.weights[0][0]

    @property
    def part(self) -> str:
        """The same without the axis."""
        return measured(self.coordinate, axis=False)

    @property
    def beside(self) -> str:
        """What else than the element pushes along it."""
        if self.here.seat is not None:
            return " Its seat gives way on the spring that holds it."
        return " The machine's own spring there is included." if self.here.stiffness else ""


def ways_of(here: Side, without: Side, bench: Bench) -> list[Way]:
    """Every coordinate on which the element can push."""
    return [
        Way(coordinate=c, i=i, here=along(here, without, bench, i), without=against(without, bench, i))
        for i, c in enumerate(bench.element.coordinates[: bench.element.forces])
        if c.weights
    ]


def offsets(way: Way, place: Place) -> str:
    """Where the element is held meanwhile."""
    element = way.here.bench.element if way.here.bench is not None else None
    held = []
    for c, u in zip(element.coordinates if element else (), place.u, strict=element is not None):
        if u != 0.0 and c.name.endswith(".deflection"):
            held.append(f"{c.name.rsplit('.', 1)[0]} under its mean load")
        elif u != 0.0:
            held.append(f"{measured(c) if len(c.weights) < 3 else c.name} displaced by {told(u, c.unit)}")
    return ", " + ", ".join(held) if held else ", all else at rest"
