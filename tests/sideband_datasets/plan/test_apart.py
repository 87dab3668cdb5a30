from __future__ import annotations

from typing import Any

import pytest

from sideband_datasets.plan.plan import planned
from sim.core.errors import SpecError
from sim.presets import preset
from tests.sideband_datasets.small import document, tiny

PATH = {"kind": "modes", "modes": [{"frequency_hz": 3000, "damping_ratio": 0.05, "gain": 1.0}]}
FREQUENCY = "path.modes.0.frequency_hz"
RANGE = {"low": 1000, "high": 5000}


def _measured(vary: dict[str, object], *, paths: tuple[str, ...] = ("de", "nde")) -> list[dict[str, Any]]:
    """The tiny recipe's chain with a path at the named channels."""
    (chosen,) = document()["measurement"]
    for channel in chosen["chain"]["channels"]:
        if channel["name"] in paths:
            channel["path"] = PATH
    return [{**chosen, "vary": vary}]


def test_a_path_that_all_machines_share_is_refused_by_its_channel():
    with pytest.raises(SpecError) as told:
        planned(tiny(measurement=_measured({f"channels.de.{FREQUENCY}": RANGE})))
    (problem,) = told.value.problems
    assert problem.field == "measurement.0.vary"
    assert "channel nde" in problem.message
    assert problem.given == f"channels.de.{FREQUENCY}"
    assert f"channels.nde.{FREQUENCY}" in str(problem.allowed)


def test_every_channel_with_a_shared_path_is_told():
    with pytest.raises(SpecError) as told:
        planned(tiny(measurement=_measured({})))
    assert {p.message.split("channel ")[1].split()[0] for p in told.value.problems} == {"de", "nde"}
    assert all(p.given == "nothing" for p in told.value.problems)


def test_paths_of_their_own_for_every_channel_are_taken():
    plan = planned(tiny(measurement=_measured({f"channels.*.{FREQUENCY}": RANGE})))
    assert [set(m.channel_paths) for m in plan.machines] == [{"de", "nde"}] * 4
    assert len({path for m in plan.machines for path in m.channel_paths.values()}) == 4


def test_a_channel_without_a_path_goes_with_its_machine():
    plan = planned(tiny(measurement=_measured({f"channels.de.{FREQUENCY}": RANGE}, paths=("de",))))
    assert [set(m.channel_paths) for m in plan.machines] == [{"de"}] * 4
    assert len({m.path_id for m in plan.machines}) == 4


def test_one_split_may_have_one_path():
    plan = planned(tiny(measurement=_measured({}), splits={"train": 1.0}))
    assert len({path for m in plan.machines for path in m.channel_paths.values()}) == 1


def _families(**changes: object) -> list[dict[str, object]]:
    """Two machines, one with something changed, each a family."""
    machine = preset("rotor").model_dump(mode="json")
    return [
        {"name": "first", "machine": machine, "instances": 1},
        {"name": "second", "machine": {**machine, **changes}, "instances": 1},
    ]


@pytest.mark.parametrize(
    "changes",
    [
        {"machines": _families(name="another", notes="the same one")},
        {"machines": [{**document()["machines"][0], "vary": {"speed_hz": {"low": 20, "high": 40}}}]},
        {"conditions": {"bearings.bearing1.support.stiffness_y_n_per_m": {"low": 1e7, "high": 1e8}}},
    ],
)
def test_one_machine_under_other_names_or_speeds_is_refused(changes):
    with pytest.raises(SpecError, match=r"splits: machines of the same parameters .*name, notes, speed, loads"):
        planned(tiny(**changes))


def test_one_split_may_have_one_machine_at_many_speeds():
    machines = [{**document()["machines"][0], "vary": {"speed_hz": {"low": 20, "high": 40}}}]
    plan = planned(tiny(machines=machines, splits={"train": 1.0}))
    assert len({m.content for m in plan.machines}) == 1
