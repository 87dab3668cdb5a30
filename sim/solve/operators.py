"""Exact response of the linear part over one step to forces that are polynomials in the step.

z = (q, q'); z(c h) = e^{A c h} z(0) + sum_j W_j(c) f_j, with the contact forces f given by their node values through
Lagrange polynomials. The integrals are phi-functions, read off one augmented matrix exponential per block and node
(Van Loan 1978, IEEE Trans. Automatic Control 23(3), 395-404). The linear part falls into small blocks (shaft chains,
rings), so stiff dampers cost nothing and the whole step stays sparse.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.collocation import Collocation


@dataclass(frozen=True, kw_only=True)
class Coordinates:
    """Coordinate map of a system: rows (coordinates, n) and which of them carry forces.

    `rows`: all coordinates of all elements, element by element; `force_rows`: positions of the force coordinates;
    `rate_rows`: positions of force coordinates whose rate is needed at the nodes.
    """

    rows: FloatArray
    force_rows: tuple[int, ...]
    rate_rows: tuple[int, ...]


def coordinates(system: System) -> Coordinates:
    """Collect the coordinates of all elements."""
    rows: list[FloatArray] = []
    force_rows: list[int] = []
    rate_rows: list[int] = []
    place = {name: i for i, name in enumerate(system.dofs)}
    for element in system.elements:
        for k, coordinate in enumerate(element.coordinates):
            row = np.zeros(len(system.dofs))
            for dof, weight in coordinate.weights:
                row[place[dof]] += weight
            if k < element.forces:
                force_rows.append(len(rows))
                if element.rates:
                    rate_rows.append(len(rows))
            rows.append(row)
    table = np.array(rows) if rows else np.zeros((0, len(system.dofs)))
    return Coordinates(rows=table, force_rows=tuple(force_rows), rate_rows=tuple(rate_rows))


@dataclass(frozen=True, kw_only=True)
class StepOperators:
    """Operators of one step length h.

    `node_state` (s, R, 2n), `node_force` (s, R, s, F), `node_load` (s, R): coordinates and rates at the nodes;
    `end_state` (2n, 2n), `end_force` (2n, s, F), `end_load` (2n,): the state at the end.
    R rows are the force coordinates followed by the needed rates; F the number of forces.
    """

    h: float
    node_state: FloatArray
    node_force: FloatArray
    node_load: FloatArray
    end_state: FloatArray
    end_force: FloatArray
    end_load: FloatArray


def _blocks(system: System) -> list[NDArray[np.intp]]:
    """Groups of DOFs that stiffness or damping couples."""
    coupled = (system.stiffness != 0) | (system.damping != 0)
    label = np.arange(len(system.dofs))
    for i in range(label.size):
        for j in np.flatnonzero(coupled[i]):
            label[label == label[j]] = label[i]
    return [np.flatnonzero(label == k) for k in np.unique(label)]


def _responses(a: FloatArray, inputs: FloatArray, span: float, stages: int) -> tuple[FloatArray, list[FloatArray]]:
    """e^{A span} and the integrals int_0^span e^{A (span - t)} (t / h)^p dt B for p < stages, with h folded later."""
    n, m = inputs.shape
    big = np.zeros((n + stages * m, n + stages * m))
    big[:n, :n] = a * span
    big[:n, n : n + m] = inputs * span
    for p in range(stages - 1):
        big[n + p * m : n + (p + 1) * m, n + (p + 1) * m : n + (p + 2) * m] = np.eye(m)
    full = expm(big)
    return full[:n, :n], [full[:n, n + p * m : n + (p + 1) * m] * math.factorial(p) for p in range(stages)]


def step_operators(system: System, coords: Coordinates, rule: Collocation, h: float) -> StepOperators:
    """Build the operators of a step of length `h` in s."""
    n, s = len(system.dofs), rule.stages
    force = coords.rows[list(coords.force_rows)]
    columns = np.column_stack([-(force / system.mass).T, system.load / system.mass])
    f = force.shape[0]
    times = rule.c
    states = np.zeros((s, 2 * n, 2 * n))
    polys = np.zeros((s, s, 2 * n, f + 1))
    for block in _blocks(system):
        both = np.concatenate([block, block + n])
        k = block.size
        inverse = 1.0 / system.mass[block][:, None]
        a = np.zeros((2 * k, 2 * k))
        a[:k, k:] = np.eye(k)
        a[k:, :k] = -system.stiffness[np.ix_(block, block)] * inverse
        a[k:, k:] = -system.damping[np.ix_(block, block)] * inverse
        used = np.flatnonzero(np.any(columns[block] != 0, axis=0))
        inputs = np.zeros((2 * k, used.size))
        inputs[k:] = columns[np.ix_(block, used)]
        for i, c in enumerate(times):
            e, integrals = _responses(a, inputs, c * h, s)
            states[i][np.ix_(both, both)] = e
            for p, value in enumerate(integrals):
                polys[i, p][np.ix_(both, used)] = value * c**p
    weights = np.einsum("jp,ipzf->ijzf", rule.lagrange, polys[..., :f])
    loads = polys[:, 0, :, f]
    rows = np.zeros((f + len(coords.rate_rows), 2 * n))
    rows[:f, :n] = force
    rows[f:, n:] = coords.rows[list(coords.rate_rows)]
    return StepOperators(
        h=h,
        node_state=np.einsum("rz,izy->iry", rows, states),
        node_force=np.einsum("rz,ijzf->irjf", rows, weights),
        node_load=np.einsum("rz,iz->ir", rows, loads),
        end_state=states[-1],
        end_force=np.ascontiguousarray(np.moveaxis(weights[-1], 0, 1)),
        end_load=loads[-1],
    )
