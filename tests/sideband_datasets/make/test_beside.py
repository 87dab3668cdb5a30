"""Recordings beside those of the same machine without the fault."""

from __future__ import annotations

import numpy as np
import pytest

from sideband_datasets import Failure, make_plan, rows
from sideband_datasets.make.batch import side_by_side
from sideband_datasets.plan import drawing
from sideband_datasets.plan.filled import runs, sampled
from signals.background import shown_db
from tests.sideband_datasets.beside import EVERY, SPEED, siblings
from tests.sideband_datasets.small import document, tiny


@pytest.fixture(scope="module")
def every():
    return list(rows(siblings()))


def _long(**changes):
    return siblings(windows={}, **changes)


@pytest.mark.slow
@pytest.mark.parametrize("indices", [[5], [47, 0, 13], [6, 6, 30]])
def test_a_row_is_the_same_bytes_alone_and_beside_others(every, indices, monkeypatch):
    monkeypatch.setattr("sideband_datasets.make.stream.batch_size", lambda plan: 2)
    found = list(rows(siblings(), indices))
    assert [row.row for row in found] == indices
    assert all(row.signal.tobytes() == every[row.row].signal.tobytes() for row in found)


@pytest.mark.slow
def test_faulty_ones_fill_the_lanes_that_few_machines_leave(monkeypatch):
    """With waves on a race a sound bearing has the structure of one with a race's spall, not of one with a ball's."""
    vary = {"operating.speed_hz": SPEED, "outer_waviness@bearing1.amplitude": {"low": 1e-8, "high": 1e-7}}
    machines = [{"name": "rotor", "preset": "rotor", "instances": 2, "vary": vary}]
    faults = [{"name": n, "terms": [{"term": f"{n}_spall", "sites": ["bearing1"]}]} for n in ("outer", "ball")]
    recipe = _long(count=6, machines=machines, faults=faults)
    filled: list[int] = []

    def counted(plan, group, cancelled):
        filled.append(len(group))
        return side_by_side(plan, group, cancelled)

    monkeypatch.setattr("sideband_datasets.make.beside.side_by_side", counted)
    found = {row.row: row.signal.tobytes() for row in rows(recipe)}
    assert filled == [4, 2]
    plan = make_plan(recipe)
    assert [lanes for _, lanes in runs(plan, sampled(plan), range(6))] == [4, 2]
    for number in range(6):
        assert all(row.signal.tobytes() == found[row.row] for row in rows(recipe, [2 * number, 2 * number + 1]))


@pytest.mark.slow
def test_siblings_are_one_machine_in_every_class_with_one_noise(every):
    for first in range(0, len(every), 12):
        own = every[first : first + 12]
        assert [row.fault_type for row in own[::4]] == ["healthy", "outer", "ball"]
        assert len({(row.machine_id, row.seed, row.speed_hz) for row in own}) == 1
        assert own[0].start_s == own[4].start_s == own[8].start_s


@pytest.mark.slow
def test_without_a_background_the_rows_are_those_of_the_plain_way():
    """The way beside the sound machine changes nothing by itself, where nothing is hidden."""
    plain = [row.signal for row in rows(_long(background=None))]
    beside = [row.signal for row in rows(_long(background=None, shown_db=-100.0))]
    assert len(plain) == len(beside) == 24
    assert all(np.array_equal(*pair) for pair in zip(plain, beside, strict=True))


@pytest.mark.slow
def test_the_background_is_the_same_in_siblings_and_no_fault_changes_its_level():
    quiet = [row.signal.astype(float) for row in rows(_long(background=None), [0, 2])]
    loud = [row.signal.astype(float) for row in rows(_long(background={**EVERY, "free_axis": None}), [0, 2])]
    ground = [one - other for one, other in zip(loud, quiet, strict=True)]
    assert np.std(ground[0]) > 0.1 * np.std(quiet[0])
    np.testing.assert_allclose(ground[0], ground[1], atol=2e-2 * np.std(ground[0]))


@pytest.mark.slow
def test_level_is_a_multiple_of_the_sound_machines_motion():
    """Ten times the level: ten times the background."""
    bare, one, ten = (
        next(rows(_long(background=block), [0])).signal.astype(float)
        for block in (None, {"level": 1.0, "rolling": {"level": 0.5}}, {"level": 10.0, "rolling": {"level": 0.5}})
    )
    np.testing.assert_allclose(ten - bare, 10 * (one - bare), atol=0.02 * np.std(ten))


@pytest.mark.slow
def test_a_free_axis_changes_a_balls_recording_and_no_other():
    with_axis = list(rows(_long(background={"free_axis": {}}), range(6)))
    without = list(rows(_long(background={}), range(6)))
    changed = {a.fault_type for a, b in zip(with_axis, without, strict=True) if not np.array_equal(a.signal, b.signal)}
    assert changed == {"ball"}


@pytest.mark.slow
def test_hidden_faults_are_listed_and_the_others_show():
    told: list[Failure] = []
    recipe = _long(shown_db=0.0)
    found = list(rows(recipe, failed=told.append))
    assert {failure.kind for failure in told} == {"NotShown"}
    assert {failure.fault_type for failure in told} <= {"outer", "ball"}
    assert len(found) + 2 * len(told) == 24
    sound = {row.machine_id: row.signal for row in found if row.fault_type == "healthy" and row.channel == "de"}
    other = {row.machine_id: row.signal for row in found if row.fault_type == "healthy" and row.channel == "nde"}
    shown: dict[str, list[float]] = {}
    for row in found:
        if row.fault_type != "healthy":
            beside = sound if row.channel == "de" else other
            shown.setdefault(row.recording_id, []).append(shown_db(beside[row.machine_id], row.signal))
    assert all(max(values) > -0.01 for values in shown.values())


@pytest.mark.slow
def test_without_siblings_each_recording_has_its_own_noise_and_operating_point():
    recipe = tiny(background={"rolling": {}}, shown_db=-90.0, peaks={"spectra": []})
    plan = make_plan(recipe)
    seeds = {drawing(plan, number).noise_seed for number in range(recipe.count)}
    assert len(seeds) == recipe.count
    assert len({row.speed_hz for row in rows(recipe, range(0, 48, 4))}) == 12


@pytest.mark.slow
def test_a_chain_in_levels_follows_the_machine():
    """Noise of a tenth of the level, whatever the machine moves by."""
    found = document()["measurement"][0]["chain"]
    quiet = {"kind": "accelerometer", "name": "de", "place": {"location": "bearing1.outer"}}
    noisy = {**quiet, "noise": {"density_per_sqrt_hz": 10.0 / np.sqrt(4000.0), "corner_hz": 0.0}}
    signals = []
    for channel in (quiet, noisy):
        chain = [{"name": "stud", "chain": {**found, "channels": [channel]}}]
        recipe = _long(background={"level": 1.0, "chain_in_levels": True}, measurement=chain)
        signals.append([row.signal.astype(float) for row in rows(recipe, [0, 3])])
    noise = [np.std(b - a) for a, b in zip(*signals, strict=True)]
    # At a sensor of the two bearings, the machine's level is of the order of what the sensor hears.
    assert all(3 < n / np.std(a) < 40 for n, a in zip(noise, signals[0], strict=True))


def test_a_machine_that_stands_still_is_listed():
    told: list[Failure] = []
    recipe = _long(background={"level": 0.0, "rolling": {}})
    assert not list(rows(recipe, [0], failed=told.append))
    assert [failure.kind for failure in told] == ["StandsStill"]
