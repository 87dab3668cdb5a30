"""Wrong requests for reconciliations: every field is told at once, misspelt keys with the close spelling."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from pydantic import ValidationError

from jobs.reconciliations.machine import MOST_UNKNOWN, read_form, read_known
from jobs.reconciliations.request import ReconciliationRequest
from jobs.validation import problems_of
from sim.assembly.assemble import assemble
from sim.core.errors import Problem, SpecError
from sim.presets import preset

BEARING = {"name": "b", "shaft": "s", "catalogue": "6205"}


def refused(form: dict[str, Any]) -> dict[str, Problem]:
    with pytest.raises(SpecError) as caught:
        read_form(form)
    return {p.field: p for p in caught.value.problems}


def test_a_misspelt_key_hides_neither_what_is_under_it_nor_the_rules_between_parts() -> None:
    drawing = {
        "shafts": [{"name": "s"}],
        "berings": [{**BEARING, "shaft": "z"}],
        "gears": [{"name": "g", "shaft": "q", "teeth": 20}],
    }
    told = refused({"kinematics": drawing})
    slip = told["machine.kinematics.berings"]
    assert "did you mean bearings?" in slip.message and "bearings" in slip.allowed and slip.given == "a list of 1"
    assert told["machine.kinematics.berings.0.shaft"].given == "z", "told under the key as it was written"
    assert told["machine.kinematics.gears.0.shaft"].given == "q"
    assert drawing["berings"][0]["shaft"] == "z" and "bearings" not in drawing, "the request is left as it is"


def test_kinematics_without_their_key_are_told_so_and_not_as_a_model_with_much_missing() -> None:
    (told,) = refused({"name": "pump", "shafts": [{"name": "s"}], "bearings": [BEARING]}).values()
    assert told.field == "machine" and "without their key" in told.message and "kinematics" in str(told.allowed)


def test_a_wrong_value_beside_a_misspelt_key_is_told() -> None:
    told = refused({"kinematics": {"shafts": [{"name": "s", "speed_hz": -1}], "berings": [BEARING]}})
    assert set(told) == {"machine.kinematics.berings", "machine.kinematics.shafts.0.speed_hz"}
    speed = told["machine.kinematics.shafts.0.speed_hz"]
    assert (speed.message, speed.given, speed.allowed, speed.unit) == ("is too small", -1, "> 0", "Hz")


def test_a_specification_is_read_behind_its_slips_too() -> None:
    told = refused({"name": "x", "berings": [{"name": "b"}], "bodies": [{"name": "m", "mass": 1.0}]})
    assert "did you mean bearings?" in told["machine.berings"].message
    assert any(field.startswith("machine.berings.0.") for field in told)
    assert "did you mean mass_kg?" in told["machine.bodies.0.mass"].message


def test_a_key_beside_kinematics_and_a_section_are_named_with_what_else_is_wrong() -> None:
    told = refused({"kinematics": {"shafts": []}, "nam": "x"})
    assert told["machine.nam"].allowed == "kinematics" and told["machine.kinematics.shafts"].allowed
    told = refused({"parameters": {"speed": 1}, "berings": []})
    assert "did you mean bearings?" in told["machine.berings"].message and "machine.parameters.speed" in told


def test_the_machine_is_told_together_with_the_other_fields() -> None:
    body = {"machine": {"kinematics": {"shafts": "s"}}, "recordings": ["r"], "budget": "huge", "sed": 1}
    with pytest.raises(ValidationError) as caught:
        ReconciliationRequest.model_validate(body)
    told = {p.field: p for p in problems_of(caught.value, model=ReconciliationRequest)}
    assert set(told) == {"machine.kinematics.shafts", "budget", "sed"}
    assert all(p.allowed and "input should" not in p.message for p in told.values())
    assert "did you mean seed?" in told["sed"].message


@pytest.mark.parametrize(
    ("changes", "field", "allowed"),
    [
        ({"recordings": "x"}, "recordings", "a list"),
        ({"baselines": {}}, "baselines", "a list"),
        ({"baselines": ["x y"]}, "baselines.0", "letters, digits, _ and -"),
        ({"seed": 1.5}, "seed", "a whole number >= 0"),
        ({"machine": 3}, "machine", "Name of a preset"),
        ({"machine": None}, "machine", "Name of a preset"),
        ({"recordings": []}, "recordings", "min length 1"),
    ],
)
def test_what_is_allowed_is_always_said(changes: dict[str, Any], field: str, allowed: str) -> None:
    body = {"machine": "paper", "recordings": ["r"], **changes}
    with pytest.raises(ValidationError) as caught:
        ReconciliationRequest.model_validate({key: value for key, value in body.items() if value is not None})
    (told,) = problems_of(caught.value, model=ReconciliationRequest)
    assert told.field == field and allowed in told.allowed and "nput should" not in told.message


def test_a_body_full_of_unknown_keys_is_told_in_bounds() -> None:
    form = {"kinematics": {"shafts": [{"name": "s"}]}, **{f"k{k}": 1 for k in range(12_000)}}
    document: dict[str, Any] = {"machine": form, "recordings": ["a"], "sed": 1}
    with pytest.raises(ValidationError) as told:
        ReconciliationRequest.model_validate(document)
    assert [p.field for p in problems_of(told.value)] == ["sed"], "and the machine is not read beside it"
    with pytest.raises(SpecError) as alone:
        read_form(document["machine"])
    assert len(alone.value.problems) <= 2 * MOST_UNKNOWN + 2, "it is read twice at most"
    assert any("further keys" in p.message for p in alone.value.problems)


def test_a_bearing_that_the_catalogue_has_not_is_told_by_its_field() -> None:
    form = preset("paper").model_dump(mode="json")
    form["bearings"][0] |= {"catalogue": "9999", "geometry": None}
    with pytest.raises(SpecError) as caught:
        read_known(form, SimpleNamespace(report=assemble))  # type: ignore[arg-type]
    (told,) = caught.value.problems
    assert (told.field, told.given) == ("machine.bearings.bearing1.catalogue", "9999")
    assert "a `geometry`" in str(told.allowed)


@pytest.mark.parametrize(
    ("machine", "told"), [("papper", True), ("paper", False), ({"kinematics": {"shafts": [{"name": "s"}]}}, False)]
)
def test_a_wrong_preset_is_told_with_a_misspelt_key(machine: object, told: bool) -> None:
    with pytest.raises(ValidationError) as caught:
        ReconciliationRequest.model_validate({"machine": machine, "recording": ["r"]})
    found = {p.field: p for p in problems_of(caught.value, model=ReconciliationRequest)}
    assert {"recording", "recordings"} <= set(found) and ("machine" in found) is told
    if told:
        assert "did you mean paper" in found["machine"].message


def test_a_name_that_can_be_no_preset_is_told_once() -> None:
    with pytest.raises(ValidationError) as caught:
        ReconciliationRequest.model_validate({"machine": "x" * 81, "recording": ["r"]})
    assert [p.field for p in problems_of(caught.value, model=ReconciliationRequest)].count("machine") == 1
