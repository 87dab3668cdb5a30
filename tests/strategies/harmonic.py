"""Steady motion of linear systems under harmonic forces, and elements lifted out of a machine into a small system."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from sim.assembly.assemble import assemble
from sim.core.elements import Coordinate, Element
from sim.core.spec import MachineSpec, TermSpec
from sim.core.system import System
from tests.strategies.running import drive
from tests.strategies.systems import bare_system, with_terms


def element_of(machine: MachineSpec, term: str, site: str, **values: float) -> Element:
    """The first element a term adds to a machine."""
    before = {e.name for e in assemble(machine).elements}
    system = assemble(with_terms(machine, TermSpec(term=term, site=site, parameters=values)))
    return next(e for e in system.elements if e.name not in before)


def on(element: Element, *weights: Sequence[tuple[str, float]]) -> Element:
    """The element on other coordinates."""
    coordinates = tuple(
        Coordinate(name=f"{element.name}.{k}", unit="m", weights=tuple(w)) for k, w in enumerate(weights)
    )
    return replace(element, coordinates=coordinates)


def small_system(
    dofs: Sequence[str],
    mass: Sequence[float],
    elements: tuple[Element, ...],
    speeds_hz: Mapping[str, float],
    **matrices,
) -> System:
    """A system of these matrices and elements, whose shafts turn at these speeds."""
    return replace(bare_system(dofs, mass, elements=elements, **matrices), speeds_hz={"": 0.0} | dict(speeds_hz))


def steady_amplitude(mass, damping, stiffness, force, omega):
    """Complex amplitude A of q = Re(A exp(i omega t))."""
    return np.linalg.solve(stiffness - omega**2 * np.diag(mass) + 1j * omega * damping, force)


def steady_error(system: System, force, omega: float, *, step_s: float, steps: int) -> float:
    """Largest deviation from the steady motion under Re(force exp(i omega t)), begun on it, over the largest."""
    amplitude = steady_amplitude(system.mass, system.damping, system.stiffness, np.asarray(force), omega)
    start = np.concatenate([amplitude.real, (1j * omega * amplitude).real])
    states = drive(system, step_s=step_s, steps=steps, start=start).states
    t = step_s * np.arange(states.shape[0])
    exact = (amplitude[None, :] * np.exp(1j * omega * t)[:, None]).real
    n = len(system.dofs)
    return float(np.max(np.abs(states[:, :n] - exact)) / np.max(np.abs(amplitude)))


def allowed(term, test: str) -> float:
    """The deviation that a term's declaration names for a test."""
    return next(v.deviation for v in term.validation if v.test.endswith(f"::{test}"))
