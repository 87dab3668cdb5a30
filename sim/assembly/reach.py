"""Loose rings that never meet their bore: an effect that is asked for and does nothing but let the ring go."""

from __future__ import annotations

import numpy as np

from sim.assembly.modes import contact_stiffness
from sim.core.response import FloatArray
from sim.core.system import System
from sim.parts.wall_kernel import KERNEL

STEP_FACTOR = 2.0
"""A load that steps on at t = 0 carries an undamped mass on a spring twice as far as it stands in the end."""


HELD = 1e-6
"""Share of the load that may be out of balance by rounding."""


def static_displacement(system: System) -> FloatArray | None:
    """Where the constant load holds the machine (n,), m or rad, contacts linearised and walls away.

    The smallest such motion, where the machine may turn as a whole; None where the load goes on pushing because only
    walls hold against it, as with the ring of a shaft that has no other bearing on that side.
    """
    scale = 1.0 / np.sqrt(system.mass)
    stiffness = (system.stiffness + contact_stiffness(system)) * scale[:, None] * scale[None, :]
    load = system.load * scale
    found = np.linalg.lstsq(stiffness, load, rcond=1e-12)[0]
    if np.linalg.norm(stiffness @ found - load) > HELD * np.linalg.norm(load):
        return None
    return np.asarray(found * scale, dtype=np.float64)


def unreached_bores(system: System) -> tuple[str, ...]:
    """A sentence for each loose ring whose clearance is beyond where the load would carry it without the bore."""
    walls = [element for element in system.elements if element.kernel is KERNEL]
    displacement = static_displacement(system) if walls else None
    if displacement is None:
        return ()
    place = {name: i for i, name in enumerate(system.dofs)}
    found = []
    for wall in walls:
        moved = [sum(w * displacement[place[dof]] for dof, w in c.weights) for c in wall.coordinates]
        reach, gap = float(np.hypot(*moved)), float(wall.parameters[0])
        if gap > STEP_FACTOR * reach:
            found.append(
                f"{wall.site}: the load carries its loose ring {1e6 * reach:.3g} um, a clearance of {1e6 * gap:.4g} um "
                f"is not reached unless the ring vibrates that far: it may never touch the bore"
            )
    return tuple(found)
