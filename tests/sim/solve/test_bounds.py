"""Motions that left all bounds are told machine by machine, whatever else is no number."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.system import System
from sim.presets import preset
from sim.solve.bounds import RUNAWAY, Bounds, beyond, bounds_of


@pytest.fixture(scope="module")
def system() -> System:
    return assemble(preset("two-stage"), seed=0)


@pytest.fixture(scope="module")
def bounds(system: System) -> Bounds:
    return bounds_of([system] * 3)


def state(system: System, **moved: float) -> np.ndarray:
    """(DOF, 3): the second of three machines has `moved`, by names whose dots are underscores."""
    found = np.zeros((len(system.dofs), 3))
    for name, value in moved.items():
        found[system.dofs.index(name.replace("__", ".")), 1] = value
    return found


def test_a_displacement_of_a_metre_is_out_and_a_turn_is_not(system: System, bounds: Bounds) -> None:
    meshing = np.any([one.weights[:, 0] != 0.0 for one in bounds.teeth], axis=0)
    free = (name for name, own in zip(system.dofs, meshing, strict=True) if name.endswith(".x") and not own)
    line = next(free).replace(".", "__")
    assert beyond(bounds, state(system, **{line: 1.001 * RUNAWAY})).tolist() == [False, True, False]
    assert not beyond(bounds, state(system, **{line: -0.999 * RUNAWAY})).any()
    meshed = {dof for mesh in system.machine.meshes for dof in (f"{mesh.pinion}.theta", f"{mesh.gear}.theta")}
    turning = next(name for name in system.dofs if name.endswith(".theta") and name not in meshed)
    assert not beyond(bounds, state(system, **{turning.replace(".", "__"): 100.0})).any()


@pytest.mark.parametrize("number", [0, 1])
def test_teeth_a_base_pitch_apart_have_jumped_at_every_mesh(system: System, bounds: Bounds, number: int) -> None:
    mesh = system.machine.meshes[number]
    teeth = next(g.teeth for g in system.machine.gears if g.name == mesh.pinion)
    pitch = 2.0 * math.pi / teeth
    name = f"{mesh.pinion}__theta"
    slack = (mesh.backlash_m or 0.0) / bounds.teeth[number].weights[system.dofs.index(f"{mesh.pinion}.theta"), 0]
    assert beyond(bounds, state(system, **{name: 1.001 * (pitch + slack)})).tolist() == [False, True, False]
    assert beyond(bounds, state(system, **{name: -1.001 * (pitch + slack)})).tolist() == [False, True, False]


@pytest.mark.parametrize("lost", [math.nan, math.inf])
def test_what_is_no_number_elsewhere_hides_no_jump(system: System, bounds: Bounds, lost: float) -> None:
    mesh = system.machine.meshes[0]
    used = bounds.teeth[0].weights[:, 0] != 0.0
    other = next(n for n, own in zip(system.dofs, used, strict=True) if not own and n.endswith(".theta"))
    moved = {f"{mesh.pinion}__theta": 1.0, other.replace(".", "__"): lost}
    assert beyond(bounds, state(system, **moved))[1]
