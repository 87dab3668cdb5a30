"""Faults of the measurement beside an answer: in the list, in `fault` and in the sentence, as sure as they are."""

from __future__ import annotations

import json
from dataclasses import replace

import numpy as np
import pytest

from reconcile.faults import measurement_faults, with_faults
from reconcile.gate.findings import Finding, Gate, Kind
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.report import page, strict_json
from reconcile.report.action import to_do
from reconcile.verdict import Report, SensorFault
from tests.strategies.impulses import recorded, sound, train

CLIPPED = SensorFault(kind="clipped", channel="de", recordings=("test 1",), left_out=True)
LOOSE = SensorFault(kind="loose_sensor", channel="nde", doubtful=True)
ANSWER = Report(verdict="explained", sentence="A pit.", level="machine")


def finding(kind: Kind, channel: str, recording: str, severity: float, *, fault: bool = True) -> Finding:
    return Finding(
        kind=kind, channel=channel, recording=recording, detail=f"seen {severity}", severity=severity, fault=fault
    )


def test_one_a_kind_and_channel_and_what_spoils_most_first() -> None:
    two = recorded(sound(1))
    findings = (
        finding("loose_sensor", "other", "all tests", 0.9),
        finding("clipped", "gone", "test 1", 0.2),
        finding("clipped", "gone", "test 2", 0.6),
        finding("too_short", "", "test 1", 0.5, fault=False),
    )
    gate = Gate(findings=findings, baselines=(), tests=(two,), fault=None, usable=True)
    first, second = measurement_faults(gate)
    assert (first.kind, first.channel, first.recordings) == ("clipped", "gone", ("test 1", "test 2"))
    assert first.detail == "seen 0.6"
    assert first.left_out
    assert not first.doubtful
    assert (second.kind, second.doubtful) == ("loose_sensor", True)
    assert not measurement_faults(replace(gate, findings=findings[3:]))


def test_what_is_sure_stands_in_fault_and_sentence_and_what_is_not_is_undecided() -> None:
    report = with_faults(ANSWER, (CLIPPED, LOOSE))
    assert report.verdict == "explained"
    assert report.fault == CLIPPED
    assert report.measurement_faults == (CLIPPED, LOOSE)
    assert report.sentence == "A pit. Beside it the measurement is at fault: clipped on de (left out)."
    assert report.undecidable == (
        "whether loose sensor on nde is the sensor's or the machine's own, which may do the same",
    )
    only = with_faults(ANSWER, (LOOSE,))
    assert only.fault is None
    assert only.sentence == ANSWER.sentence
    assert only.measurement_faults == (LOOSE,)
    assert with_faults(ANSWER, (CLIPPED,), explained=("clipped",)) == ANSWER


def test_a_verdict_on_the_measurement_keeps_its_fault_first() -> None:
    speed = SensorFault(kind="speed_mismatch", channel="")
    report = replace(ANSWER, verdict="measurement_fault", fault=speed)
    assert with_faults(report, (CLIPPED,)).measurement_faults == (speed, CLIPPED)
    assert with_faults(report, (CLIPPED,)).fault == speed
    assert with_faults(replace(report, fault=CLIPPED), (CLIPPED,)).measurement_faults == (CLIPPED,)


def test_a_verdict_on_the_measurement_tells_the_sure_faults_of_other_channels() -> None:
    silent = SensorFault(kind="silence", channel="fe", detail="test 1: never changes; also on ae")
    also, stuck = replace(silent, channel="ae", detail=""), SensorFault(kind="stuck", channel="xe", left_out=True)
    report = replace(ANSWER, verdict="measurement_fault", fault=silent)
    told = with_faults(report, (silent, also, stuck, LOOSE))
    assert told.sentence == "A pit. At fault too: stuck on xe (left out).", "ae is told in the detail, nde is not sure"
    assert to_do(told) == "check sensor and cable of fe, ae and xe and record again before judging the machine."
    assert with_faults(report, (silent, also)).sentence == ANSWER.sentence
    speed = SensorFault(kind="speed_mismatch", channel="")
    assert with_faults(replace(report, fault=speed), (speed,)).sentence == ANSWER.sentence


def test_the_files_tell_all_of_them() -> None:
    report = with_faults(ANSWER, (CLIPPED, LOOSE))
    told = json.loads(strict_json(report))
    assert {"kind", "channel"} <= set(told["fault"])
    assert [f["kind"] for f in told["measurement_faults"]] == ["clipped", "loose_sensor"]
    assert told["to_do"].endswith(" Set a larger range at de.")
    html = page(report)
    for words in ("The measurement", ">clipped</td>", ">nde</td>", "left out", "machine&#x27;s own"):
        assert words in html


@pytest.mark.slow
def test_a_pit_beside_a_channel_with_gaps_is_told_with_both() -> None:
    """Two sensors hear a pit of the outer race; one of them drops out for a tenth of the time."""
    spec = read_kinematic_spec(
        {
            "kinematics": {
                "shafts": [{"name": "shaft"}],
                "bearings": [{"name": "b1", "shaft": "shaft", "catalogue": "6205"}],
            }
        }
    )

    hit = [sound(s) + train(np.random.default_rng(s), 3.5848 * 0.992, 1.0) for s in (2, 3)]
    hit[1][10_000 : 10_000 + hit[1].size // 10] = 0.0
    baseline = recorded([sound(1), sound(4)], names=["near", "far"])
    report = reconcile_kinematics(spec, [recorded(hit, names=["near", "far"])], [baseline], seed=3)
    assert report.verdict == "explained"
    assert report.causes[0].term == "outer_spall"
    assert report.fault is not None
    assert (report.fault.kind, report.fault.channel) == ("dropouts", "far")
    assert "Beside it the measurement is at fault: dropouts on far." in report.sentence  # heard where it was good


def test_a_fault_that_is_the_answer_is_as_doubtful_as_in_the_list_and_says_what_is_open() -> None:
    answer = Report(
        verdict="measurement_fault", sentence="Loose.", level="machine", fault=replace(LOOSE, doubtful=False)
    )
    told = with_faults(answer, (CLIPPED, LOOSE))
    assert told.fault == LOOSE and told.measurement_faults == (CLIPPED, LOOSE)
    assert told.undecidable == (
        "whether loose sensor on nde is the sensor's or the machine's own, which may do the same",
    )
    sure = with_faults(replace(answer, fault=CLIPPED), (CLIPPED,))
    assert sure.fault == CLIPPED and sure.undecidable == ()
    unlisted = with_faults(answer, (CLIPPED,))
    assert unlisted.measurement_faults == (answer.fault, CLIPPED)
