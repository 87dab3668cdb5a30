"""Places, directions and mixes; what a machine does not have is refused by name."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from signals.sensors import SensorChain, outputs_needed, pickups, quantities_of
from signals.sensors.place import Place, pickup_at
from sim.assembly.flexible import torsion_chain
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec
from tests.signals.sensors.motions import machine

NAMES = [
    f"{dof}.{quantity}"
    for dof in ("bearing1.outer.x", "bearing1.outer.y", "resonator1.y", "disc.x", "disc.y", "disc.theta", "input.theta")
    for quantity in ("displacement", "velocity", "acceleration")
]
KNOWN = quantities_of(NAMES)


def test_quantities_by_name() -> None:
    assert KNOWN["disc.y.velocity"] == "velocity" and KNOWN["disc.theta.velocity"] == "angular_velocity"
    assert quantities_of(["mesh1.force"]) == {"mesh1.force": "force"}


@given(angle=st.floats(-360, 360))
def test_direction_cosines(angle: float) -> None:
    found = pickup_at(Place(location="bearing1.outer", direction_deg=angle), "acceleration", KNOWN, "place")
    along = {axis: found.factors.get(f"bearing1.outer.{axis}.acceleration", 0.0) for axis in "xy"}
    assert along["x"] == pytest.approx(math.cos(math.radians(angle)), abs=1e-12)
    assert along["y"] == pytest.approx(math.sin(math.radians(angle)), abs=1e-12)


def test_along_an_axis_only_that_axis_is_needed() -> None:
    found = pickup_at(Place(location="resonator1"), "velocity", KNOWN, "place")
    assert found.factors == {"resonator1.y.velocity": 1.0} and found.axis == "y"
    oblique = pickup_at(Place(location="disc", direction_deg=30.0), "velocity", KNOWN, "place")
    assert oblique.axis == "" and len(oblique.factors) == 2


def test_relative_motion_and_a_mix() -> None:
    place = Place(location="disc", relative_to="bearing1.outer", direction_deg=0.0)
    found = pickup_at(place, "displacement", KNOWN, "place")
    assert found.factors == {"disc.x.displacement": 1.0, "bearing1.outer.x.displacement": -1.0}
    twice = {"channel": "disc.y.acceleration", "factor": 0.25}
    mixed = pickup_at(Place.model_validate({"mix": [twice, twice]}), "acceleration", KNOWN, "place")
    assert mixed.factors == {"disc.y.acceleration": 0.5}


@pytest.mark.parametrize(
    ("place", "field", "allowed"),
    [
        ({"location": "bearing9.outer"}, "place.location", "bearing1.outer, resonator1, disc"),
        ({"location": "disc", "relative_to": "housing"}, "place.relative_to", "bearing1.outer, resonator1, disc"),
        ({"location": "resonator1", "direction_deg": 45.0}, "place.direction_deg", "90 or -90"),
        ({"mix": [{"channel": "disc.z.acceleration"}]}, "place.mix.0.channel", "disc.x.acceleration"),
        ({"mix": [{"channel": "disc.x.velocity"}]}, "place.mix.0.channel", "outputs of acceleration"),
    ],
)
def test_what_the_machine_has_not_is_refused_with_what_it_has(place: dict, field: str, allowed: str) -> None:
    with pytest.raises(SpecError) as caught:
        pickup_at(Place.model_validate(place), "acceleration", KNOWN, "place")
    problem = caught.value.problems[0]
    assert problem.field == field and problem.given and allowed in problem.allowed


@pytest.mark.parametrize(
    "data",
    [
        {},
        {"location": "disc", "mix": [{"channel": "a"}]},
        {"mix": [{"channel": "a"}], "direction_deg": 0.0},
        {"mix": []},
        {"location": "DISC"},
    ],
)
def test_a_place_has_one_form(data: dict) -> None:
    with pytest.raises(ValidationError):
        Place.model_validate(data)


def chain(*channels: dict) -> SensorChain:
    return SensorChain.model_validate({"channels": list(channels)})


def test_a_torque_is_that_of_the_shafts_spring_and_damper() -> None:
    (found,) = pickups(chain({"kind": "torque", "name": "t", "shaft": "input"}), machine(), KNOWN)
    assert found.factors == {
        "input.theta.displacement": 1000.0,
        "disc.theta.displacement": -1000.0,
        "input.theta.velocity": 0.5,
        "disc.theta.velocity": -0.5,
    }


def test_every_channel_that_cannot_be_is_told_at_once() -> None:
    asked = chain(
        {"kind": "torque", "name": "t", "shaft": "output"},
        {"kind": "tacho", "name": "k", "shaft": "motor"},
        {"kind": "tacho", "name": "l", "shaft": "input", "pulser": {"body": "gear"}},
        {"kind": "proximity", "name": "p", "place": {"location": "disc"}, "probe": {"shaft": "x", "gap_m": 1e-3}},
        {"kind": "velocity", "name": "v", "place": {"location": "nowhere"}},
    )
    with pytest.raises(SpecError) as caught:
        pickups(asked, machine(), KNOWN)
    assert [p.field for p in caught.value.problems] == [
        "sensors.channels.0.shaft",
        "sensors.channels.1.shaft",
        "sensors.channels.2.pulser.body",
        "sensors.channels.3.probe.shaft",
        "sensors.channels.4.place.location",
    ]
    assert all(p.given and p.allowed for p in caught.value.problems)


def test_a_shaft_without_an_end_carries_no_torque_to_read() -> None:
    plain = machine().model_dump(mode="json")
    plain["shafts"][0]["end_inertia_kg_m2"] = None
    with pytest.raises(SpecError, match="no elastic stretch"):
        pickups(chain({"kind": "torque", "name": "t", "shaft": "input"}), MachineSpec.model_validate(plain), KNOWN)


def test_outputs_needed_once_each() -> None:
    asked = chain(
        {"kind": "accelerometer", "name": "a", "place": {"location": "disc"}},
        {"kind": "accelerometer", "name": "b", "place": {"location": "disc", "direction_deg": 45.0}},
        {"kind": "tacho", "name": "k", "shaft": "input", "pulser": {"body": "disc"}},
    )
    found = outputs_needed(pickups(asked, machine(), KNOWN))
    assert found == ["disc.y.acceleration", "disc.x.acceleration", "disc.theta.displacement"]


def test_the_torque_of_a_shaft_of_segments_is_that_of_the_stretch_at_its_end() -> None:
    flexible = machine().model_dump(mode="json")
    flexible["shafts"][0] |= {
        "torsional_stiffness_nm_per_rad": None,
        "torsional_damping_nms_per_rad": 0.0,
        "segments": [{"length_m": 0.3, "diameter_m": 0.02}],
    }
    flexible["shafts"][0]["seats"] = {"disc": 0.1}
    spec = MachineSpec.model_validate(flexible)
    (found,) = pickups(chain({"kind": "torque", "name": "t", "shaft": "input"}), spec, KNOWN)
    shaft = spec.shafts[0]
    ((_, _, stiffness),) = torsion_chain(shaft, ["input.theta", "disc.theta"])
    assert found.factors == {"input.theta.displacement": stiffness, "disc.theta.displacement": -stiffness}
