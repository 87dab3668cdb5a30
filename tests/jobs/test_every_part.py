"""All that is wrong with kinematics is told at once, whichever step of reading finds it."""

from __future__ import annotations

import pytest

from jobs.reconciliations.every_part import read_every_part
from reconcile.kinematics import read_kinematic_spec
from sim.core.errors import SpecError

SHAFTS = [{"name": "input", "speed_hz": 24.5}]
SOUND = {
    "shafts": [*SHAFTS, {"name": "output"}],
    "bearings": [{"name": "near", "shaft": "input", "catalogue": "6205"}],
    "gears": [{"name": "pinion", "shaft": "input", "teeth": 21}, {"name": "wheel", "shaft": "output", "teeth": 64}],
    "meshes": [{"name": "mesh", "gears": ["pinion", "wheel"]}],
}


def told(kinematics: object) -> set[str]:
    with pytest.raises(SpecError) as refused:
        read_every_part(kinematics)
    fields = [p.field.removeprefix("kinematics.") for p in refused.value.problems]
    assert len(fields) == len(set(fields)), "each once"
    assert all(p.allowed for p in refused.value.problems)
    return set(fields)


def test_what_is_sound_is_read() -> None:
    assert read_every_part(SOUND) == read_kinematic_spec({"kinematics": SOUND})


def test_a_wrong_value_hides_no_name_catalogue_or_size() -> None:
    bearings = [
        {"name": "a", "shaft": "inptu", "catalogue": "62O5"},
        {"name": "b", "shaft": "input", "balls": 8, "diameter_ratio": 0.8},
        {"name": "c", "shaft": "input", "orders": {"bpfo": 5.0, "bpfi": 3.0}},
        {"name": "d", "shaft": "input"},
    ]
    gears = [{"name": "g", "shaft": "outptu", "teeth": "many"}]
    meshes = [{"name": "m", "gears": ["g", "h"]}]
    shafts = [{"name": "input", "speed_hz": -4.0}]
    found = told({"shafts": shafts, "bearings": bearings, "gears": gears, "meshes": meshes})
    assert found == {
        "shafts.0.speed_hz",
        *("bearings.0.shaft", "bearings.0.catalogue", "bearings.1.diameter_ratio", "bearings.2.orders.bpfo"),
        *("bearings.3", "gears.0.shaft", "gears.0.teeth", "meshes.0.gears.1"),
    }


def test_what_was_told_is_not_told_twice_or_of_what_was_put_in_its_place() -> None:
    assert told({"shafts": SHAFTS, "bearings": [{"name": "a", "shaft": "x", "catalogue": "6205"}]}) == {
        "bearings.0.shaft"
    }
    assert told({"shafts": SHAFTS, "bearings": [{"shaft": "input", "catalogue": "6205"}]}) == {"bearings.0.name"}
    assert told({**SOUND, "shafts": "two"}) >= {"shafts"}
    assert told({"shafts": SHAFTS, "bearings": [7]}) == {"bearings.0"}
    assert told([]) == {"kinematics"}
