"""Two sensors of a made motor with a baseline: what a defect does to a sensor's bands is no loose sensor, exchanged
sensors are told beside it, and what is cut off makes no impacts once a turn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate.findings import Finding, Gate
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.struck import cut_alike
from reconcile.report.action import LOUDEST
from reconcile.verdict import Report
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.response import Channel

pytestmark = pytest.mark.slow
RATE_HZ, N, SPEED_HZ = 12_800.0, 51_200, 29.5
OUTER_6205, DAMPING, LIMIT = 3.585, 0.03, 0.5
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "input"}],
            "bearings": [
                {"name": "de", "shaft": "input", "catalogue": "6205"},
                {"name": "fe", "shaft": "input", "catalogue": "6203"},
            ],
        }
    }
)


def heard(seed: int, resonance_hz: float, height: float = 0.0, order: float = OUTER_6205) -> FloatArray:
    """Lines of the shaft, white noise and noise of a resonance, and blows of `height` that ring there, g."""
    rng = np.random.default_rng(seed)
    time = np.arange(N) / RATE_HZ
    turns = SPEED_HZ * time
    lines = sum(a * np.sin(2 * np.pi * (k * turns + rng.random())) for k, a in ((1, 0.4), (2, 0.15), (3, 0.06)))
    decay = time[:640]
    ring = np.exp(-2 * np.pi * resonance_hz * DAMPING * decay) * np.sin(2 * np.pi * resonance_hz * decay)
    blows = np.zeros(N)
    steps = (1.0 + 0.01 * rng.standard_normal(1000)) / (order * SPEED_HZ)
    at = (np.cumsum(steps) * RATE_HZ).astype(int)
    at = at[at < N]
    blows[at] = height * (1.0 + 0.1 * rng.standard_normal(at.size))
    coloured = 0.1 * np.convolve(rng.standard_normal(N), ring)[:N] / np.sqrt(np.sum(ring**2))
    return np.asarray(lines + 0.15 * rng.standard_normal(N) + coloured + np.convolve(blows, ring)[:N])


def motor(seed: int, height: float = 0.0, order: float = OUTER_6205) -> tuple[FloatArray, FloatArray]:
    return heard(seed, 3000.0, height, order), heard(seed + 100, 3400.0, height / 5, order)


def recorded(de: FloatArray, fe: FloatArray) -> Recording:
    channels = tuple(
        Channel(name=name, quantity="acceleration", unit="g", location=name, axis="y") for name in ("de", "fe")
    )
    operating = Operating(shaft="input", speed_hz=SPEED_HZ)
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack((de, fe)), operating=operating)


def asked(de: FloatArray, fe: FloatArray) -> Report:
    return reconcile_kinematics(SPEC, [recorded(de, fe)], [recorded(*motor(1))], seed=0)


def faults(report: Report) -> set[str]:
    return {f.kind for f in report.measurement_faults}


def test_what_a_defect_rings_is_no_loose_sensor_and_exchanged_ones_are_told() -> None:
    de, fe = motor(4, 2.5)
    for rows, told in (((de, fe), False), ((fe, de), True)):
        report = asked(*rows)
        assert report.verdict == "explained" and report.causes[0].term == "outer_spall", report.sentence
        assert faults(report) == set()
        assert (f"{LOUDEST} fe" in report.sentence) is told


def test_a_loose_sensor_of_a_sound_machine_is_told_still() -> None:
    de, fe = motor(3)
    hz = np.fft.rfftfreq(N, 1 / RATE_HZ)
    loose = np.fft.irfft(np.fft.rfft(de) * 10 ** (12 / 20 * np.exp(-(((hz - 2500.0) / 700.0) ** 2))), N)
    report = asked(loose, fe)
    assert report.fault is not None and (report.fault.kind, report.fault.channel) == ("loose_sensor", "de")
    assert report.fault.detail.count(" Hz") == 1


def test_a_cut_off_crest_is_no_impact_and_a_real_one_is_told() -> None:
    de, fe = motor(3)
    sound = asked(np.clip(de, -LIMIT, LIMIT), fe)
    assert sound.verdict == "measurement_fault" and faults(sound) == {"clipped"}, sound.sentence
    de, fe = motor(4, 2.5)
    struck = asked(np.clip(de, -LIMIT, LIMIT), fe)
    assert struck.verdict == "explained" and faults(struck) == {"clipped"}, struck.sentence
    de, fe = motor(4, 2.5, order=1.0)
    turn = asked(np.clip(de, -2 * LIMIT, 2 * LIMIT), fe)
    assert turn.sentence.startswith("Impacts once a turn of input") and "clipped" in faults(turn), turn.sentence


def test_baselines_are_cut_off_as_the_tests_that_are_cut_off_and_as_no_other() -> None:
    de, fe = motor(3)
    cut, quiet, base = recorded(np.clip(de, -LIMIT, LIMIT), fe), recorded(0.2 * de, 0.2 * fe), recorded(*motor(1))
    slow = replace(base, operating=Operating(shaft="input", speed_hz=20.0))
    told = Finding(kind="clipped", channel="de", recording="test 1", detail="", severity=1.0, fault=True)
    gate = Gate(findings=(told,), baselines=(base, slow), tests=(cut, quiet), fault=None, usable=True)
    highest = [[float(row.max()) for row in one.samples] for one in cut_alike(gate).baselines]
    assert highest[0][0] == LIMIT and highest[0][1] == base.samples[1].max(), "by the test that is cut off"
    assert highest[1][0] == LIMIT, "no test of its speed: as any"
    other = replace(quiet, operating=slow.operating)
    free = cut_alike(replace(gate, tests=(cut, other))).baselines[1]
    assert np.array_equal(free.samples, slow.samples), "the test of its speed is not cut off"
    assert cut_alike(replace(gate, findings=())).baselines == gate.baselines
