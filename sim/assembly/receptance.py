"""Receptances of the linearised machine: how far a point moves by a harmonic force elsewhere."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sim.assembly.modes import contact_stiffness
from sim.core.response import FloatArray
from sim.core.system import System


def receptances(
    system: System, frequencies_hz: FloatArray, *, forces: Sequence[str], motions: Sequence[str]
) -> np.ndarray:
    """Complex receptances (frequencies, motions, forces), m/N: displacement of the DOFs `motions` by a harmonic force
    of 1 N on the DOFs `forces` (rad and N m where these turn).

    H = (K + K_c - omega^2 M + i omega C)^-1 (Ewins, Modal Testing, 2nd ed. 2000, section 2.5), with K_c the contacts'
    mean tangent (`contact_stiffness`); contacts' own damping, play and stiffness that varies over a turn are left out.
    An acceleration is -omega^2 times it. ValueError where a DOF does not exist.
    """
    sources, ends = ([system.index(name) for name in names] for names in (forces, motions))
    omega = 2.0 * np.pi * np.asarray(frequencies_hz, dtype=np.float64)
    stiffness = system.stiffness + contact_stiffness(system)
    dynamic = stiffness - omega[:, None, None] ** 2 * np.diag(system.mass) + 1j * omega[:, None, None] * system.damping
    unit = np.zeros((len(system.dofs), len(sources)))
    unit[sources, range(len(sources))] = 1.0
    moved = np.linalg.solve(dynamic, np.broadcast_to(unit, (omega.size, *unit.shape)))
    return np.asarray(moved[:, ends, :])
