"""Physics that nobody knows, heard by one sensor that may be loose, is asked of the others."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.faults import measurement_faults, with_faults
from reconcile.gate.findings import Finding, Gate, Kind
from reconcile.machine.suspected import of_a_sound_machine, of_the_sensor, without_suspected
from reconcile.report.sections import head
from reconcile.verdict import Report, SensorFault, Word
from signals.recording import Recording
from sim.core.response import Channel

CHANNELS = tuple(Channel(name=n, quantity="acceleration", unit="m/s^2", location=n) for n in ("a", "b"))


def suspecting(kind: Kind, count: int = 2) -> Gate:
    samples = np.random.default_rng(1).normal(size=(count, 64))
    one = Recording(sampling_rate_hz=64.0, channels=CHANNELS[:count], samples=samples)
    found = Finding(kind=kind, channel="a", recording="all tests", detail="+12 dB at 2 kHz", severity=0.6, fault=True)
    fault = SensorFault(kind=kind, channel="a", detail="+12 dB at 2 kHz")
    return Gate(findings=(found,), baselines=(one,), tests=(one,), fault=fault, usable=True)


def said(verdict: Word) -> Report:
    return Report(verdict=verdict, sentence=f"it is {verdict}", level="machine")


@pytest.mark.parametrize(
    ("verdict", "kind", "count", "asked"),
    [
        ("unknown_physics", "loose_sensor", 2, True),
        ("explained", "loose_sensor", 2, False),
        ("unknown_physics", "mains_hum", 2, False),
        ("unknown_physics", "loose_sensor", 1, False),
    ],
)
def test_the_others_are_asked_of_unknown_physics_on_a_loose_sensor(
    verdict: Word, kind: Kind, count: int, asked: bool
) -> None:
    fewer = without_suspected(said(verdict), suspecting(kind, count))
    assert (fewer is not None) == asked
    if fewer is not None:
        assert fewer.tests[0].names == ("b",) and fewer.baselines[0].names == ("b",)
        assert fewer.fault is not None, "the finding stays"


def test_a_sensor_of_which_the_gate_was_not_sure_is_asked_about_too() -> None:
    gate = suspecting("loose_sensor")
    doubted = replace(gate, findings=(replace(gate.findings[0], fault=False),), fault=None)
    fewer = without_suspected(said("unknown_physics"), doubted)
    assert fewer is not None and fewer.tests[0].names == ("b",)
    assert fewer.fault is not None and fewer.fault.channel == "a"
    report = of_the_sensor(said("unknown_physics"), said("nothing_missing"), fewer)
    assert report.verdict == "measurement_fault" and report.fault == replace(fewer.fault, doubtful=True)
    (listed,) = with_faults(report, measurement_faults(doubted)).measurement_faults
    assert listed.doubtful and "Perhaps the measurement" in head(report), "as doubtful as its sentence"
    assert without_suspected(said("unknown_physics"), replace(gate, findings=(), fault=None)) is None


def test_the_sensor_is_the_answer_only_where_the_others_have_nothing() -> None:
    gate, before = suspecting("loose_sensor"), said("unknown_physics")
    report = of_the_sensor(before, said("nothing_missing"), gate)
    assert report.verdict == "measurement_fault" and report.fault is not None and report.fault.doubtful
    assert "may be in the measurement: a sensor that looks loose on a, or damage near it" in report.sentence
    assert "other channels alone" in report.sentence
    assert of_the_sensor(before, said("unknown_physics"), gate) is before


@pytest.mark.parametrize(
    ("verdict", "kind", "sure", "told"),
    [
        ("nothing_missing", "loose_sensor", True, True),
        ("nothing_missing", "loose_sensor", False, False),
        ("nothing_missing", "mains_hum", True, False),  # the gate's own answer, or left out
        ("not_decidable", "loose_sensor", True, False),
        ("explained", "loose_sensor", True, False),
    ],
)
def test_where_nothing_else_is_missing_the_loose_sensor_is_the_answer(
    verdict: Word, kind: Kind, sure: bool, told: bool
) -> None:
    gate, before = suspecting(kind), said(verdict)
    gate = replace(gate, findings=(replace(gate.findings[0], fault=sure, transfer_db=((2e3, 12.0),)),))
    report = of_a_sound_machine(before, gate)
    assert (report is not before) is told
    if told:
        assert report.verdict == "measurement_fault" and report.fault is not None and report.fault.doubtful
        assert report.fault.channel == "a" and "a sensor that looks loose on a, or damage near it" in report.sentence
        assert report.sentence.endswith("Nothing else is missing.")
        (listed,) = with_faults(report, measurement_faults(gate)).measurement_faults
        assert listed.doubtful


@pytest.mark.parametrize(
    ("points", "size_db", "told"),
    [(1, 7.5, False), (1, -9.9, False), (1, -11.0, True), (2, 7.5, False), (3, 7.5, True)],
)
def test_at_few_operating_points_only_a_large_change_of_transfer_counts(
    points: int, size_db: float, told: bool
) -> None:
    gate = suspecting("loose_sensor")
    found = replace(gate.findings[0], transfer_db=((1e3, 1.0), (2e3, size_db)))
    several = replace(gate, findings=(found,), tests=gate.tests * points)
    before = said("nothing_missing")
    assert (of_a_sound_machine(before, several) is not before) is told
