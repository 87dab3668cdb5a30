"""Radau IIA nodes and the polynomials built on them.

Hairer & Wanner, Solving Ordinary Differential Equations II, 2nd ed., sect. IV.5: three stages, order 5, L-stable.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim.core.response import FloatArray


def radau_nodes(stages: int) -> FloatArray:
    """Nodes of Radau IIA in (0, 1], shape (stages,); 1, 2 or 3 stages."""
    if stages == 1:
        return np.array([1.0])
    if stages == 2:
        return np.array([1.0 / 3.0, 1.0])
    if stages == 3:
        root = math.sqrt(6.0)
        return np.array([(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0])
    raise ValueError(f"Radau IIA is tabulated for 1 to 3 stages, not {stages}")


@dataclass(frozen=True, kw_only=True)
class Collocation:
    """Nodes `c` (s,), Lagrange coefficients `lagrange` (s, s) in ascending powers, weights `b` (s,)."""

    c: FloatArray
    lagrange: FloatArray
    b: FloatArray

    @property
    def stages(self) -> int:
        """Number of nodes."""
        return int(self.c.size)


def lagrange_coefficients(nodes: FloatArray) -> FloatArray:
    """Row j: ascending coefficients of the polynomial that is 1 at node j and 0 at the others."""
    vandermonde = np.vander(nodes, increasing=True)
    return np.ascontiguousarray(np.linalg.inv(vandermonde).T)


def collocation(stages: int) -> Collocation:
    """The Radau IIA collocation of a number of stages."""
    c = radau_nodes(stages)
    lagrange = lagrange_coefficients(c)
    b = lagrange @ (1.0 / np.arange(1, stages + 1))
    return Collocation(c=c, lagrange=lagrange, b=b)


def extrapolation(stages: int, ratio: float) -> FloatArray:
    """Weights (s, s + 1) that carry values at the start and nodes of a step to the nodes of the next.

    `ratio` is the length of the next step over that of the last.
    """
    c = radau_nodes(stages)
    known = np.concatenate([[0.0], c])
    targets = 1.0 + ratio * c
    return np.vander(targets, stages + 1, increasing=True) @ np.linalg.inv(np.vander(known, increasing=True))


def node_extrapolation(stages: int, ratio: float) -> FloatArray:
    """Weights (s, s) that carry values at the nodes of a step to the nodes of the next; `ratio` as above."""
    c = radau_nodes(stages)
    return np.vander(1.0 + ratio * c, stages, increasing=True) @ np.linalg.inv(np.vander(c, increasing=True))


def derivative_weights(stages: int) -> FloatArray:
    """Weights (s, s + 1): derivative at each node, per step, of the polynomial through start and nodes."""
    c = radau_nodes(stages)
    known = np.concatenate([[0.0], c])
    powers = np.arange(stages + 1)
    slopes = np.where(powers > 0, powers * c[:, None] ** np.maximum(powers - 1, 0), 0.0)
    return slopes @ np.linalg.inv(np.vander(known, increasing=True))
