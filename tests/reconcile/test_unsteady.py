"""Where the speed changes during a test, the report says so and nothing else."""

from __future__ import annotations

from reconcile.entry import reconcile_recordings
from reconcile.kinematics import KinematicSpec
from reconcile.unsteady import unsteady
from tests.reconcile.speed.test_run_up import from_to, recording

SPEC = KinematicSpec.model_validate(
    {"name": "m", "shafts": [{"name": "rotor"}], "bearings": [{"name": "b1", "shaft": "rotor", "catalogue": "6205"}]}
)


def test_a_run_up_is_not_decidable_and_says_by_how_much() -> None:
    report = reconcile_recordings(SPEC, [recording(from_to(20.0, 30.0))])
    assert report.verdict == "not_decidable" and report.level == "kinematics"
    assert "rises by about 4" in report.sentence and "test 1" in report.sentence
    assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence
    assert {"physics_version", "seed", "cost"} <= set(report.provenance)


def test_one_of_several_may_be_left_out() -> None:
    held = recording(from_to(25.0, 25.0))
    report = unsteady([held, recording(from_to(35.0, 28.0))], [], "machine", 0)
    assert report is not None and report.level == "machine"
    assert "falls" in report.sentence and "test 2" in report.sentence
    assert report.next_experiment is not None and "leave test 2 out" in report.next_experiment.sentence
    assert unsteady([held], [held], "machine", 0) is None


def test_a_baseline_that_runs_up_is_no_baseline() -> None:
    report = unsteady([recording(from_to(25.0, 25.0))], [recording(from_to(20.0, 30.0))], "kinematics", 0)
    assert (
        report is not None and "baseline 1" in report.sentence and "leave baseline 1 out" in str(report.next_experiment)
    )
