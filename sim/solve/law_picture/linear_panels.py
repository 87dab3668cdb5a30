"""Pictures of linear effects: a mass on a spring that joins the machine, and weights."""

from __future__ import annotations

import math

import numpy as np

from sim.core.elements import Coordinate
from sim.core.laws import AddedMass
from sim.core.response import FloatArray
from sim.solve.law_picture.panel import Axis, Curve, Panel
from sim.solve.law_picture.scale import rounded
from sim.solve.law_picture.side import Side, between

POINTS = 401
USUAL_M = 1e-5
BAND = 2.0
"""The dynamic stiffness is shown to so many times the part's own frequency."""


def mass_panels(here: Side, mass: AddedMass) -> list[Panel]:
    """Spring force, and the force at the seat for a displacement of it, over the frequency."""
    found: list[Panel] = []
    system = here.system
    i = system.index(mass.name)
    for spring in mass.springs:
        seat = "the ground" if spring.b is None else spring.b
        ends = ((mass.name, 1.0),) if spring.b is None else ((mass.name, 1.0), (spring.b, -1.0))
        k = between(system.stiffness, system, Coordinate(name=mass.name, unit="m", weights=ends))
        c = between(system.damping, system, Coordinate(name=mass.name, unit="m", weights=ends))
        own_hz = math.sqrt(k / float(system.mass[i])) / (2.0 * math.pi)
        x = np.linspace(-USUAL_M, USUAL_M, POINTS)
        f = np.linspace(0.0, rounded(BAND * own_hz), POINTS)
        omega = 2.0 * np.pi * f
        joined = k + 1j * omega * c
        felt = np.abs(joined - joined**2 / (joined - omega**2 * float(system.mass[i])))
        found += [
            _panel(
                "Force at the seat over frequency",
                f"Force that {mass.name} puts on {seat} for each metre by which that is shaken, at steady vibration.",
                ("Frequency", "Hz", f),
                ("Force per displacement", "N/m", felt),
            ),
            _panel(
                "Spring force over displacement",
                f"Force of the spring between {mass.name} and {seat}.",
                ("Displacement of the part against its seat", "m", x),
                ("Force", "N", k * x),
            ),
        ]
    return found


def _panel(title: str, caption: str, x: tuple[str, str, FloatArray], y: tuple[str, str, FloatArray]) -> Panel:
    return Panel(
        title=title,
        caption=caption,
        x=Axis(label=x[0], unit=x[1]),
        values=x[2],
        y=Axis(label=y[0], unit=y[1]),
        curves=(Curve(name="", here=y[2], without=np.zeros_like(y[2])),),
    )


def weight_panel(here: Side, without: Side, shaft: str) -> Panel:
    """Weight of all that an effect lets gravity pull at, over one turn: it does not turn with the shaft."""
    angle = np.linspace(0.0, 2.0 * np.pi, 73)
    change = here.system.load - without.system.load
    pulled = {
        a: sum(float(change[i]) for i, d in enumerate(here.system.dofs) if d.endswith(f".{a}")) for a in ("x", "y")
    }
    most = max(abs(force) for force in pulled.values())
    curves = [
        Curve(name=axis, here=np.full(angle.size, force), without=np.zeros(angle.size))
        for axis, force in pulled.items()
        if abs(force) > 1e-9 * most
    ]
    parts = sorted({dof.rsplit(".", 1)[0] for i, dof in enumerate(here.system.dofs) if change[i] != 0.0})
    return Panel(
        title="Weight over the angle",
        caption=f"Force on {', '.join(parts)} together; it stands still while the shaft turns.",
        x=Axis(label=f"Angle of {shaft}", unit="rad"),
        values=angle,
        y=Axis(label="Force", unit="N"),
        curves=tuple(curves),
    )
