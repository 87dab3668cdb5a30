"""A sensor that was away for a while is heard where it was good; one that was gone is not judged."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.verdict import Report
from signals.series import FloatArray
from tests.strategies.impulses import N, recorded, sound, train

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)


def told(first: int, stop: int, value: float) -> Report:
    """A pit that the first of two sensors hears, which gives `value` from one sample to another."""
    pit: FloatArray = sound(2) + train(np.random.default_rng(2), 3.5848 * 0.992, 1.0)
    pit[first:stop] = value
    tests, baselines = [recorded([pit, sound(4)])], [recorded([sound(5), sound(6)])]
    return reconcile_kinematics(SPEC, tests, baselines, seed=0)


@pytest.mark.slow
@pytest.mark.parametrize("value", [np.nan, 0.2])
def test_the_rest_of_a_channel_is_heard(value: float) -> None:
    report = told(N // 20, N // 5, value)
    assert [(c.term, c.site) for c in report.causes if c.named] == [("outer_spall", "bearing1")]
    assert any("only 1 to 5 s were read" in text for text in report.where.limits)
    assert [f.channel for f in report.measurement_faults] == ["a0"]


@pytest.mark.slow
def test_what_a_gone_sensor_would_hear_is_not_judged() -> None:
    for first, stop, value in ((0, N, 0.2), (N // 10, 9 * N // 10, np.nan)):
        report = told(first, stop, value)
        assert report.verdict == "measurement_fault" and report.sentence.endswith("a0 would hear is not judged.")
        assert report.undecidable == ("what a0 would hear is not judged",)
