"""A few machines of one structure are simulated one by one, many side by side: the statistics are the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.atlas import run
from reconcile.atlas.bank import Task, run_task, tasks
from reconcile.atlas.candidates import Candidate, candidates
from reconcile.atlas.plan import AtlasPlan, Point, atlas_plan, side_by_side
from reconcile.calibrate.uncertain import uncertain_numbers
from sim.core.spec import MachineSpec
from sim.presets import preset


@pytest.mark.slow
def test_one_by_one_equals_side_by_side(monkeypatch: pytest.MonkeyPatch) -> None:
    machine = preset("rotor")
    plan = atlas_plan(machine, uncertain_numbers(machine), candidates(machine)[1:3], seed=0)
    point = Point(speed_hz=machine.operating.speed_hz if machine.operating else 30.0, torque_ratio=1.0)
    todo = tasks(plan, point, ("disc.y.acceleration",))
    # one effect at two places makes two structures
    sites = [{(d.candidate.term, d.candidate.site) for k in t.draws if (d := plan.draws[k]).candidate} for t in todo]
    assert all(len(found) <= 1 for found in sites)
    pair = Task(plan=plan, draws=(0, 1), point=point, channels=("disc.y.acceleration",))
    alone = run_task(pair)
    monkeypatch.setattr(run, "FEW", 0)
    beside = run_task(pair)
    for a, b in zip(alone, beside, strict=True):
        assert a is not None and b is not None
        np.testing.assert_allclose(a.total, b.total, rtol=1e-6)


WATCHED = ("disc.y.acceleration",)


def two_places(machine: MachineSpec, key: str) -> AtlasPlan:
    """Two draws of an effect at each of two bearings."""
    places = tuple(Candidate(term=key, site=b.name) for b in machine.bearings[:2])
    plan = atlas_plan(machine, uncertain_numbers(machine), places, seed=0, pairs=2, draws=2)
    return replace(plan, draws=tuple(d for d in plan.draws if d.candidate is not None))


@pytest.mark.slow
@pytest.mark.parametrize("key", ["outer_spall", "pedestal_looseness"])
def test_one_effect_at_several_places_fills_lanes(key: str) -> None:
    plan = two_places(preset("rotor"), key)
    beside = side_by_side(plan)
    assert len(tasks(plan, Point(speed_hz=30.0), WATCHED)) == 2, "a structure a place"
    (task,) = tasks(beside, Point(speed_hz=30.0), WATCHED)
    places = {t.site for d in beside.draws for t in d.beside}
    assert places == {b.name for b in plan.machine.bearings[:2]}
    together = run_task(task)
    alone = [found for one in tasks(plan, Point(speed_hz=30.0), WATCHED) for found in run_task(one)]
    for a, b in zip(alone, together, strict=True):
        assert a is not None and b is not None
        np.testing.assert_allclose(10 * np.log10(a.band), 10 * np.log10(b.band), atol=0.01)


@pytest.mark.slow
def test_a_place_where_an_effect_cannot_act_takes_no_other_with_it() -> None:
    plan = two_places(preset("rotor"), "outer_spall")
    impossible = [d.term.model_copy(update={"site": "nowhere"}) for d in plan.draws if d.term is not None]
    draws = tuple(replace(d, beside=(t,)) for d, t in zip(plan.draws, impossible, strict=True))
    (task,) = tasks(replace(plan, draws=draws[:2]), Point(speed_hz=30.0), WATCHED)
    assert all(found is not None for found in run_task(task))


def test_an_effect_without_a_faint_form_stands_alone() -> None:
    plan = side_by_side(two_places(preset("paper"), "fit_clearance_series"))
    assert all(d.beside == () for d in plan.draws)
