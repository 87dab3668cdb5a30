"""Machines that cannot be: every refusal names the field."""

from __future__ import annotations

import pytest

from sim.assembly.assemble import assemble
from sim.core.errors import SpecError
from sim.core.spec import BodySpec, ForceLoad, MachineSpec, ShaftSpec, TermSpec, TorqueLoad
from sim.presets import preset
from tests.strategies.systems import with_terms

PAPER = preset("paper")


def changed(part, **update):
    """The paper's machine with the first item of a part changed."""
    items = list(getattr(PAPER, part))
    items[0] = items[0].model_copy(update=update)
    return PAPER.model_copy(update={part: items})


def fields(machine):
    with pytest.raises(SpecError) as caught:
        assemble(machine)
    return [p.field for p in caught.value.problems]


@pytest.mark.parametrize(
    ("machine", "field"),
    [
        (changed("gears", shaft="nowhere"), "gears.pinion.shaft"),
        (changed("meshes", pinion="nothing"), "meshes.mesh1.pinion"),
        (changed("meshes", gear="nothing"), "meshes.mesh1.gear"),
        (changed("meshes", gear="pinion"), "meshes.mesh1"),
        (changed("bearings", body="nobody"), "bearings.bearing1.body"),
        (changed("resonators", bearing="bearing9"), "resonators.resonator1.bearing"),
        (changed("loads", shaft="nowhere"), "loads.0.shaft"),
        (PAPER.model_copy(update={"loads": [ForceLoad(body="nobody", axis="x")]}), "loads.0.body"),
        (PAPER.model_copy(update={"operating": None}), "operating"),
        (changed("bearings", name="bearing2"), "bearing2"),
        (changed("bearings", catalogue="9999", geometry=None), "bearings.bearing1.catalogue"),
        (MachineSpec(name="empty"), "gears"),
    ],
)
def test_dangling_names(machine, field):
    assert field in fields(machine)


def test_every_wrong_field_is_listed_at_once():
    bearings = changed("bearings", catalogue="9999", geometry=None).bearings
    machine = changed("gears", shaft="nowhere").model_copy(update={"operating": None, "bearings": bearings})
    assert {"gears.pinion.shaft", "operating", "bearings.bearing1.catalogue"} <= set(fields(machine))


def test_a_shaft_no_mesh_reaches_has_no_speed():
    assert "shafts.spare" in fields(PAPER.model_copy(update={"shafts": [*PAPER.shafts, ShaftSpec(name="spare")]}))


def test_a_free_body_is_refused():
    machine = MachineSpec(name="free", bodies=[BodySpec(name="mass", mass_kg=1.0, axes="xy", stiffness_x_n_per_m=1e5)])
    assert fields(machine) == ["bodies.mass.stiffness_y_n_per_m"]


def test_a_torque_on_something_that_cannot_turn():
    rotor = preset("rotor")
    assert "shafts.input" in fields(rotor.model_copy(update={"loads": [TorqueLoad(shaft="input", torque_nm=1.0)]}))


def test_a_force_along_a_fixed_axis():
    machine = preset("oscillator").model_copy(update={"loads": [ForceLoad(body="mass", axis="x", constant_n=1.0)]})
    assert fields(machine) == ["loads.0"]


@pytest.mark.parametrize(
    ("terms", "field"),
    [
        ([TermSpec(term="gremlin", site="bearing1")], "terms.0.term"),
        ([TermSpec(term="unbalance", site="bearing1")], "terms.0.site"),
        ([TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 20.0})], "terms.0.parameters.gap"),
        ([TermSpec(term="fit_clearance", site="bearing1", parameters={"width": 1.0})], "terms.0.parameters.width"),
        ([TermSpec(term="unbalance", site="gear")] * 2, "terms"),
        ([TermSpec(term=t, site="bearing1") for t in ("fit_clearance", "fit_clearance_series")], "terms"),
    ],
)
def test_terms_that_cannot_act(terms, field):
    assert field in fields(with_terms(PAPER, *terms))


def test_a_length_in_millimetres_gets_a_hint():
    with pytest.raises(SpecError, match="if meant in um"):
        assemble(with_terms(PAPER, TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 20.0})))
