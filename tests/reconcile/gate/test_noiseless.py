"""Simulations sent as they came are told and given a floor; faults of sensors are found in them all the same."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import butter, sosfiltfilt

from reconcile.gate import inspect_measurement
from reconcile.gate.noiseless import ADDED_DB, MOST_DB, NONE_DB, floor_db, noiseless, with_floor
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate

RATE_HZ = 8192.0
N = 30_000
LINES_HZ = (131.0, 713.0, 1426.0, 2139.0)


def lines(size: int = N) -> np.ndarray:
    t = np.arange(size) / RATE_HZ
    return np.sum([np.sin(2 * np.pi * hz * t + hz) for hz in LINES_HZ], axis=0)


def recording(*rows: np.ndarray) -> Recording:
    channels = tuple(
        Channel(name=f"a{c}", quantity="acceleration", unit="m/s^2", location="bearing1") for c in range(len(rows))
    )
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows))


def noise(db: float, seed: int = 1, size: int = N) -> np.ndarray:
    return 10 ** (db / 20) * np.std(lines(size)) * np.random.default_rng(seed).standard_normal(size)


def rounded(samples: np.ndarray, bits: int) -> np.ndarray:
    step = 4 * np.std(samples) / 2 ** (bits - 1)
    return np.round(samples / step) * step


@pytest.mark.parametrize("db", [-20.0, -40.0, -60.0])
def test_a_floor_is_measured_between_the_lines(db: float) -> None:
    assert floor_db(lines() + noise(db)) == pytest.approx(db, abs=1.5)


@given(db=st.floats(-60.0, 10.0), seed=st.integers(0, 99))
def test_what_has_noise_is_not_told(db: float, seed: int) -> None:
    assert not noiseless([recording(lines() + noise(db, seed))], ["test 1"])


@pytest.mark.parametrize("bits", [16, 24])
@pytest.mark.parametrize("corner", [0.05, 0.1, 0.3])
def test_a_low_pass_is_no_lack_of_noise(corner: float, bits: int) -> None:
    heard = sosfiltfilt(butter(4, corner, output="sos"), lines() + noise(-40.0))
    assert not noiseless([recording(rounded(heard, bits))], ["test 1"])


@pytest.mark.parametrize("times", [1, 2])
def test_nor_is_an_integrated_acceleration(times: int) -> None:
    heard = lines() + noise(-40.0)
    for _ in range(times):
        heard = np.cumsum(heard - np.mean(heard)) / RATE_HZ
    assert not noiseless([recording(heard)], ["test 1"])


@pytest.mark.parametrize("size", [4, 64, 100])
def test_a_handful_of_samples_has_no_floor(size: int) -> None:
    assert floor_db(lines(size)) == 0.0


def test_a_channel_without_noise_gets_the_same_level_at_one_speed_and_noise_of_its_own() -> None:
    heard = lines() + noise(-40.0)
    several = [recording(lines(), heard), recording(0.1 * lines(), heard), recording(30.0 * lines(), heard)]
    (remark,) = noiseless(several, ["baseline 1", "test 1", "test 2"])
    assert remark.channel == "a0" and not remark.fault and "simulation" in remark.detail
    noisy = with_floor(several, [30.0, 30.1, 60.0], {"a0"})
    added = [b.samples - a.samples for a, b in zip(several, noisy, strict=True)]
    expected = 10 ** (ADDED_DB / 20) * np.std(lines())
    assert [np.std(a[0]) for a in added] == pytest.approx([expected, expected, 30.0 * expected], rel=0.05)
    assert all(np.array_equal(a[1], np.zeros(N)) for a in added)
    assert abs(np.corrcoef(added[0][0], added[1][0])[0, 1]) < 0.1
    assert floor_db(noisy[0].samples[0]) > NONE_DB


def test_a_damaged_part_a_thousand_times_as_loud_does_not_take_the_noise_away() -> None:
    """Its floor is as high as the baseline's; without noise it would be far below."""
    baseline = recording(1e-3 * (lines() + noise(-20.0)))
    struck = recording(lines() + 1e-3 * noise(-20.0, 3))
    assert floor_db(struck.samples[0]) < NONE_DB
    assert not noiseless([baseline, struck], ["baseline 1", "test 1"])
    (remark,) = noiseless([baseline, recording(1e-3 * lines())], ["baseline 1", "test 1"])
    assert remark.recording == "test 1"


