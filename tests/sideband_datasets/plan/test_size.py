"""How large a recording's rows and a shard may be."""

from __future__ import annotations

import pytest

from sideband_datasets.plan import MOST_SHARD_BYTES, check_shard, make_plan, most_recordings, recording_bytes
from sideband_datasets.plan.size import BYTES_PER_ROW, batch_size, check_recording
from sim.core.errors import SpecError
from tests.sideband_datasets.small import tiny

OVERLAPPING = {"per_recording": 1000, "length_s": 1.15, "overlap": 0.95}
LARGE = tiny(duration_s=60.0, sampling_rate_hz=50_000.0, windows=OVERLAPPING)


def test_bytes_are_those_of_the_samples_and_the_columns() -> None:
    plan = make_plan(tiny())
    assert recording_bytes(plan) == 4 * (4 * 320 + BYTES_PER_ROW)
    whole = make_plan(tiny(windows={"per_recording": 4}))
    assert recording_bytes(whole) == 2 * 4 * 800 + 8 * BYTES_PER_ROW, "windows share the recording"


def test_windows_that_count_revolutions_are_taken_at_the_slowest_speed_and_fit_the_recording() -> None:
    turns = make_plan(tiny(windows={"length_revolutions": 1}))
    assert recording_bytes(turns) == 2 * (4 * 320 + BYTES_PER_ROW)
    unknown = make_plan(tiny(windows={"length_revolutions": 1}, speeds_hz=None))
    assert recording_bytes(unknown) == 2 * (4 * 800 + BYTES_PER_ROW)


def test_large_recordings_are_worked_on_by_as_many_as_a_shard_may_hold() -> None:
    plan = make_plan(LARGE)
    fit = most_recordings(plan)
    assert fit * recording_bytes(plan) <= MOST_SHARD_BYTES < (fit + 1) * recording_bytes(plan)
    assert batch_size(plan) == fit < 8
    assert batch_size(make_plan(tiny())) == 256


def test_a_shard_beyond_the_bound_is_refused_with_what_fits() -> None:
    plan = make_plan(LARGE)
    check_shard(plan, most_recordings(plan), "shard_recordings", 2)
    with pytest.raises(SpecError) as told:
        check_shard(plan, most_recordings(plan) + 1, "shard_recordings", 50)
    (problem,) = told.value.problems
    assert (problem.field, problem.given) == ("shard_recordings", 50)
    assert problem.allowed == f"{most_recordings(plan)} recordings or fewer"


def test_a_recording_beyond_the_bound_is_refused() -> None:
    check_recording(make_plan(LARGE))
    with pytest.raises(SpecError) as told:
        check_recording(make_plan(LARGE.model_copy(update={"sampling_rate_hz": 200_000.0})))
    (problem,) = told.value.problems
    assert problem.field == "windows.per_recording"
    assert str(MOST_SHARD_BYTES) in problem.allowed
    assert isinstance(problem.given, int) and problem.given > MOST_SHARD_BYTES
