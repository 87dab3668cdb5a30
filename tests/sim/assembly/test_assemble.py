"""Matrices, loads and element weights of assembled machines, and assemblies that must be equivalent."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.spec import BodySpec, ForceLoad
from sim.presets import names, preset
from sim.solve.api import simulate
from sim.solve.plain import coordinate_rows
from sim.solve.settings import Settings
from tests.strategies.systems import every_term_machine

MACHINES = {name: preset(name) for name in names()} | {"every term": every_term_machine()}
EXACT = Settings(anti_alias=False, estimate_error=False, steps_per_output=2, rtol=1e-9)


def gyroscopic(system):
    """The skew part of the damping matrix: entries between the two slopes of a node, nothing else."""
    skew = 0.5 * (system.damping - system.damping.T)
    for i, j in np.argwhere(skew):
        one, other = system.dofs[i], system.dofs[j]
        assert {one.rpartition(".")[2], other.rpartition(".")[2]} == {"slope_x", "slope_y"}
        assert one.rpartition(".")[0] == other.rpartition(".")[0]
    return skew


@pytest.mark.parametrize("name", MACHINES)
def test_matrices_are_symmetric_and_passive(name):
    system = assemble(MACHINES[name])
    for matrix in (system.stiffness, system.damping - gyroscopic(system)):
        assert np.array_equal(matrix, matrix.T)
        if matrix.size and matrix.any():
            assert np.linalg.eigvalsh(matrix)[0] >= -1e-9 * np.abs(matrix).max()
    assert np.all(system.mass > 0)


@pytest.mark.slow
@pytest.mark.parametrize("name", MACHINES)
def test_dampers_add_up_to_the_damping_matrix(name):
    system = assemble(MACHINES[name])
    total = np.zeros_like(system.damping)
    for damper in system.dampers:
        row = np.zeros(len(system.dofs))
        for i, weight in damper.weights:
            row[i] += weight
        total += damper.damping * np.outer(row, row)
    assert total + gyroscopic(system) == pytest.approx(system.damping, rel=1e-12)


def translation(system, element, axis):
    """Force of a unit element force on the whole machine along an axis, one entry a force coordinate."""
    chosen = [dof.endswith(f".{axis}") for dof in system.dofs]
    return coordinate_rows(system, element)[: element.forces][:, chosen].sum(axis=1)


@pytest.mark.parametrize("name", MACHINES)
def test_internal_forces_sum_to_zero(name):
    system = assemble(MACHINES[name])
    # turning forces and loads; what holds a ring, or is met by it, on the ground; a coupling to what stands outside
    external = ("unbalance", "load", "bearing1.wall", "rub", "custom.stop", "offset")
    external += ("bearing2.hardening", "friction.y", "cubic", "looseness", "film")
    for element in system.elements:
        grounded = any(word in element.name for word in external)
        for axis in ("x", "y"):
            if not grounded:
                assert translation(system, element, axis) == pytest.approx(0.0, abs=1e-15), element.name


def test_the_mesh_turns_both_gears_at_their_base_radii():
    system = assemble(preset("paper"))
    row = coordinate_rows(system, next(e for e in system.elements if e.name == "mesh1"))[0]
    for gear, teeth, sign in (("pinion", 23, 1.0), ("gear", 81, -1.0)):
        radius = 0.001 * teeth * np.cos(np.radians(20.0))
        assert row[system.index(f"{gear}.theta")] == pytest.approx(sign * radius, rel=1e-12)


def test_torques_balance_through_the_mesh():
    system = assemble(preset("paper"))
    assert system.load[system.index("input.theta")] == 25.0
    assert system.load[system.index("output.theta")] == pytest.approx(-25.0 * 81 / 23, rel=1e-12)


def test_gravity_pulls_along_minus_y():
    system = assemble(preset("rotor"))
    for i, dof in enumerate(system.dofs):
        assert system.load[i] == pytest.approx(-9.80665 * system.mass[i] if dof.endswith(".y") else 0.0, rel=1e-12)


def test_the_oscillator_has_its_textbook_frequency():
    assert natural_frequencies_hz(assemble(preset("oscillator"))) == pytest.approx(
        np.sqrt(1e5) / (2 * np.pi), rel=1e-12
    )


def test_rigid_rotation_is_a_mode_of_zero_frequency():
    assert natural_frequencies_hz(assemble(preset("paper")))[0] == 0.0


def run(machine, *channels):
    response = simulate(machine, duration_s=0.02, output_rate_hz=30_000.0, channels=channels, settings=EXACT)
    return response.signals


def test_the_order_of_the_parts_does_not_matter():
    machine = preset("paper-lightly-damped")
    turned = machine.model_copy(
        update={
            "shafts": machine.shafts,
            "gears": machine.gears[::-1],
            "bearings": machine.bearings[::-1],
            "resonators": machine.resonators[::-1],
        }
    )
    channels = tuple(f"resonator{i}.y.acceleration" for i in range(1, 5))
    first, second = run(machine, *channels), run(turned, *channels)
    assert second == pytest.approx(first, abs=1e-7 * np.max(np.abs(first)))


def test_two_equal_bearings_are_one_of_doubled_parameters():
    pair = preset("rotor")
    one = pair.bearings[0]
    pair = pair.model_copy(
        update={"bearings": [b.model_copy(update={"contact_stiffness_n_per_m15": 8e9}) for b in pair.bearings]}
    )
    support = {name: 2.0 * value for name, value in one.support.model_dump().items()}
    doubled = one.model_copy(
        update={
            "contact_stiffness_n_per_m15": 16e9,
            "inner_mass_kg": 2.0 * one.inner_mass_kg,
            "outer_mass_kg": 2.0 * one.outer_mass_kg,
            "shaft_stiffness_n_per_m": 2.0 * one.shaft_stiffness_n_per_m,
            "shaft_damping_ns_per_m": 2.0 * one.shaft_damping_ns_per_m,
            "support": one.support.model_copy(update=support),
        }
    )
    channels = ("disc.x.displacement", "disc.y.displacement", "bearing1.outer.y.acceleration")
    first = run(pair, *channels)
    second = run(pair.model_copy(update={"bearings": [doubled]}), *channels)
    for a, b in zip(first, second, strict=True):
        assert b == pytest.approx(a, abs=1e-7 * np.max(np.abs(a)))


def test_a_mirrored_load_gives_the_mirrored_motion():
    body = BodySpec(name="mass", mass_kg=1.0, stiffness_x_n_per_m=1e6, stiffness_y_n_per_m=2e6, damping_x_ns_per_m=50.0)
    base = preset("oscillator")
    motions = []
    for sign in (1.0, -1.0):
        loads = [ForceLoad(body="mass", axis=a, constant_n=sign * 3.0) for a in ("x", "y")]
        machine = base.model_copy(update={"bodies": [body], "loads": loads})
        motions.append(run(machine, "mass.x.displacement", "mass.y.velocity"))
    assert np.array_equal(motions[0], -motions[1])
