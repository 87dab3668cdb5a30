"""Machines drawn from what is uncertain stay machines: balanced, bounded, with one modulus."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.calibrate.uncertain import (
    DRIFT,
    OWN_SPREAD,
    SPREAD,
    Offsets,
    draw_offsets,
    moved,
    uncertain_numbers,
)
from sim.core.spec import MeshTable, TorqueLoad
from sim.presets import preset

MACHINE = preset("paper-lightly-damped")
NUMBERS = uncertain_numbers(MACHINE)


def test_stiffness_damping_mass_clearance_and_torque_are_uncertain_geometry_is_not() -> None:
    names = {str(n.path[-1]) for n in NUMBERS}
    assert {"contact_stiffness_n_per_m15", "radial_clearance_m", "torque_nm", "inner_mass_kg"} <= names
    assert not names & {"teeth", "diameter_ratio", "balls", "speed_hz", "pressure_angle_deg"}
    document = MACHINE.model_dump(mode="json")
    for number in NUMBERS:
        node = document
        for key in number.path:
            node = node[key]  # type: ignore[index]
        assert isinstance(node, float) and node != 0.0, number.label


@settings(max_examples=30)
@given(seed=st.integers(0, 10**9))
def test_spread_is_bounded_and_parts_of_a_kind_move_together(seed: int) -> None:
    offsets = draw_offsets(NUMBERS, np.random.default_rng(seed))
    assert np.abs(offsets.values).max() <= SPREAD + OWN_SPREAD
    kinds: dict[str, list[float]] = {}
    for number, value in zip(NUMBERS, offsets.values, strict=True):
        kinds.setdefault(number.kind, []).append(value)
    assert all(np.ptp(values) <= 2 * OWN_SPREAD for values in kinds.values())
    drifted = offsets.mixed(draw_offsets(NUMBERS, np.random.default_rng(seed + 1)), DRIFT)
    assert np.abs(drifted.values - offsets.values).max() <= DRIFT * (SPREAD + OWN_SPREAD)


@settings(max_examples=10)
@given(seed=st.integers(0, 10**9))
def test_balanced_torques_stay_balanced(seed: int) -> None:
    loads = [TorqueLoad(shaft="input", torque_nm=23.0), TorqueLoad(shaft="output", torque_nm=-81.0)]
    machine = MACHINE.model_copy(update={"loads": loads})
    numbers = uncertain_numbers(machine)
    found = moved(machine, numbers, draw_offsets(numbers, np.random.default_rng(seed)))
    torques = [load.torque_nm for load in found.loads if isinstance(load, TorqueLoad)]
    assert torques[1] / torques[0] == pytest.approx(-81.0 / 23.0)
    assert torques[0] != 23.0


def test_no_offset_is_the_same_machine_and_offsets_are_relative() -> None:
    assert moved(MACHINE, NUMBERS, Offsets(values=np.zeros(len(NUMBERS)))) == MACHINE
    one = np.zeros(len(NUMBERS))
    place = next(i for i, n in enumerate(NUMBERS) if n.label == "bearings.0.inner_mass_kg")
    one[place] = 0.1
    changed = moved(MACHINE, NUMBERS, Offsets(values=one))
    assert changed.bearings[0].inner_mass_kg == pytest.approx(1.1 * 0.4)
    assert changed.bearings[1:] == MACHINE.bearings[1:]


def test_a_given_mesh_table_follows_the_modulus() -> None:
    stiffness = [[3e8, 5e8, 4e8, 3e8]]
    table = MeshTable(centre_distance_error_m=[0.0], stiffness_n_per_m=stiffness)
    mesh = MACHINE.meshes[0].model_copy(update={"table": table, "tooth_pairs": False})
    machine = MACHINE.model_copy(update={"meshes": [mesh]})
    numbers = uncertain_numbers(machine)
    assert not any("table" in n.path for n in numbers)
    offsets = np.where([n.kind == "youngs_modulus_pa" for n in numbers], 0.07, 0.0)
    assert offsets.any()
    found = moved(machine, numbers, Offsets(values=offsets)).meshes[0].table
    assert found is not None
    np.testing.assert_allclose(found.stiffness_n_per_m, 1.07 * np.array(stiffness))
