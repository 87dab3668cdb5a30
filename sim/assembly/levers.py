"""Statics of a flexible shaft in its bearings: how far a seat gives way, and which share each bearing takes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sim.assembly.flexible import flexible_shaft
from sim.core.spec import MachineSpec, ShaftSpec


@dataclass(frozen=True, kw_only=True)
class Lever:
    """Answer to a unit force at a seat: deflection and slope there, and each bearing's share (their sum is 1)."""

    deflection_m_per_n: float
    slope_rad_per_n: float
    shares: Mapping[str, float]


def lever(machine: MachineSpec, shaft: ShaftSpec, part: str, springs_n_per_m: Mapping[str, float]) -> Lever:
    """Solve the beam on the springs of its bearings (by bearing, N/m) for a force at a gear or body."""
    beam = flexible_shaft(machine, shaft, 0.0)
    place = {dof: i for i, dof in enumerate(d for d in beam.masses if d.endswith("y"))}
    rows = [([(place[d], w) for d, w in named if d in place], k) for named, k, _ in beam.springs]
    grounded = {b: (place[f"{beam.seats[b]}.y"], k) for b, k in springs_n_per_m.items() if b in beam.seats}
    rows += [([(i, 1.0)], k) for i, k in grounded.values()]
    stiffness = np.zeros((len(place), len(place)))
    for weights, k in rows:
        for i, wi in weights:
            for j, wj in weights:
                stiffness[i, j] += k * wi * wj
    force = np.zeros(len(place))
    force[place[f"{part}.y"]] = 1.0
    bent = np.linalg.lstsq(stiffness, force, rcond=None)[0]
    return Lever(
        deflection_m_per_n=float(bent[place[f"{part}.y"]]),
        slope_rad_per_n=float(bent[place[f"{part}.slope_y"]]),
        shares={b: float(k * bent[i]) for b, (i, k) in grounded.items()},
    )
