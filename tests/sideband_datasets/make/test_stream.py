from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from sideband_datasets import COLUMNS, Row, make_plan, rows
from sideband_datasets.make import batch
from sideband_datasets.plan import drawing
from signals.sensors import measure, motion_of
from sim.core.errors import Diverged, SpecError
from sim.solve.api import simulate
from tests.sideband_datasets.small import tiny

RECIPE = tiny(peaks={"spectra": ["amplitude", "envelope"]}, sampling_rate_hz=10_000)


@pytest.fixture(scope="module")
def every():
    return list(rows(RECIPE))


def _same(one: Row, other: Row) -> bool:
    if one.signal.tobytes() != other.signal.tobytes():
        return False
    return repr(dataclasses.replace(one, signal=other.signal)) == repr(other)


def test_columns_are_the_fields_in_order():
    assert [c.name for c in COLUMNS] == [f.name for f in dataclasses.fields(Row)]


@pytest.mark.slow
def test_every_row_comes_once_in_order(every):
    assert [row.row for row in every] == list(range(48))
    assert len({row.signal_id for row in every}) == 48


@pytest.mark.slow
@pytest.mark.parametrize("indices", [[5], [47, 0, 13, 12], [2, 2], list(range(20, 30))])
def test_a_row_is_the_same_bytes_alone_in_any_order_and_batch(every, indices, monkeypatch):
    monkeypatch.setattr("sideband_datasets.make.stream.batch_size", lambda plan: 3)
    found = list(rows(RECIPE, indices))
    assert [row.row for row in found] == indices
    assert all(_same(row, every[row.row]) for row in found)


@pytest.mark.slow
def test_a_row_is_the_window_of_what_its_sensors_record(every):
    plan = make_plan(RECIPE)
    row = every[3 * 4 + 2]
    drawn = drawing(plan, 3)
    outputs = ("bearing1.outer.y.acceleration", "bearing2.outer.y.acceleration")
    response = simulate(drawn.spec, duration_s=0.15, output_rate_hz=10_000, channels=outputs, seed=drawn.seed)
    seen = measure(motion_of(response), drawn.chain, seed=drawn.noise_seed).recording
    first = round(row.start_s * 10_000)
    expected = seen.samples[0, first : first + row.samples]
    assert row.window == 1
    assert row.channel == "de"
    assert np.allclose(row.signal, expected, rtol=0, atol=1e-4 * np.abs(expected).max())


@pytest.mark.slow
def test_rows_say_what_was_simulated(every):
    plan = make_plan(RECIPE)
    for row in every:
        drawn = drawing(plan, row.recording)
        bearing = next(b for b in drawn.spec.bearings if b.name == row.bearing_id)
        geometry = bearing.geometry
        ratio = geometry.ball_diameter_m / geometry.pitch_diameter_m
        assert row.speed_hz == drawn.spec.operating.speed_hz
        assert row.ftf_hz == pytest.approx(0.5 * row.speed_hz * (1 - ratio))
        assert row.bpfo_hz == pytest.approx(geometry.balls * row.ftf_hz)
        assert row.bpfi_hz == pytest.approx(geometry.balls * (row.speed_hz - row.ftf_hz))
        assert row.labels == tuple(effect.label for effect in drawn.effects)
        assert row.fault_origin == "simulated"
        assert (row.fault_location is None) == (row.fault_type == "healthy")
        assert row.signal.dtype == np.float32
        assert row.rms == pytest.approx(float(np.sqrt(np.mean(row.signal.astype(float) ** 2))))
        if row.labels:
            assert row.bearing_id == row.fault_location


@pytest.mark.slow
def test_faulty_rows_carry_the_lines_of_their_fault(every):
    faulty = [row for row in every if row.fault_type == "outer"]
    healthy = [row for row in every if row.fault_type == "healthy"]
    assert all(any("f_o" in peak.label for peak in row.peaks) for row in faulty)
    assert all(p.status in ("present", "ambiguous") for row in healthy for p in row.peaks)


@pytest.mark.slow
def test_windows_of_revolutions_follow_the_speed():
    recipe = tiny(windows={"length_revolutions": 2}, peaks={"spectra": []}, count=6)
    for row in rows(recipe):
        assert row.samples == round(2 / row.speed_hz * row.sampling_rate_hz)
        assert row.start_s >= 0.05 - 1e-9
        assert row.start_s + row.samples / row.sampling_rate_hz <= 0.15 + 1e-9


@pytest.mark.slow
def test_a_recording_that_fails_is_told_and_the_others_stay(monkeypatch):
    recipe = tiny(peaks={"spectra": []}, count=6)
    whole = list(rows(recipe))

    def broken(members, **settings):
        found = solved(members, **settings)
        return [
            Diverged(time_s=0.1, dof="disc.x", advice="none") if m.seed == bad else r
            for m, r in zip(members, found, strict=True)
        ]

    plan = make_plan(recipe)
    bad = drawing(plan, 2).seed
    solved = batch.simulate_many
    monkeypatch.setattr(batch, "simulate_many", broken)
    failures: list[object] = []
    left = list(rows(recipe, failed=failures.append))
    gone = {i for failure in failures for i in failure.rows}
    assert 2 in {failure.recording for failure in failures}
    assert all(failure.kind == "Diverged" for failure in failures)
    assert {row.row for row in left} == set(range(24)) - gone
    assert all(_same(row, whole[row.row]) for row in left)


def test_rows_beyond_the_dataset_are_refused():
    with pytest.raises(SpecError, match="0 to 47"):
        rows(RECIPE, [48])


@pytest.mark.slow
def test_speed_and_frequencies_of_a_row_are_those_of_its_window():
    recipe = tiny(count=2, faults=[], peaks={"spectra": []}, splits={"train": 1.0}, speeds_hz=None)
    (rotor,) = recipe.model_dump(mode="json", exclude_none=True)["machines"]
    ramp = {"profile": {"kind": "ramp", "end_ratio": 2.0, "duration_s": 0.15}}
    moving = tiny(**{**recipe.model_dump(mode="json", exclude_none=True), "machines": [{**rotor, "set": ramp}]})
    found = [row for row in rows(moving) if row.bpfo_hz and row.speed_hz]
    assert len({row.speed_hz for row in found}) > 2, "the speed rises from window to window"
    held = next(iter(rows(recipe)))
    assert held.bpfo_hz and held.speed_hz
    for row in found:
        assert row.bpfo_hz and row.speed_hz
        assert row.bpfo_hz / row.speed_hz == pytest.approx(held.bpfo_hz / held.speed_hz, rel=1e-9)
