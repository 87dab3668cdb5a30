"""Which draws the heats simulate, and what a reconciliation costs."""

from __future__ import annotations

from collections.abc import Iterable
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.bank import Task
from reconcile.atlas.candidates import candidates
from reconcile.atlas.plan import AtlasPlan, Point, atlas_plan
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.machine.library import share_of
from reconcile.machine.local import (
    LANES,
    LEAST_DRAWS,
    UNKNOWN_DB,
    first_heat,
    more_draws,
    ordered_draws,
    repeat_db,
    second_heat,
)
from reconcile.machine.meter import Meter
from reconcile.observe.statistics import Statistics
from sim import presets

RANKED = ("outer_spall@bearing2", "inner_spall@bearing1", "outer_spall@bearing1", "tooth_crack@gear", "backlash@mesh1")
RINGS = ("fit_clearance@bearing1", "fit_clearance_series@bearing2")


@pytest.fixture(scope="module")
def atlas() -> AtlasPlan:
    machine = presets.preset("paper-lightly-damped")
    chosen = [c for c in candidates(machine) if c.label in (*RANKED, *RINGS)]
    return atlas_plan(machine, uncertain_numbers(machine), chosen, seed=1)


def labels(plan: AtlasPlan) -> list[str]:
    return [d.candidate.label for d in plan.draws if d.candidate is not None]


def test_the_first_heat_fills_lanes_with_the_best_effects_at_all_their_sites(atlas: AtlasPlan) -> None:
    found = labels(first_heat(atlas, RANKED, ordered_draws(atlas, ()), terms=3))
    assert found.count("outer_spall@bearing2") == found.count("outer_spall@bearing1") == LANES // 2
    assert found.count("inner_spall@bearing1") == found.count("tooth_crack@gear") == LANES
    assert "backlash@mesh1" not in found


def test_what_runs_one_by_one_gets_few_draws_first_and_all_if_it_is_among_the_best(atlas: AtlasPlan) -> None:
    draws = ordered_draws(atlas, ())
    first = first_heat(atlas, RINGS, draws, terms=2)
    assert labels(first) == [name for name in RINGS for _ in range(LEAST_DRAWS)]
    assert len(second_heat(atlas, RINGS, draws, first).draws) == 2 * (LANES - LEAST_DRAWS)


def test_more_draws_are_those_that_are_not_done(atlas: AtlasPlan) -> None:
    draws = ordered_draws(atlas, ())
    plan = more_draws(atlas, {"tooth_crack@gear": 2, "backlash@mesh1": LANES}, draws)
    assert [d.term for d in plan.draws] == [d.term for d in draws["tooth_crack@gear"][2:]]


def test_the_nearest_draw_comes_first_and_the_rest_as_usual(atlas: AtlasPlan) -> None:
    usual = ordered_draws(atlas, ())["tooth_crack@gear"]
    term = usual[-1].term
    found = ordered_draws(atlas, (), {id(term)})["tooth_crack@gear"]
    assert found[0].term is term and found[1:] == usual[:-1]


def test_the_second_heat_simulates_what_the_first_did_not(atlas: AtlasPlan) -> None:
    first = first_heat(atlas, RANKED, ordered_draws(atlas, ()), terms=1)
    second = second_heat(atlas, RANKED[:2], ordered_draws(atlas, ()), first)
    assert labels(second).count("outer_spall@bearing2") == LANES // 2 and labels(second).count(RANKED[1]) == LANES
    sizes = sorted(share_of(d) for p in (first, second) for d in p.draws if d.candidate.label == RANKED[0])  # type: ignore[union-attr]
    known = sorted(share_of(d) for d in atlas.draws if d.candidate is not None and d.candidate.label == RANKED[0])
    assert sizes == known, "all of the atlas' sizes, each once"
    assert share_of(first.draws[0]) > float(np.median(known)), "large sizes first"


def test_an_effect_with_one_place_needs_no_second_heat(atlas: AtlasPlan) -> None:
    drawn = ordered_draws(atlas, ())
    first = first_heat(atlas, ("tooth_crack@gear",), drawn, terms=1)
    assert second_heat(atlas, ("tooth_crack@gear",), drawn, first).draws == ()


def test_draws_that_showed_something_come_first(atlas: AtlasPlan) -> None:
    drawn = [d for d in atlas.draws if d.candidate is not None and d.candidate.label == RANKED[0]]
    smallest = min(drawn, key=share_of)
    assert ordered_draws(atlas, [smallest.term])[RANKED[0]][0] is smallest  # type: ignore[list-item]
    assert ordered_draws(atlas, ())[RANKED[0]][-1] is smallest


def busy(task: Task) -> list[Statistics | None]:
    return [None] * len(task.draws)


def elsewhere(work: object, tasks: Iterable[Task]) -> Iterable[object]:
    for task in tasks:
        _, found = work(task)  # type: ignore[operator]
        yield 5.0, found


def test_seconds_of_other_processes_count(atlas: AtlasPlan) -> None:
    task = Task(plan=atlas, draws=(0, 1), point=Point(speed_hz=30.0), channels=("a",))
    meter = Meter(elsewhere)
    assert list(meter(busy, [task, task])) == [[None, None]] * 2
    assert 10.0 <= meter.spent_s() < 11.0
    own = Meter(map)
    list(own(busy, [task]))
    assert own.spent_s() < 1.0


def test_lines_repeat_by_what_twins_of_sound_machines_differ(atlas: AtlasPlan) -> None:
    rng = np.random.default_rng(7)
    line = np.ones((len(atlas.draws), 2, 3))
    change = rng.normal(0.0, 4.0, line.shape)
    for k, draw in enumerate(atlas.draws):
        if draw.candidate is None and draw.twin:
            line[k, :, 1] = 10.0 ** (change[k, :, 1] / 10.0)
        elif draw.candidate is not None:
            line[k] = 1e6
    alive = np.ones(len(atlas.draws), dtype=bool)
    dead = next(k for k, d in enumerate(atlas.draws) if d.candidate is None and d.twin)
    alive[dead], line[dead] = False, np.nan
    found = repeat_db(SimpleNamespace(line=line, alive=alive), atlas)  # type: ignore[arg-type]
    assert found.shape == (2, 3)
    np.testing.assert_allclose(found[:, [0, 2]], 0.0, atol=1e-9)
    np.testing.assert_allclose(found[:, 1], 4.0, rtol=0.4)


def test_drift_that_moves_all_alike_counts_lines_that_vanish_are_bounded_and_few_say_nothing(atlas: AtlasPlan) -> None:
    twins = [k for k, d in enumerate(atlas.draws) if d.candidate is None and d.twin]
    line = np.ones((len(atlas.draws), 1, 2))
    line[twins, :, 0] = 10.0**0.6
    line[twins[0], :, 1] = 0.0
    alive = np.ones(len(atlas.draws), dtype=bool)
    found = repeat_db(SimpleNamespace(line=line, alive=alive), atlas)  # type: ignore[arg-type]
    assert found[0, 0] == pytest.approx(6.0)
    assert found[0, 1] == pytest.approx(20.0 / len(twins) ** 0.5)
    alive[twins[3:]] = False
    few = repeat_db(SimpleNamespace(line=line, alive=alive), atlas)  # type: ignore[arg-type]
    assert np.all(few == UNKNOWN_DB)
