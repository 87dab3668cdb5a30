"""An extra mode of the structure at a bearing: a mass on a spring and damper on its seat (cover, pipe, plate).

The modal mass m and the frequency f of the part alone give its spring k = m (2 pi f)^2 and damper 2 zeta m (2 pi f).
It adds one degree of freedom, `bearing1.mode.y`; no mass is the healthy machine.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from sim.core.laws import AddedMass, AddedSpring, Laws
from sim.core.params import Param
from sim.core.terms import SiteContext, Term, Validation, Values


@dataclass(frozen=True, kw_only=True)
class SupportMode(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Hang the mass on the housing where the ring has one of its own, else on the outer ring."""
        mass = values["mass"]
        if mass == 0.0:
            return laws
        axis = "x" if values["axis"] == 0.0 else "y"
        seat = "housing" if laws.supports[site.site].housing_mass_kg > 0.0 else "outer"
        omega = 2.0 * math.pi * values["frequency"]
        name = f"{site.site}.mode.{axis}"
        spring = AddedSpring(
            a=name,
            b=f"{site.site}.{seat}.{axis}",
            stiffness=mass * omega**2,
            damping=2.0 * values["damping_ratio"] * mass * omega,
        )
        return replace(laws, masses=(*laws.masses, AddedMass(name=name, mass=mass, springs=(spring,))))


TERM = SupportMode(
    key="support_mode",
    title="Extra mode at a support",
    sentence="A part of the structure on the bearing's seat has a resonance of its own.",
    sites=("bearing",),
    params=(
        Param(
            name="mass",
            unit="kg",
            default=0.1,
            low=0.0,
            high=1e3,
            sentence="Modal mass of the part, scaled to the motion of the seat.",
            scale="log",
        ),
        Param(
            name="frequency",
            unit="Hz",
            default=800.0,
            low=1.0,
            high=1e4,
            sentence="Natural frequency of the part on a seat that stands still.",
            scale="log",
        ),
        Param(name="damping_ratio", unit="1", default=0.02, low=0.0, high=1.0, sentence="Damping ratio of the part."),
        Param(
            name="axis",
            unit="1",
            default=1.0,
            low=0.0,
            high=1.0,
            sentence="Direction of its motion: 0 along x, 1 along y.",
            choices=(0.0, 1.0),
        ),
    ),
    references=("Den Hartog, Mechanical Vibrations, 4th ed. 1956, ch. 3 (a mass on a spring on a mass on a spring)",),
    severity="mass",
    order=30,
    excludes=("fit_clearance",),
    repeats="axis",
    validation=(
        Validation(
            kind="closed form",
            source="natural frequencies of two masses on two springs, Den Hartog ch. 3",
            deviation=1e-9,
            test="tests/sim/terms/test_support_mode.py::test_two_masses",
        ),
    ),
)
