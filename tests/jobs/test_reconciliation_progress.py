"""Progress of a reconciliation by kinematics: stages of the engine in their order, shares that only grow, time left."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from jobs.record import JobRecord
from jobs.status import Status
from tests.service.reconciling import World
from tests.strategies.impulses import recorded, sound, train

KNOWN = {
    "kinematics": {
        "shafts": [{"name": "shaft"}],
        "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
    }
}
STAGES = [
    "held speed",
    "sensor gate",
    "speed and features",
    "lines of bearings, teeth and shafts",
    "other speeds",
    "held-out data",
]


def recordings(world: World) -> tuple[list[str], list[str]]:
    rng = np.random.default_rng(2)
    tests = [world.sent(recorded(sound(seed) + train(rng, 3.5848, 1.0))) for seed in (2, 5)]
    return tests, [world.sent(recorded(sound(seed))) for seed in (1, 3)]


def carried_out(world: World, record: JobRecord) -> tuple[JobRecord, list[JobRecord]]:
    """The finished job, and the record after every change."""
    told: list[JobRecord] = []
    change = world.catalogue.change

    def heard(job_id: str, transition: object) -> JobRecord:
        told.append(change(job_id, transition))  # type: ignore[arg-type]
        return told[-1]

    world.catalogue.change = heard  # type: ignore[method-assign]
    return world.carried_out(record), told


@pytest.mark.slow
def test_a_job_of_kinematics_tells_its_stages_with_shares_and_time_left(tmp_path: Path) -> None:
    world = World(tmp_path)
    tests, baselines = recordings(world)
    done, told = carried_out(world, world.ask(tests, KNOWN, baselines=baselines))
    assert done.status is Status.SUCCESSFUL
    shares = [r.progress.fraction for r in told]
    assert shares == sorted(shares)
    running = [r.progress for r in told if r.status is Status.RUNNING]
    stages = list(dict.fromkeys(p.stage for p in running))
    assert stages[0] == "starting" and stages[-1] == "storing"
    assert [s for s in stages if s in STAGES] == STAGES
    begun = [p for p in running if p.stage in STAGES[1:]]
    assert all(p.eta_s is not None and p.eta_s >= 0 for p in begun)
