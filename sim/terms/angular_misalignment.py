"""Angular misalignment: the shafts on both sides of a coupling meet at an angle, as in Hooke's (a Cardan) joint.

Torsion: the driven side turns by tan(psi + eps) = tan psi / cos alpha, so the shaft is twisted by
eps = sum over n of q^n / n sin 2 n psi, q = tan^2(alpha / 2). Bending: the cross carries torque only along its normal,
so a couple T tan(alpha) sin psi (sin psi, -cos psi) bends the shaft; the first and the last bearing bear it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.elements import Coordinate, Element, Output
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import (
    bearings_of,
    bodies_on,
    coupling_spring,
    moves,
    refusal,
    shaft_lines,
    shaft_torque_nm,
    turning_on,
)
from sim.parts.turning import Harmonic, in_direction, turning_element

TERMS = 5
"""Terms of the series kept: at 30 degrees q is 0.072 and the sixth 2e-8."""
TWIST = (Output(name="torque", quantity="torque", unit="N*m", axis="theta"),)
BENDING = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
)


def twist_harmonics(angle: float, phase: float, stiffness: float, damping: float) -> tuple[Harmonic, ...]:
    """Torque of a spring and damper that the joint twists, N m."""
    q = math.tan(0.5 * angle) ** 2
    found = []
    for n in range(1, TERMS + 1):
        twist, c, s = q**n / n, math.cos(2 * n * phase), math.sin(2 * n * phase)
        rate = 2.0 * n * damping * twist
        found.append(
            Harmonic(
                order=2.0 * n,
                cosine=(stiffness * twist * s,),
                sine=(stiffness * twist * c,),
                cosine_rate=(rate * c,),
                sine_rate=(-rate * s,),
            )
        )
    return tuple(found)


def bending_harmonics(couple: float, direction: float, phase: float, sense: float) -> tuple[Harmonic, ...]:
    """Force at the bearing beyond, N, for the couple over the bearings' distance T tan(alpha) / L = `couple`, N."""
    half, shift = 0.5 * couple, 2.0 * (phase - direction)
    c, s = math.cos(shift), math.sin(shift)
    steady = in_direction(0.0, (0.0, 0.0), (-half, 0.0), direction)
    along = (-half * s, -half * sense * c)
    across = (half * c, -half * sense * s)
    return steady, in_direction(2.0, along, across, direction)


@dataclass(frozen=True, kw_only=True)
class AngularMisalignment(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """A torque in the shaft's torsional spring, and a pair of forces at its outermost bearings."""
        machine = site.machine
        found: list[Element] = []
        ended = any(s.name == site.site and s.end_inertia_kg_m2 is not None for s in machine.shafts)
        if ended and len(turning_on(machine, site.site)) > 1:
            found.append(self._twist(values, site))
        bearings = [
            b for name in bodies_on(machine, site.site) if moves(machine, name) for b in bearings_of(machine, name)
        ]
        if len(bearings) > 1:
            found.append(self._bending(values, site, bearings[0].name, bearings[-1].name))
        if not found:
            lacks = "it twists the shaft's torsional spring and loads its bearings"
            raise refusal(site, self.key, lacks, "a shaft with an end mass and a gear, or with two bearings")
        return found

    def _twist(self, values: Values, site: SiteContext) -> Element:
        near, far, stiffness, damping = coupling_spring(site, self.key)
        name = f"{site.site}.joint"
        weights = ((f"{far}.theta", 1.0), (f"{near}.theta", -1.0))
        return turning_element(
            name=f"{name}.twist",
            site=site.site,
            body=near,
            coordinates=(Coordinate(name=name, unit="rad", weights=weights),),
            harmonics=twist_harmonics(values["angle"], values["phase"], stiffness, damping),
            outputs=TWIST,
        )

    def _bending(self, values: Values, site: SiteContext, near: str, far: str) -> Element:
        shaft = next(s for s in site.machine.shafts if s.name == site.site)
        couple = shaft_torque_nm(site) * math.tan(values["angle"]) / shaft.length_m
        name = f"{site.site}.joint.bending"
        coordinates = tuple(
            Coordinate(name=f"{name}.{a}", unit="m", weights=((f"{far}.inner.{a}", 1.0), (f"{near}.inner.{a}", -1.0)))
            for a in ("x", "y")
        )
        return turning_element(
            name=name,
            site=site.site,
            body=bodies_on(site.machine, site.site)[0],
            coordinates=coordinates,
            harmonics=bending_harmonics(couple, values["direction"], values["phase"], site.sense),
            outputs=BENDING,
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Twice and four times the shaft's rotation."""
        return shaft_lines(site, self.key, (2, 4)) if values["angle"] != 0.0 else ()


TERM = AngularMisalignment(
    key="angular_misalignment",
    title="Angular misalignment of a coupling",
    sentence="The shafts meet at an angle in the coupling, which twists and bends the shaft twice a turn.",
    sites=("shaft",),
    params=(
        Param(
            name="angle",
            unit="rad",
            default=0.02,
            low=0.0,
            high=0.52,
            sentence="Angle between the axes of the two shafts (0.52 rad is 30 degrees).",
            sought=(0.01, 0.3),
            scale="log",
        ),
        Param(
            name="direction",
            unit="rad",
            default=0.0,
            low=-6.2832,
            high=6.2832,
            sentence="Angle from x of the plane in which the shafts meet.",
        ),
        Param(name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of the fork at t = 0."),
    ),
    references=(
        "Shigley & Uicker, Theory of Machines and Mechanisms, 2nd ed. 1995 (kinematics of Hooke's joint)",
        "derived on the page: series of the twist, couple of the cross",
    ),
    severity="angle",
    order=20,
    demo=Demo(leading=2, values={"angle": 0.2}),
    validation=(
        Validation(
            kind="closed form",
            source="tan(psi + eps) = tan(psi) / cos(alpha) of Hooke's joint, and the torque along the cross's normal",
            deviation=2e-6,
            test="tests/sim/terms/test_angular_misalignment.py::test_twist_is_that_of_hookes_joint",
        ),
    ),
)
