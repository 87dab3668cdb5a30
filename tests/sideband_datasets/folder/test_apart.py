from __future__ import annotations

from dataclasses import replace

import pytest

from sideband_datasets.folder.apart import apart, in_two
from sideband_datasets.folder.shards import Receipt
from sideband_datasets.plan.plan import Plan, planned
from tests.sideband_datasets.small import document, tiny


@pytest.fixture(scope="module")
def plan() -> Plan:
    return planned(tiny())


def _receipts(plan: Plan) -> list[Receipt]:
    found = []
    for number, split in enumerate(plan.splits):
        own = [m for m, s in zip(plan.machines, plan.split_of, strict=True) if s == number]
        found.append(
            Receipt(
                name=f"{split}-00000-of-00001.parquet",
                split=split,
                rows=1,
                bytes=1,
                sha256="0",
                machines=tuple(m.machine_id for m in own),
                paths=tuple(m.path_id for m in own),
                failures=(),
            )
        )
    return found


def test_what_occurs_in_two_is_named_once():
    assert in_two([("a", "x"), ("b", "y"), ("a", "x"), ("b", "x"), ("b", "x"), ("a", "z")]) == ["x"]


def test_what_was_made_apart_is_counted(plan):
    told = apart(plan, _receipts(plan))
    assert told.startswith("No machine and no transfer path occurs in two splits: checked on the rows made, of 4 machi")
    assert "path being the machine's own: de, nde." in told


def test_outputs_without_sensors_have_the_machine_s_own_path():
    plan = planned(tiny(measurement=[]))
    assert "the path is the machine's own" in apart(plan, _receipts(plan))


def test_a_machine_made_in_two_splits_is_told(plan):
    one, other = _receipts(plan)
    told = apart(plan, [one, replace(other, machines=(*other.machines, one.machines[0]))])
    assert told == f"**Machines or transfer paths occur in more than one split**: {one.machines[0]}."


def test_a_path_made_in_two_splits_is_told(plan):
    one, other = _receipts(plan)
    told = apart(plan, [one, replace(other, paths=one.paths[:1])])
    assert told == f"**Machines or transfer paths occur in more than one split**: {one.paths[0]}."


def test_one_machine_under_two_names_is_told(plan):
    content = plan.machines[0].content
    alike = replace(plan, machines=tuple(replace(machine, content=content) for machine in plan.machines))
    told = apart(alike, _receipts(plan))
    assert told.startswith("**Machines") and all(machine.machine_id in told for machine in plan.machines)


def test_one_channel_s_path_in_two_splits_is_told(plan):
    shared = tuple(replace(machine, channel_paths={"nde": "0"}) for machine in plan.machines)
    assert "rotor-0000.nde" in apart(replace(plan, machines=shared), _receipts(plan))


def test_without_a_bare_channel_nothing_is_said_of_one():
    chosen = document()["measurement"]
    path = {"kind": "modes", "modes": [{"frequency_hz": 3000, "damping_ratio": 0.05, "gain": 1.0}]}
    for channel in chosen[0]["chain"]["channels"]:
        channel["path"] = path
    chosen[0]["vary"] = {"channels.*.path.modes.0.frequency_hz": {"low": 1000, "high": 5000}}
    plan = planned(tiny(measurement=chosen))
    assert "own" not in apart(plan, _receipts(plan))
