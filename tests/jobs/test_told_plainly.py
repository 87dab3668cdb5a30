"""Refusals and failures name the place that is wrong, once, with readable numbers."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from jobs.request import SimulationRequest
from jobs.run import failure_of
from jobs.sensing import _open_filters
from jobs.slices import window
from signals.sensors import SensorChain
from sim.core.errors import Diverged, SpecError


def reader(samples: int = 20_000, rate: float = 20_000.0):
    return SimpleNamespace(manifest=SimpleNamespace(sampling_rate_hz=rate, samples=samples))


@pytest.mark.parametrize(
    ("start_s", "end_s", "field", "given"),
    [(5.0, None, "start_s", 5.0), (5.0, 6.0, "start_s", 5.0), (0.5, 0.2, "end_s", 0.2), (None, 0.0, "end_s", 0.0)],
)
def test_an_empty_stretch_names_the_bound_that_is_wrong(start_s, end_s, field, given):
    with pytest.raises(SpecError) as caught:
        window(reader(), start_s, end_s)
    (problem,) = caught.value.problems
    assert (problem.field, problem.given, problem.unit) == (field, given, "s")


def test_a_divergence_gives_its_advice_once_and_a_round_time():
    error = Diverged(time_s=0.060000000000000005, dof="input.theta", advice="look there")
    failure = failure_of(error, ())
    assert "look there" not in failure.message and failure.advice == "look there"
    assert failure.detail["time_s"] == 0.06
    assert "look there" in str(error)


@pytest.mark.parametrize(("cutoff_hz", "count"), [(1e6, 1), (12_800.0, 1), (10_000.0, 0)])
def test_a_filter_above_half_the_clock_is_told(cutoff_hz, count):
    channel = {
        "kind": "accelerometer",
        "name": "a",
        "place": {"location": "bearing1"},
        "anti_alias": {"cutoff_hz": cutoff_hz},
    }
    chain = SensorChain.model_validate({"clock": {"sampling_rate_hz": 25_600.0}, "channels": [channel]})
    assert len(_open_filters(chain)) == count


def test_the_length_of_a_run_has_one_limit_which_is_the_servers():
    assert SimulationRequest(preset="paper", duration_s=1e6).duration_s == 1e6
