"""Machines are built by their numbers: those of a shard for the shard, all of them when a recipe is looked at."""

from __future__ import annotations

import numpy as np
import pytest

from sideband_datasets import make_plan, rows
from sideband_datasets.make.stream import rows_of
from sideband_datasets.plan import drawing, plan_again
from sideband_datasets.plan.machines import Family
from sideband_datasets.plan.plan import laid_out
from sideband_datasets.plan.points import BLOCK, Points
from sideband_datasets.plan.population import KEPT
from sideband_datasets.plan.seeds import Stream
from tests.sideband_datasets.small import document, tiny


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, int]]:
    """Family and number of every machine that is built."""
    found: list[tuple[int, int]] = []
    really = Family.built

    def counted(family: Family, instance: int):  # type: ignore[no-untyped-def]
        found.append((family.number, instance))
        return really(family, instance)

    monkeypatch.setattr(Family, "built", counted)
    return found


def _wide(instances: int, count: int):  # type: ignore[no-untyped-def]
    machines = [{**document()["machines"][0], "instances": instances}]
    return tiny(machines=machines, count=count, seed=instances)


def test_a_plan_that_was_made_before_builds_only_the_machines_of_its_rows(built) -> None:  # type: ignore[no-untyped-def]
    recipe = _wide(40, 80)
    plan = plan_again(recipe)
    assert not built
    drawn = [drawing(plan, number) for number in (3, 4, 3)]
    assert len(built) == len({one.machine.machine_id for one in drawn})
    assert drawn[0].machine.machine_id == plan.machine_id(int(plan.machine[3]))


def test_each_machine_is_built_once_when_a_recipe_is_looked_at(built) -> None:  # type: ignore[no-untyped-def]
    plan = make_plan(_wide(41, 82))
    assert len(built) <= 41 + 6  # and those again that are tried with a fault
    assert set(built) == {(0, k) for k in range(41)}
    assert [machine.machine_id for machine in plan.machines] == [plan.machine_id(m) for m in range(41)]


def test_no_more_machines_are_kept_than_a_batch_may_have() -> None:
    plan = laid_out(_wide(KEPT + 20, KEPT + 20))
    first = plan.machines[0]
    assert plan.machines[0] is first
    list(plan.machines)
    assert plan.machines[0] is first  # a walk over all drives none out
    plan.machines[1 : KEPT + 1]
    assert plan.machines[0] is not first
    assert plan.machines[0] == first


@pytest.mark.slow
def test_rows_of_a_plan_that_was_made_before_are_the_same() -> None:
    recipe = _wide(4, 8)
    for one, other in zip(rows(recipe, [0, 9]), rows_of(plan_again(recipe), [0, 9]), strict=True):
        assert one.machine_id == other.machine_id
        np.testing.assert_array_equal(one.signal, other.signal)


@pytest.mark.parametrize("kind", ["sobol", "latin_hypercube", "factorial"])
@pytest.mark.parametrize("count", [3, BLOCK, 2 * BLOCK + 5])
def test_a_table_has_the_points_by_their_numbers(kind, count) -> None:  # type: ignore[no-untyped-def]
    points = Points(kind=kind, levels=(2, 3, 4), count=count, seed=5, stream=Stream.FAMILY, number=1)
    table = points.table()
    assert table.shape == (count, 3)
    for k in {0, 1, count // 2, count - 1}:
        np.testing.assert_array_equal(table[k], points.at(k))
    bare = Points(kind=kind, levels=(), count=count, seed=5, stream=Stream.FAMILY, number=1)
    assert bare.table().shape == (count, 0)
