"""An assembled machine: matrices, loads and contact elements, ready for any solver."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sim.core.elements import Element
from sim.core.lines import Line
from sim.core.response import Channel, FloatArray
from sim.core.spec import MachineSpec


@dataclass(frozen=True, kw_only=True)
class Damper:
    """A linear damper of C, kept apart for the energy balance: power = damping * (sum weight * rate)^2."""

    weights: tuple[tuple[int, float], ...]
    damping: float


@dataclass(frozen=True, kw_only=True)
class System:
    """M q'' + C q' + K q = F - sum over elements of B f(u, u', phi(t)).

    `mass` (n,) kg or kg m^2; `damping`, `stiffness` (n, n); `load` (n,) N or N m, constant from t = 0.
    `speeds_hz` gives the rotation of each shaft and body; `dofs` the names (`bearing1.outer.y`).
    """

    machine: MachineSpec
    dofs: tuple[str, ...]
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray
    dampers: tuple[Damper, ...]
    load: FloatArray
    elements: tuple[Element, ...]
    speeds_hz: Mapping[str, float]
    speed: FloatArray
    """Table of the speed over time (`sim.core.speed`)."""
    dynamic_angle: Mapping[str, int]
    """Body name to the index of its theta DOF, when the shaft angle includes the torsional motion."""
    bases_hz: Mapping[str, float]
    lines: tuple[Line, ...]
    derived: Mapping[str, str]
    warnings: tuple[str, ...]
    channels: tuple[Channel, ...]
    """Every output the machine can give."""

    def index(self, dof: str) -> int:
        """Position of a DOF; ValueError when it does not exist."""
        return self.dofs.index(dof)
