"""Recipes of more machines than are built in some seconds are refused before one is built."""

from __future__ import annotations

import pytest

from sideband_datasets import Recipe, make_plan
from sideband_datasets.plan import estimate, least_bytes, most
from sideband_datasets.plan.machines import Family
from sim.core.errors import Problem, SpecError
from tests.sideband_datasets.small import OUTER, document, tiny


@pytest.fixture
def nothing_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(family: Family, instance: int) -> None:
        raise AssertionError(f"machine {instance} was built")

    monkeypatch.setattr(Family, "built", never)


def _families(count: int, instances: int) -> list[dict[str, object]]:
    one = document()["machines"][0]
    return [{**one, "name": f"rotor{k}", "instances": instances} for k in range(count)]


def _refused(recipe: Recipe) -> Problem:
    with pytest.raises(SpecError) as told:
        make_plan(recipe)
    (problem,) = told.value.problems
    return problem


@pytest.mark.usefixtures("nothing_is_built")
def test_machines_of_all_families_together_are_bounded() -> None:
    problem = _refused(tiny(machines=_families(4, 10_000), count=200_000))
    assert (problem.field, problem.given, problem.allowed) == ("machines", 40_000, "10000 `instances` or fewer in all")


@pytest.mark.usefixtures("nothing_is_built")
def test_classes_times_families_are_bounded() -> None:
    faults = [{"name": f"outer{k}", "terms": [OUTER]} for k in range(63)]
    problem = _refused(tiny(machines=_families(8, 1), faults=faults, count=2000))
    assert (problem.field, problem.given, problem.allowed) == ("faults", 512, "500 or fewer classes times families")


@pytest.mark.usefixtures("nothing_is_built")
def test_what_is_drawn_and_described_for_machines_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(most, "MOST_DRAWN", 50)
    problem = _refused(tiny(machines=_families(1, 51)))
    assert (problem.field, problem.given) == ("machines.0.instances", 51)
    assert problem.allowed.startswith("50 or fewer `instances` in all")
    monkeypatch.setattr(most, "MOST_DRAWN", 51)
    monkeypatch.setattr(most, "MOST_DESCRIBED", 100_000)
    assert "characters described" in _refused(tiny(machines=_families(1, 51))).message


@pytest.mark.slow
def test_the_least_size_is_no_more_than_the_estimate() -> None:
    for changes in ({}, {"windows": {"per_recording": 3}}, {"windows": {"length_revolutions": 1}}):
        recipe = tiny(**changes)
        assert 0 < least_bytes(recipe) <= estimate(make_plan(recipe), 1).bytes
    assert least_bytes(tiny()) == estimate(make_plan(tiny()), 1).bytes
