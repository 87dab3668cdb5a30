from __future__ import annotations

import pytest
from pydantic import ValidationError

from sideband_datasets import read_recipe
from sideband_datasets.recipe.read import document_of, identity
from sim.core.errors import SpecError
from tests.sideband_datasets.small import document, tiny


def test_a_recipe_written_out_is_the_same_recipe():
    recipe = tiny()
    assert read_recipe(document_of(recipe)) == recipe
    assert identity(read_recipe(document_of(recipe))) == identity(recipe)
    assert identity(tiny(seed=4)) != identity(recipe)


def test_a_recipe_is_frozen():
    with pytest.raises(ValidationError):
        tiny().count = 3


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"sedd": 1}, "sedd: is not a known field.*did you mean seed"),
        ({"count": 0}, "count"),
        ({"healthy_share": 1.5}, "healthy_share"),
        ({"speeds_hz": {"low": 40, "high": 20}}, "speeds_hz: `low` is above"),
        ({"speeds_hz": {"low": 0, "high": 20, "scale": "log"}}, "speeds_hz: a logarithmic range"),
        ({"speeds_hz": {"low": 1, "hihg": 20}}, "speeds_hz.hihg: is not a known field"),
        ({"splits": {"train": 0.5}}, "add up to 0.5"),
        ({"plan": "random"}, "plan"),
        ({"faults": []}, None),
        ({"faults": [{"name": "healthy", "terms": [{"term": "unbalance"}]}]}, "`healthy` is the class without a fault"),
        ({"schema_version": 2}, "schema_version"),
    ],
)
def test_wrong_fields_are_named(changes, told):
    if told is None:
        assert read_recipe(document(**changes)).classes == ("healthy",)
        return
    with pytest.raises(SpecError, match=told):
        read_recipe(document(**changes))


def test_no_object_and_no_json_are_told():
    for wrong in ([], {"count": float("nan")}):
        with pytest.raises(SpecError):
            read_recipe(wrong)


SPALL = {"term": "outer_spall", "parameters": {"width": [5e-4, 3e-3]}}


@pytest.mark.parametrize(
    ("changes", "field", "given"),
    [
        ({"speeds_hz": [10, 20]}, "speeds_hz", "[10, 20]"),
        ({"faults": [{"name": "a", "terms": [SPALL]}]}, "faults.0.terms.0.parameters.width", "[0.0005, 0.003]"),
        ({"conditions": {"gravity_m_per_s2": []}}, "conditions.gravity_m_per_s2", "[]"),
    ],
)
def test_a_list_is_told_once_with_what_it_may_have_meant(changes, field, given):
    with pytest.raises(SpecError) as told:
        read_recipe(document(**changes))
    (problem,) = told.value.problems
    assert (problem.field, problem.given) == (field, given)
    assert '{"low": 10, "high": 20}' in problem.allowed and '{"choices": [10, 20]}' in problem.allowed


PITTED = [{"name": "outer", "terms": [{"term": "outer_spall"}]}]
WIDTH = {"outer_spall@drive_end.width": 2e-3}


@pytest.mark.parametrize("part", ["set", "vary"])
@pytest.mark.parametrize("faults", [PITTED, [{"name": "loose", "terms": [{"term": "pedestal_looseness"}]}], []])
def test_no_recording_that_is_labelled_healthy_has_a_defect(part, faults):
    machine = document()["machines"][0]
    for changes, field in (
        ({"machines": [{**machine, part: WIDTH}]}, f"machines.0.{part}.outer_spall@drive_end.width"),
        ({"conditions": WIDTH}, "conditions.outer_spall@drive_end.width"),
        ({"conditions": {"shaft_crack@shaft.depth": 0.3}}, "conditions.shaft_crack@shaft.depth"),
    ):
        with pytest.raises(SpecError, match="healthy ones too") as told:
            read_recipe(document(faults=faults, **changes))
        assert told.value.problems[0].field == field
    assert read_recipe(document(faults=faults, conditions={"unbalance@disc.moment": 1e-4}))


@pytest.mark.parametrize("name", ["hold-out", "all", "../x"])
def test_splits_have_names_that_loaders_take(name):
    with pytest.raises(SpecError) as told:
        read_recipe(document(splits={name: 0.5, "train": 0.5}))
    assert told.value.problems[0].field.startswith("splits")


@pytest.mark.parametrize(("key", "field"), [("speed_hz", "speeds_hz"), ("torque_nm", "torques_nm")])
def test_speed_and_load_are_drawn_once(key, field):
    with pytest.raises(SpecError, match=f"drawn by `{field}` already") as told:
        read_recipe(document(**{field: {"low": 25, "high": 40}, "conditions": {key: 30.0}}))
    assert told.value.problems[0].field == f"conditions.{key}"


@pytest.mark.parametrize("value", [{"low": 40, "high": 20}, {"factor": [40, 20]}])
def test_two_numbers_in_the_wrong_order_are_shown(value):
    with pytest.raises(SpecError) as told:
        read_recipe(document(speeds_hz=value))
    (problem,) = told.value.problems
    assert (problem.field, problem.given) == ("speeds_hz", "40 and 20")


RIG = {"name": "rig", "preset": "bearing-rig", "instances": 2}


@pytest.mark.parametrize(
    ("changes", "field", "given"),
    [
        ({"splits": {"train": 0.7, "test": 0.2}}, "splits", "a sum of 0.9"),
        ({"machines": [RIG, RIG]}, "machines", "rig"),
        ({"machines": [{"name": "rig", "instances": 2}]}, "machines.0.preset", "neither"),
        ({"faults": [], "healthy_share": 0.5}, "healthy_share", "0.5"),
        ({"faults": [{"name": "a", "terms": [{"term": "outer_spall"}]}], "healthy_share": 1.0}, "healthy_share", "1"),
        ({"faults": [{"name": "healthy", "terms": [{"term": "outer_spall"}]}]}, "faults", "healthy"),
        ({"windows": {"length_s": 1.0, "length_revolutions": 10}}, "windows.length_s", "both"),
        ({"measurement": [{"name": "m", "machines": ["other"], "chain": {}}]}, "measurement", "other"),
    ],
)
def test_what_does_not_fit_together_names_its_field(changes, field, given):
    with pytest.raises(SpecError) as told:
        read_recipe(document(**changes))
    assert [(p.field, p.given) for p in told.value.problems] == [(field, given)]
    assert told.value.problems[0].allowed
