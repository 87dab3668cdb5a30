"""Known fields beside an unknown one."""

from __future__ import annotations

import pytest
from pydantic import ValidationError

from jobs.request import SimulationRequest
from signals.known_fields import fields_beside
from signals.validation import problems_of
from sim.core.spec import MachineSpec


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
