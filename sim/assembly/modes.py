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


BENDING = 0.5
"""Share of a mode's kinetic energy in the nodes of flexible shafts above which it is theirs."""
UNTOUCHED = 1e-3
"""Share of the contacts in a mode's stiffness below which it belongs to the linear part."""


def contact_frequencies_hz(system: System) -> FloatArray:
    """`natural_frequencies_hz` without modes of flexible shafts that no contact reaches.

    The linear part is solved exactly whatever the step, so such modes need no small one. Machines on rigid shafts have
    none of them.
    """
    nodes = {name.rpartition(".")[0] for name in system.dofs if ".slope_" in name}
    bending = np.array([name.rpartition(".")[0] in nodes for name in system.dofs])
    if not np.any(bending):
        return natural_frequencies_hz(system)
    contacts = contact_stiffness(system)
    scale = 1.0 / np.sqrt(system.mass)
    values, vectors = eigh((system.stiffness + contacts) * scale[:, None] * scale[None, :])
    share = np.einsum("im,ij,jm->m", vectors * scale[:, None], contacts, vectors * scale[:, None])
    beam = (np.sum(vectors[bending] ** 2, axis=0) > BENDING) & (share < UNTOUCHED * values)
    result: FloatArray = np.sqrt(np.maximum(values[~beam], 0.0)) / (2 * np.pi)
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
