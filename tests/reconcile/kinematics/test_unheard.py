"""Tests of noise alone, where the baseline is a machine's, are no answer about the machine."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import Finding, Gate
from reconcile.gate.loose import transferred
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.unheard import (
    COMMON_BINS,
    LEAST_SAMPLES,
    common_bins,
    deaf_limits,
    line_strength,
    same_shape,
    with_lost,
    with_unheard,
)
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.response import Channel

RATE_HZ, N = 12_000.0, 36_000


def noise(seed: int) -> FloatArray:
    return np.asarray(np.random.default_rng(seed).standard_normal(N))


def heard(seed: int, size: float = 0.3) -> FloatArray:
    return noise(seed) + size * np.sin(2 * np.pi * 73.0 * np.arange(N) / RATE_HZ)


def recording(*rows: FloatArray) -> Recording:
    channels = tuple(
        Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location="", axis="y") for k in range(len(rows))
    )
    operating = Operating(shaft="shaft", speed_hz=24.33)
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows), operating=operating)


def gated(tests: list[Recording], baselines: list[Recording]) -> Gate:
    found = Gate(findings=(), baselines=tuple(baselines), tests=tuple(tests), fault=None, usable=True)
    return with_unheard(found)


BASE = recording(heard(1), heard(2))


@pytest.mark.slow
def test_noise_alone_is_not_usable() -> None:
    gate = gated([recording(30.0 * noise(3), 20.0 * noise(4))], [BASE])
    assert not gate.usable
    assert gate.fault is not None
    assert gate.fault.kind == "noise"
    assert {f.channel for f in gate.findings} == {"a0", "a1"}


@pytest.mark.slow
def test_a_stuck_channel_has_no_second_fault_and_is_not_waited_for() -> None:
    """What a stuck sensor gives holds no line either; with all others deaf nothing is left."""
    stuck = Finding(kind="stuck", channel="a0", recording="test 1", detail="", severity=1.0, fault=True)
    for other, usable in ((heard(5), True), (20.0 * noise(4), False)):
        test = recording(30.0 * noise(3), other)
        given = Gate(findings=(stuck,), baselines=(BASE,), tests=(test,), fault=stuck, usable=True)
        gate = with_unheard(given)
        assert gate.usable is usable and [f.channel for f in gate.findings if f.kind == "noise"] == ["a1"][usable:]


@pytest.mark.slow
def test_noise_that_looks_like_a_loose_sensor_is_noise() -> None:
    """Undoing its transfer makes a line where the baseline has one."""
    curve = ((0.0, 0.0), (72.0, 0.0), (72.5, -40.0), (73.5, -40.0), (74.0, 0.0), (6000.0, 0.0))
    loose = Finding(
        kind="loose_sensor", channel="a0", recording="all tests", detail="", severity=1.0, fault=True, transfer_db=curve
    )
    undone = transferred(recording(noise(3), heard(4)), [loose], -1)
    assert line_strength(undone.samples[0], RATE_HZ) > 1.0
    gate = with_unheard(Gate(findings=(loose,), baselines=(BASE,), tests=(undone,), fault=None, usable=True))
    assert [(f.kind, f.channel) for f in gate.findings] == [("noise", "a0")]
    assert gate.fault is not None and gate.fault.kind == "noise"
    undone = transferred(BASE, [loose], -1)
    same = with_unheard(Gate(findings=(loose,), baselines=(BASE,), tests=(undone,), fault=None, usable=True))
    assert same.findings == (loose,)


@pytest.mark.slow
def test_a_deaf_channel_is_a_limit_where_no_baseline_is() -> None:
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}]}})
    for test, deaf in ((recording(heard(3), noise(4)), ["a1"]), (BASE, [])):
        report = reconcile_kinematics(spec, [test], [], seed=0)
        assert report.verdict == "nothing_missing"
        told = [text for text in report.where.limits if text.startswith("no line stands out of noise on")]
        assert told == deaf_limits([test], ["test 1"])
        assert [text.split()[7] for text in told] == deaf
    assert deaf_limits([recording(noise(3), noise(4))], ["test 1"]) == []


@pytest.mark.slow
def test_one_deaf_channel_and_one_deaf_test_are_told() -> None:
    gate = gated([recording(heard(3), noise(4)), recording(noise(5), noise(6)), BASE], [BASE])
    assert gate.usable
    assert [(f.recording, f.channel) for f in gate.findings] == [("test 1", "a1"), ("test 2", "a0"), ("test 2", "a1")]
    assert with_lost(gate, frozenset()) == {"test 2"}
    assert with_lost(gate, frozenset({"test 1", "test 3"})) == {"test 1", "test 3"}  # something must be left


@pytest.mark.parametrize(
    ("tests", "bases"),
    [
        ([recording(heard(3), heard(4))], [BASE]),
        ([recording(noise(3), noise(4))], [recording(noise(5), noise(6))]),
        ([recording(noise(3), noise(4))], []),
        ([recording(noise(3)[: LEAST_SAMPLES // 2])], [recording(heard(1))]),
    ],
    ids=["heard", "deaf before", "no baseline", "short"],
)
def test_nothing_is_told(tests: list[Recording], bases: list[Recording]) -> None:
    gate = gated(tests, bases)
    assert gate.usable
    assert gate.findings == ()


def ringing(values: FloatArray) -> FloatArray:
    """Heard through a housing that rings."""
    return np.convolve(values, np.exp(-np.arange(60) / 12.0) * np.sin(np.arange(60) * 1.3), mode="same")


RINGING = recording(heard(11, 4.0), 0.3 * ringing(noise(12)) + heard(13, 1.0))
KNOCKS = ringing(noise(8))


@pytest.mark.slow
def test_a_channel_that_knocks_with_another_heard_the_machine() -> None:
    """A loose ring of a gearbox drowned every line of the housing above it; the other bearing's lines stayed."""
    gate = gated([recording(0.05 * heard(3, 4.0) + 0.1 * KNOCKS, KNOCKS + 0.1 * noise(4))], [RINGING])
    assert gate.findings == ()


