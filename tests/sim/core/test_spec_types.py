"""A specification takes numbers as numbers: neither text nor truth values are converted."""

from __future__ import annotations

import types
import typing

import pytest
from pydantic import ValidationError

from sim.core import spec
from sim.core.spec import MachineSpec, SpecModel
from sim.presets import names, preset

MODELS = [m for m in vars(spec).values() if isinstance(m, type) and issubclass(m, SpecModel) and m is not SpecModel]


def flat(hint: object) -> set[object]:
    """Plain types an annotation allows."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        return set().union(*(flat(a) for a in typing.get_args(hint)))
    if typing.get_origin(hint) is typing.Annotated:
        return flat(typing.get_args(hint)[0])
    return {hint}


def fields(*kinds: type):
    found = []
    for model in MODELS:
        for name, field in model.model_fields.items():
            if flat(field.annotation) & set(kinds):
                found.append(pytest.param(model, name, id=f"{model.__name__}.{name}"))
    return found


def complaint(model: type[SpecModel], name: str, value: object) -> str:
    with pytest.raises(ValidationError) as caught:
        model.model_validate({name: value})
    return next((e["type"] for e in caught.value.errors() if e["loc"] == (name,)), "accepted")


@pytest.mark.parametrize("value", ["23", "0.5", "1e-3", True, False])
@pytest.mark.parametrize(("model", "name"), fields(int, float))
def test_text_and_truth_values_are_no_numbers(model, name, value):
    assert complaint(model, name, value) in {"float_type", "int_type"}


@pytest.mark.parametrize("value", ["true", "no", 1, 0, 1.0])
@pytest.mark.parametrize(("model", "name"), fields(bool))
def test_numbers_and_text_are_no_truth_values(model, name, value):
    assert complaint(model, name, {"broken": 1}) == "bool_type"
    assert complaint(model, name, value) == "bool_type"


def test_the_models_have_such_fields():
    assert len(fields(int, float)) > 60
    assert len(fields(bool)) >= 4


@pytest.mark.parametrize("value", ["20", True])
def test_parameters_and_tables_too(value):
    with pytest.raises(ValidationError, match="valid number"):
        spec.TermSpec(term="unbalance", site="gear", parameters={"moment": value})
    with pytest.raises(ValidationError, match="valid number"):
        spec.MeshTable(centre_distance_error_m=[0.0], stiffness_n_per_m=[[1e8, value]])


@pytest.mark.parametrize("name", names())
def test_whole_numbers_may_be_written_with_a_point(name):
    machine = preset(name)
    document = machine.model_dump(mode="json")
    for gear in document["gears"]:
        gear["teeth"] = float(gear["teeth"])
    for bearing in document["bearings"]:
        if bearing["geometry"]:
            bearing["geometry"]["balls"] = float(bearing["geometry"]["balls"])
    assert MachineSpec.model_validate(document) == machine


def test_half_a_tooth_is_refused():
    with pytest.raises(ValidationError, match="fractional part"):
        spec.GearSpec(name="pinion", shaft="input", teeth=23.5, module_m=0.002, face_width_m=0.02)
