"""Linearised modes: the linear part plus mean contact stiffness under the static load."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigh

from sim.core.response import FloatArray
from sim.core.system import System


def contact_stiffness(system: System) -> FloatArray:
    """Stiffness matrix (n, n) of all contacts that are not walls, by their own plain tangent near the working point.

    The working point of an element is a deflection that carries the machine's largest static contact force.
    """
    n = len(system.dofs)
    place = {name: i for i, name in enumerate(system.dofs)}
    total = np.zeros((n, n))
    for element in system.elements:
        if element.stiff or element.linear_stiffness is None:
            continue
        columns = np.zeros((n, element.forces))
        for k, coordinate in enumerate(element.coordinates[: element.forces]):
            for dof, weight in coordinate.weights:
                columns[place[dof], k] += weight
        total += columns @ np.atleast_2d(element.linear_stiffness) @ columns.T
    return total


def natural_frequencies_hz(system: System) -> FloatArray:
    """Undamped natural frequencies of the linearised machine, ascending, Hz; rigid-body modes are 0."""
    stiffness = system.stiffness + contact_stiffness(system)
    scale = 1.0 / np.sqrt(system.mass)
    values = eigh(stiffness * scale[:, None] * scale[None, :], eigvals_only=True)
    floor = 1e-9 * max(float(values[-1]), 1.0) if values.size else 0.0
    result: FloatArray = np.sqrt(np.where(values > floor, values, 0.0)) / (2 * np.pi)
    return result


def whirl_frequencies_hz(system: System) -> FloatArray:
    """Damped natural frequencies with gyroscopic moments and contacts linearised, ascending, Hz; one a mode."""
    n = len(system.dofs)
    stiffness = system.stiffness + contact_stiffness(system)
    inverse = 1.0 / system.mass[:, None]
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-stiffness * inverse, -system.damping * inverse]])
    turning = np.linalg.eigvals(a).imag / (2 * np.pi)
    result: FloatArray = np.sort(turning[turning > 1e-6 * np.max(np.abs(turning), initial=1.0)])
    return result
