"""What travels between workers is what the leading worker meant, to the last bit."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from jobs.atlas.document import from_bytes, restored_tasks, round_document, to_bytes
from reconcile.atlas.bank import Task, run_task, tasks
from reconcile.atlas.candidates import candidates
from reconcile.atlas.keep import ATLAS_VERSION
from reconcile.atlas.plan import Point, atlas_plan, with_tooth_pairs
from reconcile.calibrate.uncertain import uncertain_numbers
from sim.presets import preset
from tests.jobs.atlas.rounds import CHANNELS, POINT, plan, pretended, same, todo


def travelled(several: list[Task], first: int, last: int) -> list[Task]:
    return restored_tasks(json.loads(json.dumps(round_document(several))), first, last)


@pytest.mark.parametrize("name", ["rotor", pytest.param("paper", marks=pytest.mark.slow)])
def test_machines_and_seeds_survive(name: str) -> None:
    machine = with_tooth_pairs(preset(name))
    made = atlas_plan(machine, uncertain_numbers(machine), candidates(machine)[::5], seed=3, draws=1, pairs=1)
    several = tasks(made, Point(speed_hz=29.7, torque_ratio=1 / 3), CHANNELS, together=2)
    again = travelled(several, 0, len(several))
    for task, other in zip(several, again, strict=True):
        assert (other.point, other.channels) == (task.point, task.channels)
        for k, j in zip(task.draws, other.draws, strict=True):
            meant, got = (
                task.plan.member(made.draws[k], task.point),
                other.plan.member(other.plan.draws[j], other.point),
            )
            assert (got.seed, got.machine.terms) == (meant.seed, meant.machine.terms)
            assert got.machine.model_copy(update={"name": machine.name, "notes": machine.notes}) == meant.machine


def test_a_stretch_is_that_stretch() -> None:
    whole = [found for task in todo() for found in pretended(task)]
    first = sum(len(task.draws) for task in todo()[:2])
    middle = [found for task in travelled(todo(), 2, 4) for found in pretended(task)]
    assert same([middle], [whole[first : first + len(middle)]]) and any(found is None for found in whole)


def test_faint_effects_beside_travel_too() -> None:
    assert any(draw.beside for draw in plan().draws)
    for task, other in zip(todo(), travelled(todo(), 0, len(todo())), strict=True):
        assert [task.plan.draws[k].beside for k in task.draws] == [other.plan.draws[k].beside for k in other.draws]


def test_a_round_is_known_by_its_numbers_not_by_the_machines_name() -> None:
    def named(name: str) -> list[Task]:
        machine = plan().machine.model_copy(update={"name": name})
        return tasks(replace(plan(), machine=machine), POINT, CHANNELS)

    assert round_document(named("a")) == round_document(named("b"))
    other = tasks(plan(), replace(POINT, torque_ratio=0.5), CHANNELS)
    assert round_document(other) != round_document(named("a"))


def test_what_was_seen_survives() -> None:
    seen = pretended(Task(plan=plan(), draws=tuple(range(len(plan().draws))), point=POINT, channels=CHANNELS))
    assert same([from_bytes(to_bytes(seen))], [seen]) and to_bytes(seen) == to_bytes(from_bytes(to_bytes(seen)))
    assert from_bytes(to_bytes([None, None])) == [None, None]
    assert any(one is None for one in seen) and any(one is not None and np.isnan(one.line).any() for one in seen)


@pytest.mark.slow
def test_a_restored_task_simulates_the_same_numbers() -> None:
    task = Task(plan=plan(), draws=(0, 9, 17), point=POINT, channels=CHANNELS)
    (again,) = travelled([task], 0, 1)
    assert to_bytes(run_task(again)) == to_bytes(run_task(task))


def test_a_round_is_another_where_atlases_are_made_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    before = round_document(todo())
    monkeypatch.setattr("jobs.atlas.document.ATLAS_VERSION", ATLAS_VERSION + 1)
    assert round_document(todo()) != before
