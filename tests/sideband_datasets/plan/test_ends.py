from __future__ import annotations

import pytest

from sideband_datasets.plan.plan import planned
from sim.core.errors import SpecError
from tests.sideband_datasets.small import document, tiny

STIFF = "bearings.bearing1.support.stiffness_y_n_per_m"


def _drawn(**vary: object) -> dict[str, object]:
    (rotor,) = document()["machines"]
    return {"machines": [{**rotor, "vary": {**rotor["vary"], **vary}}]}


@pytest.mark.parametrize(
    ("changes", "field", "given"),
    [
        ({"speeds_hz": {"low": 20, "high": 1100}}, "speeds_hz.high", 1100.0),
        ({"speeds_hz": {"low": 0.05, "high": 40}}, "speeds_hz.low", 0.05),
        ({"speeds_hz": {"choices": [30, 2000]}}, "speeds_hz.choices.1", 2000.0),
        ({"conditions": {"gravity_m_per_s2": {"low": -3, "high": 9.81}}}, "conditions.gravity_m_per_s2.low", -3.0),
        (_drawn(**{STIFF: {"low": -1e4, "high": 1e8}}), f"machines.0.vary.{STIFF}.low", -1e4),
        (
            _drawn(**{"unbalance@disk.moment": {"low": 1e-5, "high": 1e-4}}),
            "machines.0.vary.unbalance@disk.moment.low",
            "disk",
        ),
        ({"conditions": {"unbalence@disc.x": 1.0}}, "conditions.unbalence@disc.x", "unbalence"),
        ({"conditions": {"unbalance@disc.x": 1.0}}, "conditions.unbalance@disc.x", "x"),
    ],
)
def test_a_wrong_end_is_told_as_written_whatever_is_drawn(changes, field, given):
    for seed in (1, 2):
        with pytest.raises(SpecError) as told:
            planned(tiny(seed=seed, **changes))
        problem = told.value.problems[0]
        assert (problem.field, problem.given) == (field, given)
        assert problem.allowed


def test_a_wrong_name_among_choices_is_told_with_those_that_are_known():
    machines = [{"name": "rig", "preset": "bearing-rig", "instances": 4, "vary": {
        "bearings.drive_end.catalogue": {"choices": ["6205", "9999"]}}}]  # fmt: skip
    with pytest.raises(SpecError) as told:
        planned(tiny(machines=machines, measurement=[]))
    (problem,) = told.value.problems
    assert problem.field == "machines.0.vary.bearings.drive_end.catalogue.choices.1"
    assert problem.given == "9999" and "6205" in str(problem.allowed)


def test_ends_that_machines_take_are_taken():
    assert planned(tiny(speeds_hz={"low": 0.5, "high": 1000}, windows={"per_recording": 1}, duration_s=1.0))


def test_an_unknown_ready_machine_is_told_by_its_field():
    (rotor,) = document()["machines"]
    with pytest.raises(SpecError, match="did you mean rotor") as told:
        planned(tiny(machines=[{**rotor, "preset": "roter"}]))
    assert told.value.problems[0].field == "machines.0.preset"
