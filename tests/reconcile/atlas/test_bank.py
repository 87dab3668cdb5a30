"""A few machines of one structure are simulated one by one, many side by side: the statistics are the same."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.atlas import bank
from reconcile.atlas.bank import Task, run_task, tasks
from reconcile.atlas.candidates import candidates
from reconcile.atlas.plan import Point, atlas_plan
from reconcile.calibrate.uncertain import uncertain_numbers
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
    monkeypatch.setattr(bank, "FEW", 0)
    beside = run_task(pair)
    for a, b in zip(alone, beside, strict=True):
        assert a is not None and b is not None
        np.testing.assert_allclose(a.total, b.total, rtol=1e-6)
