"""Parallel misalignment: the shafts on both sides of a coupling are offset, and its elements are pressed in turn.

Two opposite elements of stiffness k at the angles psi and psi + pi of the turning hub press along n = (cos, sin) psi
against the offset vector d. Element 1 pushes with its full stiffness, element 2 with 1 - `odd` of it:

F = -k [ (1 - odd / 2) (d.n) n + (odd / 2) |d.n| n ]

The first part is a constant and a force that turns at twice the shaft's speed, the second the orders 1, 3, 5, ...
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Element, Output
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import bearings_of, bodies_on, moves, plane, refusal, shaft_lines
from sim.parts.turning import Harmonic, in_direction, turning_element

OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
)
HIGHEST = 15
"""Highest order kept of the odd part, whose series falls with the square of the order."""


def along(order: int) -> float:
    """Coefficient of cos(order psi) in |cos psi| cos psi, for odd orders."""
    return 8.0 / math.pi * (-1.0) ** ((order + 1) // 2) / (order * (order * order - 4))


def across(order: int) -> float:
    """Coefficient of sin(order psi) in |cos psi| sin psi, for odd orders."""
    return 4.0 / math.pi * (-1.0) ** ((order + 1) // 2) / (order * order - 4)


def harmonics(force: float, odd: float, direction: float, phase: float, sense: float) -> tuple[Harmonic, ...]:
    """Series of the force for k |d| = `force`, N; psi = sense phi + phase - direction is counted from the offset."""
    even = -0.5 * force * (1.0 - 0.5 * odd)
    shift = phase - direction

    def wave(order: int, x: float, y: float) -> Harmonic:
        c, s = math.cos(order * shift), math.sin(order * shift)
        return in_direction(float(order), (x * c, -sense * x * s), (y * s, sense * y * c), direction)

    found = [in_direction(0.0, (even, 0.0), (0.0, 0.0), direction), wave(2, even, even)]
    size = -0.5 * force * odd
    return tuple(found + [wave(n, size * along(n), size * across(n)) for n in range(1, HIGHEST + 1, 2)])


@dataclass(frozen=True, kw_only=True)
class ParallelMisalignment(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """A force on the inner ring beside the coupling: the first bearing of the shaft."""
        bodies = [b for b in bodies_on(site.machine, site.site) if moves(site.machine, b)]
        if not bodies:
            raise refusal(site, self.key, "nothing on this shaft moves in x and y", "a shaft whose gear translates")
        bearings = [b for name in bodies for b in bearings_of(site.machine, name)]
        place = f"{bearings[0].name}.inner" if bearings else bodies[0]
        force = values["stiffness"] * values["offset"]
        waves = harmonics(force, values["odd"], values["direction"], values["phase"], site.sense)
        name = f"{site.site}.offset"
        return (
            turning_element(
                name=name,
                site=site.site,
                body=bodies[0],
                coordinates=plane(place, name),
                harmonics=waves,
                outputs=OUTPUTS,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Twice the shaft's rotation; with unequal elements the odd orders too."""
        if values["offset"] == 0.0 or values["stiffness"] == 0.0:
            return ()
        return shaft_lines(site, self.key, (2, 1, 3) if values["odd"] > 0.0 else (2,))


TERM = ParallelMisalignment(
    key="parallel_misalignment",
    title="Parallel misalignment of a coupling",
    sentence="The shafts are offset at the coupling, whose elements push the shaft to the side twice a turn.",
    sites=("shaft",),
    params=(
        Param(
            name="offset",
            unit="m",
            default=1e-4,
            low=0.0,
            high=2e-3,
            sentence="Distance between the axes of the two shafts at the coupling.",
            sought=(5e-5, 2e-3),
            scale="log",
        ),
        Param(
            name="stiffness",
            unit="N/m",
            default=1e6,
            low=0.0,
            high=1e8,
            sentence="Radial stiffness of one of the coupling's elements.",
            scale="log",
        ),
        Param(
            name="odd",
            unit="1",
            default=0.2,
            low=0.0,
            high=1.0,
            sentence="By how much the opposite element is softer: 0 equal elements, 1 one element alone.",
        ),
        Param(
            name="direction", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of the offset from x."
        ),
        Param(
            name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of the element at t = 0."
        ),
    ),
    references=(
        "derived on the page from elastic elements of a turning hub",
        (
            "Sekhar & Prabhu 1995, Effects of coupling misalignment on vibrations of rotating machinery, J. "
            "Sound Vib. 185(4) (second harmonic as its signature)"
        ),
    ),
    severity="offset",
    order=20,
    demo=Demo(values={"offset": 2e-4, "odd": 0.5}),
    validation=(
        Validation(
            kind="independent calculation",
            source="force of the two elements evaluated directly over a turn and by Fourier integrals",
            deviation=1e-9,
            test="tests/sim/terms/test_parallel_misalignment.py::test_series_is_the_force_of_the_elements",
        ),
    ),
)
