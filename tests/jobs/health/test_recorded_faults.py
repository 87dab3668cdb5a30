"""From samples to alarms: sound recordings are left in peace, an outer race that goes is told by its name."""

from __future__ import annotations

import numpy as np
import pytest

from jobs.health.alarms import assess
from jobs.health.baselines import Baselines
from jobs.health.features import NO_KINEMATICS, condition_document
from jobs.health.points import ChannelPoint, Operating, Point
from reconcile.kinematics import read_kinematic_spec
from signals.recording import Recording
from tests.jobs.health.points import point
from tests.strategies.impulses import recorded, sound, train

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
OUTER = 3.5848 * 0.992


def made(seed: int, height: float = 0.0) -> Recording:
    return recorded(sound(seed) + height * train(np.random.default_rng(seed), OUTER, 1.0))


def point_of(recording: Recording, name: str, *, baseline: bool = False) -> Point:
    found = condition_document(recording, SPEC)
    channels, operating = found["channels"], found["operating"]
    assert isinstance(channels, dict) and isinstance(operating, dict)
    return point(
        name,
        {},
        baseline=baseline,
        duration_s=recording.duration_s,
        operating=Operating(**operating),
        channels={key: ChannelPoint(**entry) for key, entry in channels.items()},
    )


@pytest.mark.slow
def test_sound_days_are_left_in_peace_and_a_failing_race_is_named() -> None:
    baselines = Baselines([point_of(made(i), f"b{i}", baseline=True) for i in range(16)])
    sound_ones = [assess(point_of(made(i), f"t{i}"), baselines) for i in range(100, 116)]
    assert [s.state for s in sound_ones] == ["ok"] * 16
    for seed in range(200, 206):
        found = assess(point_of(made(seed, 0.7), f"f{seed}"), baselines)
        assert ("family", "bearing1.outer", "alarm") in [(a.kind, a.feature, a.severity) for a in found.alarms]
        assert not [a for a in found.alarms if a.kind == "family" and a.feature != "bearing1.outer"]


@pytest.mark.slow
def test_sound_recordings_shorter_than_their_baselines_raise_nothing() -> None:
    """Where no line is, 0.5 s read 10 dB more than 5 s: held against each other they would be alarms of balls."""
    baselines = Baselines([point_of(made(i), f"b{i}", baseline=True) for i in range(9)])
    for seed, samples in ((100, 10_000), (101, 20_000), (102, 40_000)):
        found = assess(point_of(recorded(sound(seed)[:samples]), f"t{seed}"), baselines)
        assert found.alarms == () and found.state == "unknown"
        assert set(found.limits) == {("a0", "rms")}
    half = assess(point_of(recorded(sound(103)[:50_000]), "half"), baselines)
    assert half.alarms == () and half.state == "ok" and ("a0", "bearing1.outer") in half.limits


def test_without_kinematics_the_plain_features_are_there_and_the_reason_is_told() -> None:
    found = condition_document(made(1), None)
    features = found["channels"]["a0"]["features"]  # type: ignore[index]
    assert features["rms"] == pytest.approx(np.std(sound(1))) and "octave.63" in features
    assert found["reasons"] == [NO_KINEMATICS] and found["lines"] == []
    assert found["operating"]["speed_from"] == "stated"  # type: ignore[index]


def test_samples_with_holes_have_no_spectrum_and_stop_nothing() -> None:
    samples = sound(1)
    samples[10] = np.nan
    found = condition_document(recorded(samples), SPEC)
    features = found["channels"]["a0"]["features"]  # type: ignore[index]
    assert set(features) == {"rms", "peak", "crest_factor", "kurtosis"} and np.isfinite(features["rms"])
    assert "whole" in found["reasons"][0]  # type: ignore[index]


def test_a_shaft_that_barely_turned_is_a_reason_not_an_error() -> None:
    found = condition_document(recorded(sound(1), speed_hz=1.0), SPEC)
    assert "no lines" in found["reasons"][0]  # type: ignore[index]
