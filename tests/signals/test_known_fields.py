"""Known fields beside an unknown one."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from jobs.request import SimulationRequest
from signals.ingest.description import Description
from signals.known_fields import expected_at, fields_beside
from signals.validation import problems_of
from sim.core.spec import MachineSpec, SpecModel


def test_the_known_fields_are_those_of_the_part_that_was_meant():
    assert "duration_s" in fields_beside(SimulationRequest, ("durations",))
    assert fields_beside(MachineSpec, ("bearings", 0, "geometry", "ballz"))[:2] == ("balls", "ball_diameter_m")
    loads = fields_beside(MachineSpec, ("loads", 0, "torque", "torqe_nm"))
    assert {"torque_nm", "amplitude_n"} <= set(loads)


def test_an_unknown_field_is_told_with_the_likest_and_the_known_ones():
    with pytest.raises(ValidationError) as caught:
        SimulationRequest.model_validate({"preset": "paper", "durations": 2})
    (problem,) = problems_of(caught.value, model=SimulationRequest)
    assert problem.field == "durations" and "did you mean duration_s?" in problem.message
    assert "duration_s" in problem.allowed and "seed" in problem.allowed


@pytest.mark.parametrize(
    ("place", "said"),
    [
        (("operating", "speed_hz"), "a number >= 0, <= 100000"),
        (("operating",), "an object with shaft, speed_hz, torque_nm"),
        (("channels",), "a list, each an object with name, column, quantity, unit"),
        (("channels", 0, "unit"), "text (`g`, `m/s^2`, `mm/s`"),
        (("tacho", "pulses_per_revolution"), "a whole number >= 1, <= 100000"),
        (("condition",), "baseline, unknown"),
        (("channels", 0, "column"), "text or a whole number"),
    ],
)
def test_what_is_missing_is_told_with_what_it_takes(place: tuple[int | str, ...], said: str) -> None:
    assert expected_at(Description, place).startswith(said)


def test_places_that_no_model_knows_expect_nothing() -> None:
    assert expected_at(Description, ("colour",)) == expected_at(Description, ("channels", 0)) == ""


def test_a_missing_speed_beside_one_in_rpm_is_told_in_hz() -> None:
    document = {"channels": [{"name": "a", "unit": "g"}], "operating": {"shaft": "input", "speed_rpm": 1797}}
    with pytest.raises(ValidationError) as caught:
        Description.model_validate(document)
    (problem,) = problems_of(caught.value, model=Description)
    assert problem.field == "operating.speed_hz" and "1797 rpm are 29.95 Hz" in problem.message


class Shaft(SpecModel):
    name: str
    speed_hz: float | None = None


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("rpm", 1500, "is not a known field (speeds are in Hz: 1500 rpm are speed_hz 25)"),
        ("Speed_RPM", 1797.0, "is not a known field (speeds are in Hz: 1797 rpm are speed_hz 29.95)"),
        ("rpm", "fast", "is not a known field"),
        ("speed", 25.0, "is not a known field (did you mean speed_hz?)"),
    ],
)
def test_an_unknown_field_in_rpm_is_told_in_hz(key: str, value: object, said: str) -> None:
    with pytest.raises(ValidationError) as caught:
        Shaft.model_validate({"name": "input", key: value})
    (problem,) = problems_of(caught.value, model=Shaft)
    assert (problem.field, problem.message, problem.allowed) == (key, said, "name, speed_hz")
