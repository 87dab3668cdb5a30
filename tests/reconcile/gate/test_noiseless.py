"""Simulations sent as they came are told and given a floor; what has noise, or a low pass, is left as it is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import butter, sosfiltfilt

from reconcile.gate import inspect_measurement
from reconcile.gate.noiseless import ADDED_DB, NONE_DB, floor_db, with_floor
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import TermSpec
from sim.presets import preset
from sim.solve.api import simulate

RATE_HZ = 8192.0
N = 12_000
LINES_HZ = (31.0, 713.0, 1426.0, 2139.0)


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


@pytest.mark.parametrize("db", [-20.0, -40.0, -60.0])
def test_a_floor_is_measured_between_the_lines(db: float) -> None:
    assert floor_db(lines() + noise(db)) == pytest.approx(db, abs=1.5)


@given(db=st.floats(-60.0, 10.0), seed=st.integers(0, 99))
def test_what_has_noise_stays_as_it_is(db: float, seed: int) -> None:
    one = recording(lines() + noise(db, seed))
    (same,), found = with_floor([one], ["test 1"], 0)
    assert same is one and not found


def test_a_low_pass_is_no_lack_of_noise() -> None:
    heard = sosfiltfilt(butter(8, 0.3, output="sos"), lines() + noise(-40.0))
    assert not with_floor([recording(heard)], ["test 1"], 0)[1]


@pytest.mark.parametrize("size", [4, 64, 100])
def test_a_handful_of_samples_has_no_floor(size: int) -> None:
    assert floor_db(lines(size)) == 0.0


def test_a_channel_without_noise_gets_the_same_floor_in_every_recording() -> None:
    heard = lines() + noise(-40.0)
    several = [recording(lines(), heard), recording(0.1 * lines(), heard)]
    noisy, found = with_floor(several, ["baseline 1", "test 1"], 0)
    assert {(f.kind, f.channel, f.recording) for f in found} == {
        ("noiseless", "a0", "baseline 1"),
        ("noiseless", "a0", "test 1"),
    }
    assert not any(f.fault for f in found) and "simulation" in found[0].detail
    added = [np.std(b.samples - a.samples, axis=1) for a, b in zip(several, noisy, strict=True)]
    expected = 10 ** (ADDED_DB / 20) * np.std(lines())
    assert [a[0] for a in added] == pytest.approx([expected] * 2, rel=0.05)
    assert [a[1] for a in added] == [0.0, 0.0]
    assert floor_db(noisy[0].samples[0]) > NONE_DB
    again, _ = with_floor(several, ["baseline 1", "test 1"], 0)
    assert all(np.array_equal(a.samples, b.samples) for a, b in zip(noisy, again, strict=True))


@pytest.mark.slow
def test_simulations_of_the_paper_s_clearance_are_no_sensor_fault() -> None:
    """Without a floor the gate took what folds at the simulator's filter for an alias, and a ring that lost its hold
    for a loose sensor."""
    machine = preset("paper-lightly-damped")
    names = [f"resonator{b}.y.acceleration" for b in (1, 2, 3)]
    loose = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 2e-5})
    sound, changed = (
        simulate(m, duration_s=1.2, output_rate_hz=30_000.0, channels=names)
        for m in (machine, machine.model_copy(update={"terms": [*machine.terms, loose]}))
    )

    def sent(signals: np.ndarray) -> Recording:
        channels = tuple(
            Channel(name=f"a{b}", quantity="acceleration", unit="m/s^2", location=f"bearing{b}", axis="y")
            for b in (1, 2, 3)
        )
        rows = np.asarray(signals)[:, 6000:]
        operating = Operating(shaft="input", speed_hz=30.0)
        return Recording(sampling_rate_hz=30_000.0, channels=channels, samples=rows, operating=operating)

    gate = inspect_measurement(
        [sent(sound.signals)], [sent(changed.signals)], orders=(23.0,), mesh_orders=(23.0,), lowest_order=0.28
    )
    assert gate.fault is None
    assert {"noiseless"} <= {f.kind for f in gate.findings}


def test_stuck_samples_are_seen_before_noise_hides_them() -> None:
    held = lines()
    held[3000:5000] = held[3000]
    gate = inspect_measurement([recording(lines())], [recording(held)])
    assert any(f.kind == "stuck" and f.recording == "test 1" for f in gate.findings)
    assert replace(gate, findings=()).usable
