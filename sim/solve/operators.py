"""Exact response of the linear part over one step to forces that are polynomials in the step.

z = (q, q'); z(c h) = e^{A c h} z(0) + sum_j W_j(c) f_j, with the contact forces f given by their node values through
Lagrange polynomials. The integrals are phi-functions, read off one augmented matrix exponential per block and node
(Van Loan 1978, IEEE Trans. Automatic Control 23(3), 395-404). The linear part falls into small blocks (shaft chains,
rings), so stiff dampers cost nothing and the whole step stays sparse.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache

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


@dataclass(frozen=True, kw_only=True)
class _Linear:
    """The linear part of a system, as there."""

    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    load: FloatArray


def _blocks(system: _Linear) -> list[NDArray[np.intp]]:
    """Groups of DOFs that stiffness or damping couples."""
    coupled = (system.stiffness != 0) | (system.damping != 0)
    label = np.arange(system.mass.size)
    for i in range(label.size):
        for j in np.flatnonzero(coupled[i]):
            label[label == label[j]] = label[i]
    return [np.flatnonzero(label == k) for k in np.unique(label)]


@dataclass(frozen=True, kw_only=True)
class _Block:
    """A block's matrices as bytes, so that machines which share a block share its exponentials."""

    a: bytes
    inputs: bytes
    spans: bytes
    inputs_shape: tuple[int, int]
    halvings: int


@lru_cache(maxsize=256)
def _kept_responses(block: _Block) -> tuple[tuple[FloatArray, FloatArray], ...]:
    n, m = block.inputs_shape
    return tuple(
        _responses(
            np.frombuffer(block.a).reshape(n, n),
            np.frombuffer(block.inputs).reshape(n, m),
            np.frombuffer(block.spans),
            block.halvings,
        )
    )


def _responses(
    a: FloatArray, inputs: FloatArray, spans: FloatArray, halvings: int
) -> list[tuple[FloatArray, FloatArray]]:
    """e^{A t} and the integrals of (t' / t)^p forces for every span t, then for halves of it, longest first.

    One exponential per span, of the shortest stretch; the longer ones follow by squaring. Shapes (s, n, n) and
    (s, p, n, m) for s spans.
    """
    n, m = inputs.shape
    stages = spans.size
    size = n + stages * m
    shortest = np.empty((spans.size, size, size))
    for i, span in enumerate(spans / 2.0 ** (halvings - 1)):
        big = np.zeros((size, size))
        big[:n, :n] = a * span
        big[:n, n : n + m] = inputs * span
        for p in range(stages - 1):
            big[n + p * m : n + (p + 1) * m, n + (p + 1) * m : n + (p + 2) * m] = np.eye(m)
        shortest[i] = expm(big)
    found = []
    for k in range(halvings):
        integrals = [
            shortest[:, :n, n + p * m : n + (p + 1) * m] * (math.factorial(p) / 2.0 ** (k * p)) for p in range(stages)
        ]
        found.append((shortest[:, :n, :n].copy(), np.stack(integrals, axis=1)))
        if k < halvings - 1:
            shortest = shortest @ shortest
    return found[::-1]


@dataclass(frozen=True, kw_only=True)
class _Wanted:
    """What operators follow from, told apart by `key`: machines that differ elsewhere, as in a contact, share them."""

    key: tuple[bytes, ...]
    places: tuple[tuple[int, ...], tuple[int, ...]]
    h: float
    levels: int
    linear: _Linear = field(compare=False)
    coords: Coordinates = field(compare=False)
    rule: Collocation = field(compare=False)


def step_operators(
    system: System, coords: Coordinates, rule: Collocation, h: float, levels: int = 1
) -> tuple[StepOperators, ...]:
    """Operators of a step of length `h` in s, and of its halvings: `levels` in all, longest first; to be read only."""
    linear = _Linear(mass=system.mass, damping=system.damping, stiffness=system.stiffness, load=system.load)
    arrays = (linear.mass, linear.damping, linear.stiffness, linear.load, coords.rows, rule.c)
    return _step_operators(
        _Wanted(
            key=tuple(a.tobytes() for a in arrays),
            places=(coords.force_rows, coords.rate_rows),
            h=h,
            levels=levels,
            linear=linear,
            coords=coords,
            rule=rule,
        )
    )


@lru_cache(maxsize=64)
def _step_operators(wanted: _Wanted) -> tuple[StepOperators, ...]:
    """Kept for some dozens of machines, on which one effect after the other is tried: 0.4 MB each for a machine of 60
    states, 2 MB for one of 100."""
    system, coords, rule, h, levels = wanted.linear, wanted.coords, wanted.rule, wanted.h, wanted.levels
    n, s = system.mass.size, rule.stages
    force = coords.rows[list(coords.force_rows)]
    columns = np.column_stack([-(force / system.mass).T, system.load / system.mass])
    f = force.shape[0]
    states = np.zeros((levels, s, 2 * n, 2 * n))
    polys = np.zeros((levels, s, s, 2 * n, f + 1))
    powers = rule.c[:, None] ** np.arange(s)
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
        spans = np.ascontiguousarray(rule.c * h)
        kept = _Block(
            a=a.tobytes(), inputs=inputs.tobytes(), spans=spans.tobytes(), inputs_shape=inputs.shape, halvings=levels
        )
        for level, (e, integrals) in enumerate(_kept_responses(kept)):
            states[level][:, both[:, None], both] = e
            polys[level][:, :, both[:, None], used] = integrals * powers[:, :, None, None]
    return tuple(_operators(coords, rule, h / 2.0**level, states[level], polys[level], f) for level in range(levels))


def _operators(
    coords: Coordinates, rule: Collocation, h: float, states: FloatArray, polys: FloatArray, f: int
) -> StepOperators:
    """Rows of the coordinates from the states (s, 2n, 2n) and integrals (s, p, 2n, f + 1) of one step length."""
    n = states.shape[1] // 2
    force = coords.rows[list(coords.force_rows)]
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
