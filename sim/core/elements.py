"""Contact elements: the local non-linear forces of a machine, each on a few generalised coordinates.

An element sees u = L^T q of its own coordinates and their rates, and returns the generalised force that the
machine feels on the first `forces` of them *as a resistance*: the equations of motion read
M q'' + C q' + K q = F - B f(u, u', t). The remaining coordinates are observed only.

Calling convention (all pointers to doubles; node k of the step is the last, at its end):

step    [t0, h, s, c_1..c_s, then s*s Lagrange coefficients (row j: ascending powers of l_j), then s weights b_j, then
        the sampling interval (s) for which mode 2 draws jumps band-limited, since a filter follows; 0: as they are]
shafts  4 rows of length s + 1 (start, then nodes): angle and speed of the first shaft, angle and speed of the second
ctx     (s + 1) rows of `context` doubles: row i < s for node i (may hold step-averaged values); elements with
        `exact_end` fill row s for the exact instant at the end of the step, the others are observed with row s - 1
mode    0 force only; 1 also the tangent into out (df/du then df/dud, each `forces` rows of `size`);
        2 observe: `out` receives the declared outputs after [stored energy, dissipated power, parametric power]
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim.core.kernels import Kernel
from sim.core.response import FloatArray

STAGES = 3
"""Collocation nodes of a step (Radau IIA)."""
OUT_ENERGY = 3
"""Leading outputs of mode 2: stored energy J, dissipated power W, parametric power W."""


@dataclass(frozen=True, kw_only=True)
class Coordinate:
    """A generalised coordinate: sum of coefficient * DOF."""

    name: str
    unit: str
    weights: tuple[tuple[str, float], ...]


@dataclass(frozen=True, kw_only=True)
class Output:
    """A channel an element can report."""

    name: str
    quantity: str
    unit: str
    axis: str = ""


@dataclass(frozen=True, kw_only=True)
class Element:
    """One contact: kernel, coordinates, parameters, and the shafts whose angle it follows.

    `forces` of the coordinates carry a force; `stiff` elements are solved by Newton within each step and must
    give their tangent. `parameters` is a flat float64 array the kernel reads (scalars, then tables).
    """

    name: str
    site: str
    kernel: Kernel
    coordinates: tuple[Coordinate, ...]
    forces: int
    parameters: FloatArray
    context: int
    shafts: tuple[str, str]
    outputs: tuple[Output, ...] = ()
    rates: bool = True
    """Whether the force depends on ud (forces of elements without rates are cheaper)."""
    stiff: bool = False
    opens: bool = False
    """Whether the force is exactly zero in free flight: a step in which it begins or ends is halved, as for walls."""
    exact_end: bool = False
    """Whether the force at the end of a step differs from the one at the last node (step-averaged tables)."""
    contact_output: int = -1
    """Index of the output that is 1 in contact and 0 in free flight; -1: none."""

    range_output: int = -1
    """Index of the output that is 1 where a table ends and its last value is used; -1: none."""

    linear_stiffness: FloatArray | None = None
    """Mean stiffness (forces, forces) near the working point, N/m, for natural frequencies; None: not counted."""

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.coordinates)


def flat(*parts: float | FloatArray) -> FloatArray:
    """Concatenate scalars and tables to one float64 parameter array."""
    return np.concatenate([np.atleast_1d(np.asarray(p, dtype=np.float64)).ravel() for p in parts])
