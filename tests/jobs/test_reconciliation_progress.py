"""Progress of a reconciliation by kinematics: stages of the engine in their order, shares that only grow, time left."""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np
import pytest

from jobs.reconciliations.follow import STAGES, Pace, Stage, followed, place_of
from jobs.record import JobRecord
from jobs.status import Status
from sim.core.errors import Cancelled
from tests.service.reconciling import World
from tests.strategies.impulses import recorded, sound, train

KNOWN = {
    "kinematics": {
        "shafts": [{"name": "shaft"}],
        "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
    }
}


def first() -> int | None:
    return second()


def second() -> int | None:
    return place_of(sys._getframe(), TWO)


TWO = (Stage(work=first, name="first", begin=0.0), Stage(work=second, name="second", begin=0.5))


def test_the_outermost_stage_counts_and_between_two_there_is_none() -> None:
    assert (first(), second(), place_of(sys._getframe(), TWO), place_of(None, TWO)) == (0, 1, None, None)


def test_the_share_stays_within_its_stage_and_never_goes_back() -> None:
    pace = Pace(TWO, expected_s=10.0)
    assert not pace.begun and pace.seen(0, 0.0) and pace.name == "first"
    assert pace.at(2.0) == (0.2, 8.0)
    assert pace.at(30.0)[0] == 0.5, "a stage that takes longer than thought waits at its end"
    assert pace.at(30.0)[1] > 0
    assert pace.seen(1, 30.0) and not pace.seen(0, 31.0) and pace.name == "second"
    share, left_s = pace.at(30.0)
    assert (share, left_s) == (0.5, pytest.approx(30.0)), "half is done: as long again"


def test_the_stages_of_the_engine_come_in_the_order_of_their_shares() -> None:
    shares = [stage.begin for stage in STAGES]
    assert shares == sorted(shares) and shares[0] == 0.0 and shares[-1] < 1.0


def slept() -> None:
    time.sleep(0.3)


@pytest.mark.slow
def test_what_is_not_wanted_any_more_stops_the_telling_not_the_work() -> None:
    told: list[str] = []

    def tell(stage: str, share: float, left_s: float | None) -> None:
        told.append(stage)
        raise Cancelled("cancelled")

    stages = (Stage(work=slept, name="asleep", begin=0.0),)
    with followed(tell, samples=1, stages=stages):
        slept()
    assert told == ["asleep"]


@pytest.mark.slow
def test_a_job_of_kinematics_tells_its_stages_with_shares_and_time_left(tmp_path: Path) -> None:
    world = World(tmp_path)
    rng = np.random.default_rng(2)
    tests = [world.sent(recorded(sound(seed) + train(rng, 3.5848, 1.0))) for seed in (2, 5)]
    baselines = [world.sent(recorded(sound(seed))) for seed in (1, 3)]
    record = world.ask(tests, KNOWN, baselines=baselines)
    told: list[JobRecord] = []
    change = world.catalogue.change

    def heard(job_id: str, transition: object) -> JobRecord:
        told.append(change(job_id, transition))  # type: ignore[arg-type]
        return told[-1]

    world.catalogue.change = heard  # type: ignore[method-assign]
    assert world.carried_out(record).status is Status.SUCCESSFUL
    shares = [r.progress.fraction for r in told]
    stages = list(dict.fromkeys(r.progress.stage for r in told if r.status is Status.RUNNING))
    names = [stage.name for stage in STAGES]
    ours = [name for name in stages if name in names]
    assert shares == sorted(shares)
    assert "held speed" in ours and len(ours) >= 3 and ours == sorted(ours, key=names.index)
    assert stages[0] == "starting" and stages[-1] == "storing"
    inside = [r.progress for r in told if r.progress.stage in names]
    assert all(p.eta_s is not None and p.eta_s >= 0 for p in inside)
    assert max(p.fraction for p in inside) > 0.4
