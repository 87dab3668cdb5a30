"""Energy balance of a run, computed from states, forces and closed forms; not from the solver's residual.

work of loads + work of what moves by itself = change of stored energy + dissipated energy + residual.
What moves by itself: turning balls, turning forces and the transmission error (-F e'), each from its own formula, so a
wrong energy or dissipation of a wall, a bearing or an excitation shows in the residual. The one exception is the work
of the varying mesh stiffness: it jumps at tooth entries, and is the remainder of the mesh's own balance (work at the
collocation nodes, stored, dissipated, error), so the residual does not test that split.
Stored energy is 1/2 v'Mv + 1/2 q'Kq + the elements' potentials; dissipation is integrated from the rates.
"""

from __future__ import annotations

import numpy as np

from sim.core.response import EnergyBalance, FloatArray
from sim.core.system import System
from sim.solve.settings import ENERGY_LIMIT


def energy_balance(system: System, z: FloatArray, work: FloatArray, energy: FloatArray) -> EnergyBalance:
    """Balance from rest at t = 0 to the state `z`; `work` (E,) J, `energy` as `sampling.account` fills it."""
    n = len(system.dofs)
    q, v = z[:n], z[n : 2 * n]
    stored = {
        "kinetic": float(0.5 * v @ (system.mass * v)),
        "linear_springs": float(0.5 * q @ system.stiffness @ q),
    }
    dissipated = {"linear_dampers": float(energy[0])}
    supplied = {"loads": float(system.load @ q)}
    through = abs(supplied["loads"]) + stored["kinetic"] + stored["linear_springs"] + dissipated["linear_dampers"]
    for e, element in enumerate(system.elements):
        now, lost, given, first = (float(energy[2 + 6 * e + k]) for k in range(4))
        done = float(work[e])
        stored[element.name] = now - first
        dissipated[element.name] = lost
        if "transmission_error" in [o.name for o in element.outputs]:
            supplied[f"{element.name}.transmission_error"] = given
            supplied[f"{element.name}.stiffness_variation"] = done + (now - first) + lost - given
        else:
            supplied[element.name] = given
        through += abs(done) + abs(lost)
    residual = sum(supplied.values()) - sum(stored.values()) - sum(dissipated.values())
    return EnergyBalance(
        work_j=supplied,
        stored_j=stored,
        dissipated_j=dissipated,
        residual_j=float(residual),
        scale_j=float(np.maximum(through, 1e-300)),
        limit=ENERGY_LIMIT,
    )
