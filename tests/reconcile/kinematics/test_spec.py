"""What is read, refused and derived of a specification that is kinematics only."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

from reconcile.kinematics import of_machine, read_kinematic_spec
from reconcile.kinematics.families import ties
from sim.core.errors import SpecError
from sim.parts.bearing import catalogue, missing
from sim.presets import preset


def spec(**parts):  # type: ignore[no-untyped-def]
    return {"kinematics": {"shafts": [{"name": "shaft"}], **parts}}


def bearing(**how):  # type: ignore[no-untyped-def]
    return {"name": "b1", "shaft": "shaft", **how}


def test_four_ways_to_say_a_bearing_agree() -> None:
    ways = [
        {"catalogue": "6205"},
        {"balls": 9, "ball_diameter_m": 0.00794004, "pitch_diameter_m": 0.0390398},
        {"balls": 9, "diameter_ratio": 0.00794004 / 0.0390398},
        {"orders": {"bpfo": 3.58483, "bpfi": 5.41517}},
    ]
    for way in ways:
        found = {f.kind: f.order for f in ties(read_kinematic_spec(spec(bearings=[bearing(**way)]))).families}
        # the orders the CWRU data center prints for this bearing
        assert found["outer"] == pytest.approx(3.5848, abs=1e-3)
        assert found["inner"] == pytest.approx(5.4152, abs=1e-3)
        assert found["ball"] == pytest.approx(4.7135, abs=2e-3)
        assert found["cage"] == pytest.approx(0.39828, abs=1e-4)


@pytest.mark.parametrize(
    ("document", "word"),
    [
        ({}, "kinematics"),
        ({"kinematics": {"shafts": []}}, "shafts"),
        (spec(bearings=[bearing()]), "exactly one"),
        (spec(bearings=[bearing(catalogue="6205", balls=9, diameter_ratio=0.2)]), "exactly one"),
        (spec(bearings=[bearing(balls=9)]), "diameter"),
        (spec(bearings=[bearing(balls=9, ball_diameter_m=0.04, pitch_diameter_m=0.039)]), "smaller"),
        (spec(bearings=[bearing(balls="9", diameter_ratio=0.2)]), "whole number"),
        (spec(bearings=[{**bearing(catalogue="6205"), "shaft": "other"}]), "no shaft"),
        (spec(bearings=[{**bearing(catalogue="6205"), "name": "shaft"}]), "twice"),
        (spec(meshes=[{"name": "m", "gears": ["x", "y"]}]), "no gear"),
        (spec(extra=1), "extra"),
    ],
)
def test_wrong_fields_are_named(document, word: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(SpecError) as caught:
        read_kinematic_spec(document)
    assert word in str(caught.value)


def test_shafts_are_tied_by_teeth_or_speeds() -> None:
    gears = [{"name": "p", "shaft": "shaft", "teeth": 20}, {"name": "g", "shaft": "out", "teeth": 50}]
    document = {
        "kinematics": {
            "shafts": [{"name": "shaft", "speed_hz": 30.0}, {"name": "out"}, {"name": "fan", "speed_hz": 45.0}],
            "gears": gears,
            "meshes": [{"name": "m", "gears": ["p", "g"]}],
        }
    }
    tie = ties(read_kinematic_spec(document))
    assert tie.shafts == {"shaft": 1.0, "out": pytest.approx(0.4), "fan": pytest.approx(1.5)}
    assert tie.mesh_orders == (20.0,)
    del document["kinematics"]["shafts"][2]["speed_hz"]
    with pytest.raises(SpecError, match="fan"):
        ties(read_kinematic_spec(document))


def test_an_unknown_designation_is_refused() -> None:
    with pytest.raises(Exception, match="6999"):
        ties(read_kinematic_spec(spec(bearings=[bearing(catalogue="6999")])))


def test_a_full_machine_is_read_as_kinematics() -> None:
    found = of_machine(preset("paper"))
    tie = ties(found, "input")
    assert {f.kind for f in tie.families} >= {"outer", "inner", "ball", "cage", "turn"}
    assert len(tie.meshes) == 1


@pytest.mark.parametrize(
    ("document", "field", "allowed"),
    [
        (spec(extra=1), "kinematics.extra", "name, shafts, bearings, gears, meshes"),
        (spec(bearings=[bearing(catalogue="6205", speed=1)]), "kinematics.bearings.0.speed", "catalogue, balls"),
        (spec(bearings=[bearing(orders={"bpfo": 3.5, "bpfi": 5.5, "bpf": 1})]), "orders.bpf", "bpfo, bpfi, bsf, ftf"),
        ({"kinematic": {}}, "machine", "kinematics"),
    ],
)
def test_the_refusal_of_an_unknown_key_lists_the_known_ones(document, field, allowed) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(SpecError) as caught:
        read_kinematic_spec(document)
    (problem,) = caught.value.problems
    assert problem.field.endswith(field) and allowed in problem.allowed


def test_the_example_of_the_page_is_read() -> None:
    page = (Path(__file__).parents[3] / "docs" / "reconcile.md").read_text(encoding="utf-8")
    (example,) = (text for text in re.findall(r"```json\n(.*?)```", page, re.DOTALL) if "kinematics" in text)
    tie = ties(read_kinematic_spec(json.loads(example)))
    assert tie.shafts["output"] == pytest.approx(21 / 64)


def problems(document):  # type: ignore[no-untyped-def]
    with pytest.raises(SpecError) as caught:
        read_kinematic_spec(document)
    return caught.value.problems


def test_shafts_and_gears_that_are_not_there_are_refused_by_field_with_those_that_are() -> None:
    gears = [{"name": "pinion", "shaft": "shaft", "teeth": 20}, {"name": "wheel", "shaft": "outt", "teeth": 50}]
    parts = {"bearings": [{**bearing(catalogue="6205"), "shaft": "shft"}], "gears": gears}
    shaft, wheel, mesh = problems(spec(**parts, meshes=[{"name": "m", "gears": ["pinion", "weel"]}]))
    assert (shaft.field, shaft.given, shaft.allowed) == ("kinematics.bearings.0.shaft", "shft", "shaft")
    assert "did you mean shaft" in shaft.message
    assert (wheel.field, wheel.given, wheel.allowed) == ("kinematics.gears.1.shaft", "outt", "shaft")
    assert (mesh.field, mesh.given, mesh.allowed) == ("kinematics.meshes.0.gears.1", "weel", "pinion, wheel")


def test_a_bearing_that_the_catalogue_lacks_is_refused_with_what_is_near_and_how_to_list_all() -> None:
    (problem,) = problems(spec(bearings=[bearing(catalogue="6213")]))
    assert (problem.field, problem.given) == ("kinematics.bearings.0.catalogue", "6213")
    count = len(catalogue())
    assert f"one of {count} that `sideband bearings` lists" in problem.allowed
    assert problem.allowed.startswith("near it ") and "6203" in problem.allowed and "6211" in problem.allowed
    (strange,) = problems(spec(bearings=[bearing(catalogue="QQQ")]))
    assert "near it" not in strange.allowed and f"one of {count}" in strange.allowed
    # a bearing that the catalogue leaves out says why
    left_out = next(iter(missing()))
    assert "left out: " in problems(spec(bearings=[bearing(catalogue=left_out)]))[0].message


def test_speeds_of_two_shafts_must_fit_the_teeth_between_them() -> None:
    def read(speed_hz: float | None) -> None:
        output = {"name": "output"} if speed_hz is None else {"name": "output", "speed_hz": speed_hz}
        read_kinematic_spec(
            {
                "kinematics": {
                    "name": "rig",
                    "shafts": [{"name": "rotor", "speed_hz": 29.95}, output],
                    "gears": [
                        {"name": "a", "shaft": "rotor", "teeth": 20},
                        {"name": "b", "shaft": "output", "teeth": 60},
                    ],
                    "meshes": [{"name": "mesh1", "gears": ["a", "b"]}],
                }
            }
        )

    read(None)
    read(9.98)
    with pytest.raises(SpecError, match=r"turn output at 9\.983 Hz, but its speed_hz is 20"):
        read(20.0)


def test_balls_that_cannot_fit_are_refused_with_the_bearing_they_are_of() -> None:
    bearings = [
        {"name": "a", "shaft": "shaft", "catalogue": "6205"},
        {"name": "b", "shaft": "shaft", "balls": 13, "diameter_ratio": 0.3},
    ]
    with pytest.raises(SpecError) as caught:
        read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": bearings}})
    (problem,) = caught.value.problems
    assert problem.field == "kinematics.bearings.1.balls" and problem.given == 13
