"""How far machines of one structure may move before their motion counts as diverged."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.response import FloatArray
from sim.core.system import System
from sim.solve.chunks import IntArray

RUNAWAY = 1.0
"""Displacement in m no machine of this kind survives: treated as divergence."""


@dataclass(frozen=True, kw_only=True)
class Teeth:
    """Of one contact of teeth: `weights` (DOF, n) of its deflection in n machines, and the `most` of it, m, (n,)."""

    weights: FloatArray
    most: FloatArray

    def deflection(self, displacements: FloatArray) -> FloatArray:
        """(n,): what is no part of it may be infinite, or no number."""
        parts = np.zeros(displacements.shape)
        np.multiply(self.weights, displacements, out=parts, where=self.weights != 0.0)
        return np.asarray(parts.sum(axis=0))


@dataclass(frozen=True, kw_only=True)
class Bounds:
    """Places of what moves along a `line`, and `teeth` that meet. Angles as such are free: a train may turn whole."""

    line: IntArray
    teeth: tuple[Teeth, ...]


def bounds_of(systems: Sequence[System]) -> Bounds:
    """Of machines of one structure."""
    line = [i for i, name in enumerate(systems[0].dofs) if not name.endswith(".theta")]
    own = [_contacts(system) for system in systems]
    teeth = tuple(
        Teeth(weights=np.stack([w for w, _ in one], axis=1), most=np.array([most for _, most in one]))
        for one in zip(*own, strict=True)
    )
    return Bounds(line=np.array(line, dtype=np.int64), teeth=teeth)


def _contacts(system: System) -> list[tuple[FloatArray, float]]:
    """Weights (DOF,) of each deflection of teeth, and what it may be: a base pitch beyond the backlash. Teeth farther
    apart are no longer those that the tables speak of."""
    place, found = {name: i for i, name in enumerate(system.dofs)}, []
    for mesh in system.machine.meshes:
        count = next(g.teeth for g in system.machine.gears if g.name == mesh.pinion)
        for element in (e for e in system.elements if e.name == mesh.name):
            weights = np.zeros(len(system.dofs))
            for dof, weight in element.coordinates[0].weights:
                weights[place[dof]] += weight
            base_radius = weights[place[f"{mesh.pinion}.theta"]]
            found.append((weights, 2.0 * math.pi * base_radius / count + (mesh.backlash_m or 0.0)))
    return found


def beyond(bounds: Bounds, displacements: FloatArray) -> np.ndarray:
    """Whether displacements of the state (DOF, n) are out of bounds, or a mesh has jumped a tooth, (n,)."""
    out = np.any(np.abs(displacements[bounds.line]) > RUNAWAY, axis=0)
    for one in bounds.teeth:
        out |= np.abs(one.deflection(displacements)) > one.most
    return np.asarray(out)