@pytest.mark.slow
@pytest.mark.parametrize("shared", ["hum", "interference", "cross-talk", "knocks of a channel without lines"])
def test_what_a_dead_sensor_shares_with_another_is_no_machine(shared: str) -> None:
    hum = np.sin(2 * np.pi * 450.0 * np.arange(N) / RATE_HZ)
    sound, own = heard(3, 4.0), noise(4)
    pairs = {
        "hum": (sound + hum, own + hum),
        "interference": (sound + noise(9), own + 2.0 * noise(9)),
        "cross-talk": (sound, own + 2.0 * noise(3)),
        "knocks of a channel without lines": (KNOCKS + 0.1 * noise(14), KNOCKS + 0.1 * own),
    }
    gate = gated([recording(*pairs[shared])], [RINGING])
    assert ("a1", "noise") in {(f.channel, f.kind) for f in gate.findings}


def test_shares_and_shapes() -> None:
    assert (
        common_bins(KNOCKS + 0.1 * noise(4), KNOCKS + 0.3 * noise(3)) >= COMMON_BINS > common_bins(noise(5), noise(6))
    )
    assert common_bins(np.ones(N), noise(6)) == 0
    drift = np.cumsum(noise(7)) * 0.1
    assert common_bins(drift + noise(5), drift + noise(6)) < COMMON_BINS, "below the lowest bins"
    assert same_shape(KNOCKS, ringing(noise(9)) + heard(2))
    assert not same_shape(KNOCKS, noise(2)) and not same_shape(noise(1), noise(2))


def test_a_line_of_the_envelope_is_one() -> None:
    carried = noise(3) * (1.0 + 0.5 * np.sin(2 * np.pi * 31.0 * np.arange(N) / RATE_HZ))
    assert line_strength(carried, RATE_HZ) > 1.0 > line_strength(noise(3), RATE_HZ)


@pytest.mark.slow
def test_the_report_is_a_fault_of_the_measurement() -> None:
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}]}})
    for test, word in ((recording(30.0 * noise(3), 20.0 * noise(4)), "measurement_fault"), (BASE, "nothing_missing")):
        report = reconcile_kinematics(spec, [replace(test)], [BASE], seed=0)
        assert report.verdict == word
        assert (report.fault is not None and report.fault.kind == "noise") is (word == "measurement_fault")
