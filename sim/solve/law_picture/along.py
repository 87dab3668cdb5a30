"""The whole law along one coordinate of an element: the element itself and the machine's linear spring beside it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from sim.core.elements import Coordinate
from sim.core.response import FloatArray
from sim.solve.law_picture.bench import Bench
from sim.solve.law_picture.carried import carried, mean_load_n
from sim.solve.law_picture.side import Side, between


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where and how the element is held while one coordinate moves: all its coordinates (size,), and the instant."""

    u: FloatArray
    ud: FloatArray
    time_s: float = 0.0

    def moved(self, by: FloatArray) -> Place:
        """The same with all coordinates displaced."""
        return replace(self, u=self.u + by)

    def at(self, i: int, *, x: float | None = None, v: float | None = None) -> Place:
        """The same with coordinate i elsewhere, or faster."""
        u, ud = self.u.copy(), self.ud.copy()
        if x is not None:
            u[i] = x
        if v is not None:
            ud[i] = v
        return replace(self, u=u, ud=ud)


@dataclass(frozen=True, kw_only=True)
class Along:
    """Resistance along coordinate `i`, N or N m: bench (None: no such element on this side), spring and damper."""

    bench: Bench | None
    i: int
    stiffness: float
    damping: float
    seat: float | None = None
    """Where the coordinate ends on a mass that the effect brought along: the stiffness that holds it; it gives way."""

    def held(self, place: Place) -> float:
        """Force for a displacement: the element and the spring."""
        if self.seat is not None:
            return self._in_series(place)
        return self._element(place, self.i) + self.stiffness * float(place.u[self.i])

    def moving(self, place: Place) -> float:
        """Force for a velocity: the element and the damper, without the spring."""
        return self._element(place, self.i) + self.damping * float(place.ud[self.i])

    def _element(self, place: Place, j: int) -> float:
        if self.bench is None:
            return 0.0
        return float(self.bench.force(self.bench.row(place.time_s, place.u), place.u, place.ud)[j])

    def _in_series(self, place: Place) -> float:
        x, held = place.u[self.i], self.seat or 0.0

        def unbalanced(given: float) -> float:
            return self._element(place.at(self.i, x=x - given), self.i) - held * given

        if x == 0.0 or held == 0.0:
            return 0.0
        ends = unbalanced(0.0), unbalanced(x)
        return 0.0 if ends[0] * ends[1] > 0.0 or ends[0] == 0.0 else held * brentq(unbalanced, 0.0, x, xtol=1e-12)


def along(here: Side, without: Side, bench: Bench, i: int) -> Along:
    """The law on the side that has the element."""
    coordinate = bench.element.coordinates[i]
    new = [dof for dof, _ in coordinate.weights if dof not in without.system.dofs]
    if len(coordinate.weights) == 2 and len(new) == 1:
        ground = Coordinate(name=coordinate.name, unit=coordinate.unit, weights=((new[0], 1.0),))
        return Along(
            bench=bench, i=i, stiffness=0.0, damping=0.0, seat=between(here.system.stiffness, here.system, ground)
        )
    return Along(
        bench=bench,
        i=i,
        stiffness=between(here.system.stiffness, here.system, coordinate),
        damping=between(here.system.damping, here.system, coordinate),
    )


def against(without: Side, bench: Bench, i: int) -> Along:
    """The law along the same coordinate on the side that lacks the element, or has it otherwise."""
    coordinate = bench.element.coordinates[i]
    known = tuple((dof, weight) for dof, weight in coordinate.weights if dof in without.system.dofs)
    same = replace(coordinate, weights=known)
    element = without.elements.get(bench.element.name)
    return Along(
        bench=None if element is None else Bench(system=without.system, element=element),
        i=i,
        stiffness=between(without.system.stiffness, without.system, same),
        damping=between(without.system.damping, without.system, same),
    )


def resting(here: Side, bench: Bench, times: FloatArray) -> list[Place]:
    """The element at rest at some instants, teeth that it looks at under their mean load."""
    u = np.zeros((times.size, bench.element.size))
    law = here.laws.meshes.get(bench.element.site)
    for i, coordinate in enumerate(bench.element.coordinates):
        if law is not None and coordinate.name == f"{law.name}.deflection":
            mesh = Bench(system=here.system, element=here.elements[law.name])
            loaded = carried(mesh, times, mean_load_n(law))
            u[:, i] = 0.0 if loaded is None else loaded
    return [Place(u=row, ud=bench.zeros(), time_s=float(t)) for row, t in zip(u, times, strict=True)]
