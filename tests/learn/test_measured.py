"""A channel that measured nothing does not answer; what is not finite is refused with its place."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from learn.classify import classify
from learn.measured import measured
from learn.model import default_model
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.response import Channel

N = 8000


def recording(*rows: FloatArray) -> Recording:
    return Recording(
        sampling_rate_hz=4000.0,
        channels=tuple(
            Channel(name=f"c{i}", quantity="acceleration", unit="m/s^2", location="", axis="") for i in range(len(rows))
        ),
        samples=np.stack(rows),
        operating=Operating(shaft="a", speed_hz=25.0),
        start_s=1.0,
    )


def noise() -> FloatArray:
    return np.random.default_rng(1).standard_normal(N)


def alive() -> FloatArray:
    return noise() + np.sin(2 * np.pi * 75.0 * np.arange(N) / 4000.0)


def spike() -> FloatArray:
    return np.where(np.arange(N) == 3000, 1.0, 0.0)


def step() -> FloatArray:
    return np.where(np.arange(N) < N // 2, 0.0, 1.0)


def dropout() -> FloatArray:
    return np.where(np.arange(N) < N // 2, noise(), 0.0)


def biased_dropout() -> FloatArray:
    return np.where(np.arange(N) < N // 2, noise() + 12.0, 0.0)


DEAD = [spike, step, dropout, biased_dropout, lambda: np.full(N, 2.0)]


@pytest.mark.parametrize("dead", DEAD)
def test_where_nothing_was_measured_is_refused(dead) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(SpecError) as refused:
        measured(recording(dead()))
    (problem,) = refused.value.problems
    assert problem.field == "channels.c0" and ("constant" in problem.message or " s" in problem.message)


@pytest.mark.parametrize("dead", DEAD)
def test_a_dead_channel_is_left_out_where_another_lives(dead) -> None:  # type: ignore[no-untyped-def]
    found = measured(recording(dead(), alive()))
    assert found.recording.names == ("c1",) and found.left_out == ("c0",)
    assert all(f["channel"] == "c0" and f["left_out"] for f in found.faults())
    assert found.remarks() and all("left out of the answer" in remark for remark in found.remarks())


def test_clipped_channels_and_short_dropouts_stay() -> None:
    short = noise()
    short[100:400] = 0.0
    found = measured(recording(np.clip(np.sin(np.arange(N) / 40), -0.5, 0.5), short))
    assert found.recording.names == ("c0", "c1") and not found.left_out
    assert found.faults() == [
        {"channel": "c0", "kind": "clipping", "left_out": False},
        {"channel": "c1", "kind": "dropout", "left_out": False},
    ]


def test_samples_that_are_not_finite_are_refused_with_number_and_place() -> None:
    broken = noise()
    broken[[400, 500]] = np.nan, np.inf
    with pytest.raises(SpecError) as refused:
        measured(recording(noise(), broken))
    (problem,) = refused.value.problems
    assert problem.field == "channels.c1" and "2 samples" in problem.message
    assert "sample 400 (t = 1.1 s)" in problem.message and "leave the channel out" in problem.allowed


@pytest.mark.slow
def test_the_answer_lists_what_is_wrong_with_the_measurement() -> None:
    assert classify(recording(alive()), default_model(), trust_speed=True)["measurement_faults"] == []
    found = classify(recording(alive(), spike()), default_model(), trust_speed=True)
    assert found["channels"] == ["c0"]
    assert found["measurement_faults"] == [{"channel": "c1", "kind": "dropout", "left_out": True}]
    assert any(remark.startswith("c1: dropout") for remark in found["remarks"])


def test_a_channel_far_below_its_neighbours_is_left_out_and_said() -> None:
    found = measured(recording(noise(), 1e-4 * noise()[::-1]))
    assert found.left_out == ("c1",) and "silent" in [f["kind"] for f in found.faults() if f["channel"] == "c1"]
    assert "80 dB below the loudest channel" in found.remarks()[0]
    assert measured(recording(noise(), 0.01 * noise()[::-1])).left_out == ()
    other = recording(noise(), 1e-4 * noise()[::-1])
    units = (other.channels[0], replace(other.channels[1], quantity="velocity", unit="m/s"))
    assert measured(replace(other, channels=units)).left_out == ()
    assert measured(recording(1e-4 * noise())).left_out == ()