def test_the_noise_that_is_added_leaves_the_quietest_recording_heard() -> None:
    quiet, loud = recording(1e-3 * lines()), recording(lines())
    noisy = with_floor([quiet, loud, recording(np.zeros(N))], [30.0, 30.0, 30.0], {"a0"})
    for before, after in zip((quiet, loud), noisy, strict=False):
        added = after.samples - before.samples
        assert np.std(added) == pytest.approx(10 ** (MOST_DB / 20) * np.std(quiet.samples), rel=0.05)


def test_the_noise_does_not_depend_on_what_else_is_sent_or_in_which_order() -> None:
    one, other = recording(lines(), 2 * lines()), recording(lines() + 1e-3 * lines() ** 2, lines())
    first, second = with_floor([one, other], [30.0, 30.0], {"a0"})
    again = with_floor([other, one], [30.0, 30.0], {"a0"})
    assert np.array_equal(first.samples, again[1].samples) and np.array_equal(second.samples, again[0].samples)


def test_one_knock_is_no_level() -> None:
    knocked = lines()
    knocked[5000:5010] += 1e4
    (quiet,) = with_floor([recording(knocked)], [30.0], {"a0"})
    assert np.std(quiet.samples - knocked) < 2 * 10 ** (ADDED_DB / 20) * np.std(lines())


@cache
def moved(gap_m: float, speed_hz: float) -> np.ndarray:
    """Accelerations at three bearings of the paper's machine, 1 s without noise; a gap of zero: held."""
    machine = preset("paper-lightly-damped")
    assert machine.operating is not None
    loose = [TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": gap_m})] if gap_m else []
    operating = machine.operating.model_copy(update={"speed_hz": speed_hz})
    turning = machine.model_copy(update={"terms": [*machine.terms, *loose], "operating": operating})
    names = [f"resonator{b}.y.acceleration" for b in (1, 2, 3)]
    response = simulate(turning, duration_s=1.2, output_rate_hz=30_000.0, channels=names)
    return np.asarray(response.signals)[:, 6000:]


def sent(rows: np.ndarray, speed_hz: float) -> Recording:
    channels = tuple(
        Channel(name=f"a{b}", quantity="acceleration", unit="m/s^2", location=f"bearing{b}", axis="y")
        for b in (1, 2, 3)
    )
    operating = Operating(shaft="input", speed_hz=speed_hz)
    return Recording(sampling_rate_hz=30_000.0, channels=channels, samples=rows, operating=operating)


def gate_of(gap_m: float, spoil: Callable[[np.ndarray], np.ndarray] = np.copy):  # type: ignore[no-untyped-def]
    speeds = (22.5, 30.0, 39.0)
    bases = [sent(moved(0.0, hz), hz) for hz in speeds]
    tests = [sent(spoil(moved(gap_m, hz)), hz) for hz in speeds]
    return inspect_measurement(bases, tests, orders=(23.0,), mesh_orders=(23.0,), lowest_order=0.28)


@pytest.mark.slow
def test_the_paper_s_clearance_is_no_fault_of_a_sensor() -> None:
    """What folds at the simulator's filter was an alias beside it, and alone at 30 Hz it was a loose sensor."""
    gate = gate_of(2e-5)
    assert gate.fault is None
    assert {f.channel for f in gate.findings if f.kind == "noiseless"} == {"a1", "a2", "a3"}
    assert all(floor_db(row) > NONE_DB for r in (*gate.baselines, *gate.tests) for row in r.samples)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("factor", "kind"),
    [(0.5, "gain_change"), (3.0, "gain_change"), (1 / 9.80665, "unit_mismatch"), (1e-3, "unit_mismatch")],
)
def test_gains_and_units_are_found_without_noise_and_undone(factor: float, kind: str) -> None:
    gate = gate_of(0.0, lambda rows: rows * np.array([[1.0], [1.0], [factor]]))
    assert gate.fault is not None and (gate.fault.kind, gate.fault.channel) == (kind, "a3")
    for before, now in zip(gate.baselines, gate.tests, strict=True):
        assert np.std(now.samples[2]) == pytest.approx(np.std(before.samples[2]), rel=0.02)


def test_stuck_samples_are_seen() -> None:
    held = lines()
    held[3000:5000] = held[3000]
    gate = inspect_measurement([recording(lines())], [recording(held)])
    assert any(f.kind == "stuck" and f.recording == "test 1" for f in gate.findings)


def test_a_recording_with_noise_goes_through_untouched() -> None:
    one = recording(lines() + noise(-40.0))
    gate = inspect_measurement([one], [replace(one, samples=one.samples + 1e-3 * noise(-40.0, 7))])
    assert np.array_equal(gate.baselines[0].samples, one.samples)
