"""Whirl speeds of two rotors by ross (rotordynamics library, Apache-2.0; consistent masses), printed as Python.

python -m venv other && other/bin/pip install ross-rotordynamics==2.3.0 "plotly<6"
PYTHONPATH=. other/bin/python -m tests.sim.assembly.whirl_by_ross
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Rotor:
    """Segments (length, diameter, bore) m; disc: place m, mass kg, diametral and polar kg m^2; springs."""

    segments: tuple[tuple[float, float, float], ...]
    disc: tuple[float, float, float, float]
    spring_n_per_m: float
    springs_at_m: tuple[float, float]


ROTORS = {
    "overhung": Rotor(
        segments=((0.3, 0.03, 0.0),), disc=(0.3, 5.0, 0.0072, 0.0144), spring_n_per_m=2e7, springs_at_m=(0.0, 0.2)
    ),
    "stepped": Rotor(
        segments=((0.1, 0.03, 0.0), (0.2, 0.05, 0.02), (0.1, 0.03, 0.0)),
        disc=(0.2, 8.0, 0.02, 0.036),
        spring_n_per_m=5e7,
        springs_at_m=(0.0, 0.4),
    ),
}
SPEEDS_HZ = (0.0, 200.0)
ELEMENT_M = 0.0125
MODES = 6


def whirl_hz(rotor: Rotor, speed_hz: float) -> list[float]:
    """The lowest whirl frequencies, Hz; needs ross."""
    import ross  # noqa: PLC0415

    steel = ross.Material(name="steel", rho=7850, E=2.06e11, Poisson=0.3)
    elements, ends = [], [0.0]
    for length, outer, bore in rotor.segments:
        count = round(length / ELEMENT_M)
        for _ in range(count):
            elements.append(ross.ShaftElement(length / count, bore, outer, material=steel))
            ends.append(ends[-1] + length / count)

    def node(place: float) -> int:
        return min(range(len(ends)), key=lambda i: abs(ends[i] - place))

    place, mass, diametral, polar = rotor.disc
    discs = [ross.DiskElement(n=node(place), m=mass, Id=diametral, Ip=polar)]
    k = rotor.spring_n_per_m
    held = [ross.BearingElement(n=node(z), kxx=k, kyy=k, cxx=0.0, cyy=0.0) for z in rotor.springs_at_m]
    found = ross.Rotor(elements, discs, held).run_modal(speed=2 * math.pi * speed_hz, num_modes=24)
    return [round(float(w) / (2 * math.pi), 3) for w in found.wd[:MODES]]


if __name__ == "__main__":
    print({(name, hz): whirl_hz(rotor, hz) for name, rotor in ROTORS.items() for hz in SPEEDS_HZ})
