"""Memory of a dataset's shards: divided so that each fits, larger ones refused before any work."""

from __future__ import annotations

from pathlib import Path

import pytest

from jobs.datasets import accept, planning
from jobs.datasets.accept import divided
from jobs.datasets.divide import divide
from jobs.datasets.request import DatasetRequest
from jobs.errors import PlannersBusy
from jobs.limits import Limits
from sideband_datasets.plan import MOST_SHARD_BYTES
from sim.core.errors import SpecError
from tests.jobs.test_datasets import RECIPE, House
from tests.sideband_datasets.small import document


def test_default_shards_stay_below_the_bound_and_larger_ones_are_refused_before_any_work() -> None:
    windows = {"per_recording": 1000, "length_s": 1.15, "overlap": 0.95}
    wide = document(
        count=96,
        duration_s=60.0,
        sampling_rate_hz=50_000.0,
        windows=windows,
        peaks={"spectra": []},
        splits={"train": 1.0},
    )
    division = divide(DatasetRequest(recipe=wide))
    assert division.shard_bytes <= MOST_SHARD_BYTES
    assert sum(len(shard.recordings) for shard in division.shards) == 96
    with pytest.raises(SpecError) as told:
        divide(DatasetRequest(recipe=wide, shard_recordings=96))
    (problem,) = told.value.problems
    assert (problem.field, problem.given) == ("shard_recordings", 96)
    assert problem.allowed == f"{division.shard_recordings} recordings or fewer"
    with pytest.raises(SpecError) as told:
        divide(DatasetRequest(recipe={**wide, "sampling_rate_hz": 200_000.0}))
    assert [problem.field for problem in told.value.problems] == ["recipe.windows.per_recording"]


@pytest.mark.slow
def test_memory_of_a_shard_is_bounded_as_that_of_a_simulation(tmp_path: Path) -> None:
    division = divide(DatasetRequest(recipe=RECIPE, shard_recordings=3))
    needed = 2 * division.shard_bytes
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    record = House(tmp_path / "a", memory_bytes=needed).ask()
    assert record.cost.memory_bytes == needed
    with pytest.raises(SpecError) as told:
        House(tmp_path / "b", memory_bytes=needed - 1).ask()
    (problem,) = told.value.problems
    assert (problem.field, problem.given, problem.allowed) == ("shard_recordings", 3, "<= 2")


def test_what_its_numbers_put_beyond_the_bounds_is_refused_before_it_is_planned(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def never(request: DatasetRequest) -> None:
        raise AssertionError("was planned")

    monkeypatch.setattr(accept, "divide", never)
    large = DatasetRequest(recipe=document(count=200_000))
    limits = Limits(dataset_bytes=1_000_000_000)
    with pytest.raises(SpecError) as told:
        divided(large, limits)
    (problem,) = told.value.problems
    assert (problem.field, problem.given, problem.allowed) == ("recipe.count", 200_000, "<= 1e+09")
    with pytest.raises(SpecError):
        House(tmp_path, dataset_bytes=1000).ask()


def test_no_more_are_planned_at_a_time_than_may_be(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(planning, "WAIT_S", 0.01)
    with planning.planning():
        with planning.planning(), pytest.raises(PlannersBusy, match="try again in 5 s"), planning.planning():
            pass
        with planning.planning():
            pass
