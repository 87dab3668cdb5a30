"""A machine on the bench: its assembled system, its named laws, and the linear springs beside an element."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sim.assembly.assemble import assemble
from sim.assembly.kinematics import kinematics
from sim.assembly.laws import acting_terms, base_laws, modified_laws, settings_of
from sim.core.elements import Coordinate, Element
from sim.core.laws import Laws
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.terms import REGISTRY


@dataclass(frozen=True, kw_only=True)
class Side:
    """One of the two machines that a picture compares."""

    machine: MachineSpec
    system: System
    laws: Laws

    @property
    def elements(self) -> Mapping[str, Element]:
        """By name."""
        return {element.name: element for element in self.system.elements}


def side(machine: MachineSpec) -> Side:
    """Assemble a machine and keep its laws."""
    kin = kinematics(machine)
    acting = [a for a in acting_terms(machine, kin, REGISTRY, 0) if not a.term.idle(a.values)]
    settings = settings_of(machine, kin, acting)
    laws = modified_laws(base_laws(machine, {}, [], settings=settings, senses=kin.senses), acting)
    return Side(machine=machine, system=assemble(machine), laws=laws)


def differ(a: Element, b: Element) -> bool:
    """Whether two elements of one name have other parameters."""
    return not np.array_equal(a.parameters, b.parameters)


def between(matrix: FloatArray, system: System, coordinate: Coordinate) -> float:
    """The linear spring (damper) of a matrix that acts along a coordinate, N/m or N m/rad (times s).

    Between two degrees of freedom: what joins them. From one to the ground: what a motion of all alike would stretch.
    More of them, or one that the machine does not have: none.
    """
    if any(dof not in system.dofs for dof, _ in coordinate.weights):
        return 0.0
    places = [(system.index(dof), weight) for dof, weight in coordinate.weights]
    if len(places) == 2:
        (a, wa), (b, wb) = places
        return max(float(matrix[a, b] / (wa * wb)), 0.0) if wa * wb < 0.0 else 0.0
    if len(places) != 1:
        return 0.0
    i, weight = places[0]
    axis = system.dofs[i].rsplit(".", 1)[-1]
    alike = [j for j, dof in enumerate(system.dofs) if dof.rsplit(".", 1)[-1] == axis]
    held = float(matrix[i, alike].sum()) / weight**2
    return held if held > 1e-9 * abs(float(matrix[i, i])) else 0.0
