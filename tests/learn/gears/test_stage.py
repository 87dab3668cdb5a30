import pytest

from learn.gears.stage import stages
from reconcile.kinematics.spec import read_kinematic_spec

TWO = {
    "kinematics": {
        "shafts": [{"name": "in"}, {"name": "mid"}, {"name": "out"}],
        "gears": [
            {"name": "a", "shaft": "in", "teeth": 20},
            {"name": "b", "shaft": "mid", "teeth": 60},
            {"name": "c", "shaft": "mid", "teeth": 25},
            {"name": "d", "shaft": "out", "teeth": 50},
        ],
        "meshes": [{"name": "first", "gears": ["a", "b"]}, {"name": "second", "gears": ["d", "c"]}],
    }
}


def test_stages_are_seen_from_the_shaft_whose_speed_is_told():
    first, second = stages(read_kinematic_spec(TWO), "in")
    assert (first.name, first.gears, first.teeth, first.ratio) == ("first", ("a", "b"), (20, 60), 1.0)
    assert (second.gears, second.teeth) == (("c", "d"), (25, 50))
    assert second.ratio == pytest.approx(1 / 3)
    assert stages(read_kinematic_spec(TWO), "out")[0].ratio == pytest.approx(6.0)


def test_without_meshes_there_is_no_stage():
    assert stages(read_kinematic_spec({"kinematics": {"shafts": [{"name": "in"}]}}), None) == []
