"""Channels that a fault of the measurement spoiled do not reach the later stages, as long as others do."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.gate.findings import Finding, Gate
from reconcile.gate.spoiled import GONE, HEARD, LOOKS, doubts, fault_sentence, without_spoiled
from reconcile.verdict import SensorFault
from signals.recording import Recording
from sim.core.response import Channel

CHANNELS = tuple(Channel(name=f"a{c}", quantity="acceleration", unit="m/s^2", location="bearing1") for c in range(3))


def gate(*findings: Finding) -> Gate:
    recordings = tuple(
        Recording(sampling_rate_hz=1e4, channels=CHANNELS, samples=np.arange(300.0).reshape(3, 100) + k)
        for k in range(3)
    )
    return Gate(findings=findings, baselines=recordings[:1], tests=recordings[1:], fault=None, usable=True)


def finding(kind, channel, fault=True):
    return Finding(kind=kind, channel=channel, recording="test 2", detail="", severity=0.5, fault=fault)


@pytest.mark.parametrize("kind", ["dropouts", "clipped", "spikes", "mains_hum", "alias", "gain_change", "stuck"])
def test_a_spoiled_channel_is_left_out_of_baselines_and_tests(kind):
    found = without_spoiled(gate(finding(kind, "a1")))
    assert all(r.names == ("a0", "a2") for r in (*found.baselines, *found.tests))
    assert found.tests[1].samples[1, 0] == 202.0


def test_what_is_undone_exactly_or_may_be_the_machine_stays():
    assert without_spoiled(gate(finding("swapped_channels", "a0"), finding("loose_sensor", "a2"))).tests[0].names == (
        "a0",
        "a1",
        "a2",
    )


def test_remarks_leave_everything_and_so_do_faults_of_all_channels():
    assert len(without_spoiled(gate(finding("mains_hum", "a1", fault=False))).tests[0].names) == 3
    everywhere = gate(*(finding("mains_hum", f"a{c}") for c in range(3)))
    assert len(without_spoiled(everywhere).tests[0].names) == 3


def test_a_level_that_needs_clipped_channels_leaves_out_only_what_has_no_signal():
    found = without_spoiled(gate(finding("clipped", "a0"), finding("stuck", "a1")), GONE)
    assert found.tests[0].names == ("a0", "a2")


def test_faults_are_told_as_limits_of_what_is_said_of_the_machine():
    told = doubts(
        gate(finding("clipped", "a0"), finding("loose_sensor", "a1"), finding("mains_hum", "a2", fault=False))
    )
    assert len(told) == 2, "remarks are none"
    assert told[0].startswith("a0 of test 2: clipped") and "the machine" not in told[0]
    assert "loose sensor" in told[1] and "what the machine does there" in told[1]
    many = doubts(gate(*(finding("stuck", f"a{c}") for c in range(9))))
    assert len(many) == 7 and many[-1].startswith("and 3 more")
    assert doubts(gate()) == ()


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("loose_sensor", "The mismatch may be in the measurement: a sensor that looks loose on a1, or damage near it"),
        ("gain_change", "The mismatch may be in the measurement: another gain on a1, or what the machine does there"),
        ("clipped", "The mismatch is in the measurement: clipped on a1"),
    ],
)
def test_what_may_be_the_machine_is_said_so_from_the_first_words(kind, said):
    fault = SensorFault(kind=kind, channel="a1", detail="seen")
    assert fault_sentence(fault) == f"{said} (seen)."
    assert fault_sentence(fault, heard=False).startswith("The mismatch is in the measurement: ")
    assert set(LOOKS) == HEARD
