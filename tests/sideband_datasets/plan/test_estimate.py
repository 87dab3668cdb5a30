"""What a dataset is expected to take follows the lanes that its shards fill."""

from __future__ import annotations

import pytest

from sideband_datasets.plan import Plan, drawing, estimate, make_plan
from sideband_datasets.plan.filled import runs, sampled
from sideband_datasets.plan.size import BYTES_PER_ROW
from sideband_datasets.recipe.read import document_of, read_recipe
from sideband_datasets.recipe.ready import recipe_named
from tests.sideband_datasets.small import tiny


def of(name: str, **changes: object) -> Plan:
    return make_plan(read_recipe({**document_of(recipe_named(name)), **changes}))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "count", "shard", "measured_s"),
    [("small", 16, None, 9.2), ("gearbox", 24, None, 25.1), ("overhung", 24, None, 31.8), ("bearing-rig", 32, 8, 56.1)],
)
def test_processor_time_where_lanes_are_not_full(name: str, count: int, shard: int | None, measured_s: float):
    """User and system seconds of `make` with two workers."""
    found = estimate(of(name, count=count), 2, shard).core_seconds
    assert measured_s / 1.5 < found < 1.5 * measured_s


def test_small_shards_leave_lanes_empty():
    plan = make_plan(tiny(count=48, duration_s=1.0, peaks={"spectra": []}))
    whole, small = (estimate(plan, 1, size) for size in (48, 2))
    assert small.core_seconds > 1.5 * whole.core_seconds
    assert (small.rows, small.bytes) == (whole.rows, whole.bytes)


def test_runs_hold_recordings_of_one_structure():
    """A sound class and one fault that may sit at two bearings: three structures."""
    plan = make_plan(tiny(count=48))
    samples = sampled(plan)
    found = list(runs(plan, samples, range(48)))
    assert sum(filled for _, filled in found) == 48 and max(filled for _, filled in found) == 8
    structures = {sample.structure for sample in samples.found}
    assert 48 / 8 <= len(found) <= 48 / 8 + len(structures) - 1
    assert len(list(runs(plan, samples, [0]))) == 1


def test_workers_share_shards_and_each_starts():
    plan = make_plan(tiny(count=48))
    one, two, many = (estimate(plan, workers, 6) for workers in (1, 2, 100))
    assert one.core_seconds < two.core_seconds < many.core_seconds
    assert many.core_seconds == estimate(plan, 1000, 6).core_seconds, "no more processes than shards"
    assert one.wall_s == pytest.approx(one.core_seconds)


def test_with_background_a_machine_is_simulated_without_its_fault_too():
    plain, beside = (make_plan(tiny(count=48, **more)) for more in ({}, {"shown_db": -5}))
    lanes = [sum(filled for _, filled in runs(p, sampled(p), range(48))) for p in (plain, beside)]
    assert lanes == [48, 48 + int((plain.kind > 0).sum())]


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["factorial", "sobol"])
def test_size_follows_the_speeds_of_the_plan_where_windows_count_revolutions(kind: str):
    speeds = {"low": 20, "high": 80}
    windows = {"per_recording": 1, "length_revolutions": 40}
    plan = make_plan(
        tiny(count=36, plan=kind, speeds_hz=speeds, windows=windows, duration_s=2.0, sampling_rate_hz=20000)
    )
    own = [40 / drawing(plan, number).spec.operating.speed_hz for number in range(36)]
    samples = sum(own) * plan.rows_per_recording * 20000
    assert estimate(plan, 1).bytes == pytest.approx(4 * samples + BYTES_PER_ROW * plan.rows, rel=1e-6)
