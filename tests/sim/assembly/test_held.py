"""Machines that float are refused with the motion nothing holds; machines that stand are accepted."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sim.assembly.assemble import assemble
from sim.assembly.held import free_motions
from sim.assembly.modes import natural_frequencies_hz
from sim.core.errors import SpecError
from sim.core.spec import BodySpec, MachineSpec, SupportSpec, TermSpec
from sim.presets import names, preset
from sim.presets.reference import machine_from_reference
from tests.strategies.systems import gear_pairs, rotors, with_terms

REFERENCE = Path(__file__).resolve().parents[3].parent / "shared" / "reference"
PAPER = preset("paper")
PAIR = preset("gear-pair")


def each(items, **update):
    return [item.model_copy(update=update) for item in items]


def support(x: float, y: float) -> SupportSpec:
    return SupportSpec(stiffness_x_n_per_m=x, stiffness_y_n_per_m=y)


def held(machine: MachineSpec, x: float, y: float, *bearings: str) -> MachineSpec:
    """The machine with the supports of these bearings (all by default) replaced."""
    chosen = bearings or tuple(b.name for b in machine.bearings)
    changed = [b.model_copy(update={"support": support(x, y)}) if b.name in chosen else b for b in machine.bearings]
    return machine.model_copy(update={"bearings": changed})


def refusals(machine: MachineSpec):
    with pytest.raises(SpecError, match="nothing holds") as caught:
        assemble(machine)
    return {p.field: p for p in caught.value.problems}


@pytest.mark.parametrize("name", names())
def test_every_preset_stands(name):
    assemble(preset(name))


@pytest.mark.parametrize("name", sorted(p.name for p in REFERENCE.glob("*.json")) or ["none"])
def test_every_reference_machine_stands(name):
    if name == "none":
        pytest.skip("no reference machines beside the project")
    assemble(machine_from_reference(json.loads((REFERENCE / name).read_text())))


def test_bearings_on_nothing_hold_nothing():
    found = refusals(held(PAPER, 0.0, 0.0))
    assert set(found) == {f"bearings.bearing{i}.support.stiffness_{a}_n_per_m" for i in (1, 3) for a in "xy"}
    x = found["bearings.bearing1.support.stiffness_x_n_per_m"]
    for dof in ("pinion.x", "bearing1.inner.x", "bearing1.outer.x", "bearing2.inner.x", "bearing2.outer.x"):
        assert dof in x.message
    assert "gear" not in x.message
    assert "bearings.bearing2.support.stiffness_x_n_per_m" in x.message
    assert (x.given, x.allowed, x.unit) == (0.0, "above 0", "N/m")
    assert "resonator3.y" in found["bearings.bearing3.support.stiffness_y_n_per_m"].message


@pytest.mark.parametrize(("x", "y", "axis"), [(0.0, 1e7, "x"), (1e7, 0.0, "y")])
def test_one_direction_is_not_enough(x, y, axis):
    found = refusals(held(PAPER, x, y, "bearing1", "bearing2"))
    assert list(found) == [f"bearings.bearing1.support.stiffness_{axis}_n_per_m"]


def test_one_held_bearing_of_two_is_enough():
    assemble(held(PAPER, 0.0, 0.0, "bearing1", "bearing3"))


def test_damping_holds_nothing():
    loose = SupportSpec(
        stiffness_x_n_per_m=0.0, stiffness_y_n_per_m=0.0, damping_x_ns_per_m=1e5, damping_y_ns_per_m=1e5
    )
    assert len(refusals(PAPER.model_copy(update={"bearings": each(PAPER.bearings, support=loose)}))) == 4


def test_a_mesh_alone_does_not_hold_two_gears():
    gears, meshes = each(PAIR.gears, translates=True), each(PAIR.meshes, line_of_action="rotated")
    found = refusals(PAIR.model_copy(update={"gears": gears, "meshes": meshes}))
    assert set(found) == {f"gears.{g}.stiffness_{a}_n_per_m" for g in ("pinion", "gear") for a in "xy"}
    assert "a bearing on gear" in found["gears.gear.stiffness_x_n_per_m"].message


def test_an_oscillator_without_a_spring():
    machine = preset("oscillator")
    bodies = each(machine.bodies, stiffness_y_n_per_m=0.0)
    assert list(refusals(machine.model_copy(update={"bodies": bodies}))) == ["bodies.mass.stiffness_y_n_per_m"]


def test_a_body_with_a_spring_along_one_axis_only():
    body = BodySpec(name="mass", mass_kg=1.0, axes="xy", stiffness_x_n_per_m=1e5)
    assert list(refusals(MachineSpec(name="half", bodies=[body]))) == ["bodies.mass.stiffness_y_n_per_m"]


def test_walls_hold_a_ring_that_its_support_released():
    assemble(with_terms(PAPER, *(TermSpec(term="fit_clearance", site=f"bearing{i}") for i in (1, 2, 3, 4))))


def test_a_housing_without_support_floats_with_its_ring():
    machine = held(PAPER, 0.0, 0.0, "bearing1", "bearing2")
    found = refusals(with_terms(machine, TermSpec(term="fit_clearance_series", site="bearing1")))
    assert "bearing1.housing.x" in found["bearings.bearing1.support.stiffness_x_n_per_m"].message


def test_a_disc_that_turns_may_turn_freely():
    rotor = preset("rotor")
    system = assemble(rotor.model_copy(update={"bodies": each(rotor.bodies, inertia_kg_m2=0.01)}))
    assert "disc.theta" in system.dofs


def test_free_motions_of_a_chain():
    rows = np.array([[1.0, -1.0, 0.0, 0.0], [0.0, 1e-3, -1e3, 0.0]])
    motions = free_motions(rows, np.ones(4, dtype=bool))
    with pytest.raises(ValueError, match="read-only"):
        motions[0] = 0.0  # other callers hold the same array
    assert motions.shape == (2, 4)
    assert rows @ motions.T == pytest.approx(0.0, abs=1e-9 * np.abs(motions).max())
    assert free_motions(np.vstack([rows, np.eye(4)[[0, 3]]]), np.ones(4, dtype=bool)).shape == (0, 4)


def powers(low: float, high: float) -> st.SearchStrategy[float]:
    return st.floats(low, high).map(lambda x: 10.0**x)


@st.composite
def gearboxes(draw: st.DrawFn) -> MachineSpec:
    """The paper's gearbox with springs, inertias and line of action anywhere within the specification's bounds."""
    stiff = powers(0.0, 13.0)
    bearings = [
        b.model_copy(update={"support": support(draw(stiff), draw(stiff)), "shaft_stiffness_n_per_m": draw(stiff)})
        for b in PAPER.bearings
    ]
    shafts = [
        s.model_copy(
            update={"end_inertia_kg_m2": draw(powers(-12, 4)), "torsional_stiffness_nm_per_rad": draw(powers(-3, 10))}
        )
        for s in PAPER.shafts
    ]
    gears = [g.model_copy(update={"inertia_kg_m2": draw(powers(-12, 5))}) for g in PAPER.gears]
    meshes = each(PAPER.meshes, line_of_action=draw(st.sampled_from(["y", "rotated"])))
    parts = {"bearings": bearings, "shafts": shafts, "gears": gears, "meshes": meshes}
    loose = draw(st.lists(st.sampled_from([b.name for b in bearings]), unique=True))
    term = draw(st.sampled_from(["fit_clearance", "fit_clearance_series"]))
    return with_terms(PAPER.model_copy(update=parts), *(TermSpec(term=term, site=name) for name in loose))


@pytest.mark.slow
@settings(max_examples=40)
@given(machine=st.one_of(gearboxes(), rotors(), gear_pairs()))
def test_every_machine_on_springs_is_accepted_and_only_its_rotation_is_free(machine):
    assemble(machine)


@settings(max_examples=15)
@given(machine=rotors())
def test_the_check_agrees_with_the_natural_frequencies(machine):
    assert np.all(natural_frequencies_hz(assemble(machine)) > 0.0)
    assert len(refusals(held(machine, 0.0, 1e7))) == 1


@pytest.mark.slow
@settings(max_examples=15)
@given(machine=gearboxes(), axis=st.sampled_from(["x", "y"]))
def test_a_gear_whose_supports_are_gone_along_an_axis_is_refused(machine, axis):
    machine = held(machine.model_copy(update={"terms": []}), *(1e6 * (axis != a) for a in "xy"), "bearing3", "bearing4")
    assert list(refusals(machine)) == [f"bearings.bearing3.support.stiffness_{axis}_n_per_m"]
