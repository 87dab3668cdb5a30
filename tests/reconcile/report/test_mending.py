"""What to do about a fault of the measurement fits its kind."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.gate.findings import FAULTS
from reconcile.report.action import to_do
from reconcile.report.mending import MENDED, to_mend
from reconcile.report.sections import head
from reconcile.verdict import Report, SensorFault


@pytest.mark.parametrize("kind", [*FAULTS, "speed_mismatch", "fixed_tones", "of a later version"])
def test_every_kind_has_a_clause_with_and_without_what_follows(kind: str) -> None:
    fault = SensorFault(kind=kind, channel="drive")
    for said in (to_mend(fault), to_mend(fault, beside=True)):
        assert said.endswith(".") and said[0].islower() and "{" not in said and ",." not in said
    assert "all channels" in to_mend(SensorFault(kind="stuck", channel=""))


def test_a_description_is_corrected_and_nothing_is_recorded_anew() -> None:
    for kind in ("unit_mismatch", "swapped_channels"):
        fault = SensorFault(kind=kind, channel="drive")
        told = to_do(Report(verdict="measurement_fault", sentence="", level="machine", fault=fault))
        assert "drive" in told and "record again" not in told and "nothing needs to be recorded anew" in told
        beside = to_do(Report(verdict="nothing_missing", sentence="", level="machine", fault=fault))
        assert "recorded anew" not in beside and "drive." in beside.replace(")", "")
    assert "record again before judging" in to_mend(SensorFault(kind="clipped", channel="a"))


BESIDE_THE_GATE = {"speed_mismatch", "fixed_tones", "drift", "other_motion", "out_of_step", "polarity", "sampling_rate"}
"""Kinds that later stages tell; the last five where a force is measured (`reconcile.driven`)."""


def test_no_kind_is_told_that_nobody_finds() -> None:
    assert set(MENDED) <= {*FAULTS, *BESIDE_THE_GATE}


def test_all_exchanged_channels_are_asked_for() -> None:
    detail = "all tests: looks like the baseline's free, not like its own; also on free"
    told = to_mend(SensorFault(kind="swapped_channels", channel="drive", detail=detail))
    assert "(here drive and free)" in told


def test_all_channels_with_one_fault_are_asked_for_and_shown() -> None:
    """Beside an answer each channel has a fault of its own."""
    faults = tuple(SensorFault(kind=kind, channel=c) for kind, c in (("unit_mismatch", "de"), ("unit_mismatch", "fe")))
    other = SensorFault(kind="clipped", channel="xe")
    report = Report(
        verdict="explained", sentence="", level="kinematics", fault=faults[0], measurement_faults=(*faults, other)
    )
    assert "stated for de and fe." in to_do(report)
    assert to_do(report).endswith("stated for de and fe. Also set a larger range at xe.")
    assert "on de, fe<" in head(report)
    sure = (*faults, replace(other, doubtful=True))
    assert "xe" not in to_do(replace(report, measurement_faults=sure)), "what may be the machine's own is not mended"
    for verdict in ("measurement_fault", "ambiguous"):
        assert "stated for de and fe" in to_do(replace(report, verdict=verdict))


def test_a_fault_that_may_be_the_machine_asks_for_both_and_its_page_is_as_doubtful() -> None:
    fault = SensorFault(kind="loose_sensor", channel="a1", doubtful=True)
    report = Report(verdict="measurement_fault", sentence="", level="kinematics", fault=fault)
    assert "the sensor of a1 is fastened" in to_do(report) and "inspect what turns beside it: teeth" in to_do(report)
    sure = replace(report, fault=SensorFault(kind="clipped", channel="a1"))
    assert "Perhaps the measurement" in head(report) and "Fault in the measurement" not in head(report)
    assert "Fault in the measurement" in head(sure)
