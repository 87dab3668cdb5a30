"""Mean mesh forces of trains by hand, and the play of a mesh."""

from __future__ import annotations

import pytest

from sim.assembly.play import MARGIN, SUDDEN, mesh_play
from sim.assembly.transmitted import transmitted_forces_n
from sim.parts.mesh_law import base_radius_m
from tests.strategies.trains import STIFFNESS, train


def radii(machine):
    return {g.name: base_radius_m(g) for g in machine.gears}


def test_an_idler_passes_the_force_on():
    machine = train({"a": 20, "b": 30, "c": 25}, [("a", "b"), ("b", "c")], {"a": 20.0})
    force = 20.0 / radii(machine)["a"]
    found = transmitted_forces_n(machine, {"shaft_a": 20.0, "shaft_c": -25.0})
    assert found == pytest.approx({"mesh1": force, "mesh2": force})


def test_a_middle_shaft_splits_its_torque_and_drives_as_the_gear_of_one_mesh():
    machine = train({"a": 20, "b": 30, "c": 25}, [("a", "b"), ("b", "c")], {"b": 60.0})
    r = radii(machine)
    found = transmitted_forces_n(machine, {"shaft_a": -20.0, "shaft_b": 60.0, "shaft_c": -25.0})
    assert found == pytest.approx({"mesh1": -20.0 / r["a"], "mesh2": 25.0 / r["c"]})


def test_no_mesh_no_force():
    assert transmitted_forces_n(train({"a": 20}, [], {"a": 1.0}), {"shaft_a": 1.0}) == {}


def test_play_adds_run_out_clearance_and_deflection():
    machine = train({"a": 20, "b": 30}, [("a", "b")], {"a": 20.0}, held=["b"])
    loose = {"a": 1e-5, "b": 2e-5, "a_1": 4e-5}
    found = mesh_play(machine, machine.meshes[0], 1e3, loose)
    # a loose ring leaves only the shaft's spring in series with its wall, the other stands on its support
    springs = STIFFNESS + 0.5 * STIFFNESS
    assert found.centre_m == pytest.approx(MARGIN * (3e-5 + 2e-5 + SUDDEN * 1e3 / springs))
    assert found.tilt_rad == pytest.approx(MARGIN * (4e-5 + SUDDEN * 1e3 / springs) / 0.26)


def test_a_gear_whose_shaft_is_not_followed_adds_its_run_out_only():
    machine = train({"a": 20, "b": 30}, [("a", "b")], {"a": 20.0}, follow_gear_shaft=False)
    loose = {"b": 2e-5, "b_1": 4e-5}
    alone = mesh_play(machine, machine.meshes[0], 0.0, loose)
    assert alone.centre_m == pytest.approx(MARGIN * 2e-5)
