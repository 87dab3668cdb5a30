"""Findings of validation as problems: their place is the one that was written."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from jobs.request import SimulationRequest
from signals.ingest.description import read_description
from signals.sensors.path import MeasuredPath, ModalPath
from signals.sensors.spec import Accelerometer, ProximityProbe, Tacho, TorqueSensor, VelocitySensor
from signals.validation import KINDS, Findings, problems_of
from sim.core.errors import Problem, SpecError
from sim.core.spec import FluctuatingSpeed, ForceLoad, MeasuredSpeed, RampSpeed, TorqueLoad

PLACE = {"location": "bearing1.outer", "direction_deg": 0}


def fields(**body: object) -> list[str]:
    with pytest.raises(ValidationError) as caught:
        SimulationRequest.model_validate({"preset": "paper", **body})
    return [problem.field for problem in problems_of(caught.value)]


def test_a_part_of_several_kinds_is_named_without_its_kind() -> None:
    channel = {"kind": "accelerometer", "name": "a", "place": PLACE, "colour": "red"}
    assert fields(sensors={"channels": [channel]}) == ["sensors.channels.0.colour"]
    path = {"kind": "modes", "modes": [{"frequency_hz": -1, "damping_ratio": 0.1, "gain": 1.0}]}
    channel = {"kind": "accelerometer", "name": "a", "place": PLACE, "path": path}
    assert fields(sensors={"channels": [channel]}) == ["sensors.channels.0.path.modes.0.frequency_hz"]
    assert fields(sensors={"channels": [{"name": "a"}]}) == ["sensors.channels.0.kind"]
    load = {"kind": "torque", "shaft": "input", "torque_nm": "much"}
    machine = {"name": "m", "loads": [load]}
    assert fields(preset=None, machine=machine) == ["machine.loads.0.torque_nm"]
    law = {
        "name": "l",
        "dof": "a.x",
        "table": {"displacement": [0, 1], "displacements": 2, "velocity": "x", "force": [0, 1]},
    }
    assert fields(preset=None, machine={"name": "m", "custom_laws": [law]}) == ["machine.custom_laws.0.table.velocity"]


def test_every_kind_is_known() -> None:
    models = (RampSpeed, FluctuatingSpeed, MeasuredSpeed, TorqueLoad, ForceLoad, ModalPath, MeasuredPath)
    models += (Accelerometer, VelocitySensor, ProximityProbe, TorqueSensor, Tacho)
    assert {model.model_fields["kind"].default for model in models} == set(KINDS)


def test_steps_are_told_together_and_nothing_twice() -> None:
    findings = Findings()
    findings.settle()
    one, other = (Problem(field=name, message="is wrong") for name in ("a", "b"))
    for problems in ([one], [one, other]):
        with findings.step():
            raise SpecError(problems)
    with pytest.raises(SpecError) as caught:
        findings.settle()
    assert caught.value.problems == (one, other)


@pytest.mark.parametrize(("value", "told"), [(0, "is too small"), ("x", "is not a number")])
def test_an_object_or_a_number_is_told_once_and_without_names_of_the_program(value: object, told: str) -> None:
    channel = {"name": "a", "unit": "V", "sensitivity": {"value": value, "unit": "mV/g"}}
    with pytest.raises(SpecError) as caught:
        read_description({"channels": [channel]})
    (problem,) = caught.value.problems
    assert problem.field == "channels.0.sensitivity.value" and told in problem.message
