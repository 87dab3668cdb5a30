"""A label that the lines put right by nearly a tenth is a fault of the measurement; a usual one is not."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.kinematics.labels import label_faults
from reconcile.verdict import Report

NAMED = Report(verdict="explained", sentence="A local defect.", level="kinematics")


def turned(stated_hz: float | None, speed_hz: float = 24.52, method: str = "harmonics", label: str = "test 1"):  # type: ignore[no-untyped-def]
    mismatch = None if stated_hz is None else speed_hz / stated_hz - 1
    speed = SimpleNamespace(shaft="input", speed_hz=speed_hz, stated_hz=stated_hz, method=method, mismatch=mismatch)
    return SimpleNamespace(label=label, speed=speed)


def test_a_label_a_tenth_off_is_told_with_its_recordings() -> None:
    (fault,) = label_faults(NAMED, [turned(27.0), turned(24.5, label="baseline 1")])
    assert (fault.kind, fault.channel, fault.recordings) == ("speed_mismatch", "", ("test 1",))
    assert "input turned at 24.52 Hz, -9.2 % from the stated 27 Hz" in fault.detail and not fault.doubtful


@pytest.mark.parametrize("stated_hz", [24.5, 24.52 / 1.07, 24.52 * 1.07, None])
def test_slip_and_usual_labels_are_none(stated_hz: float | None) -> None:
    assert label_faults(NAMED, [turned(stated_hz)]) == ()


def test_nothing_is_told_that_no_line_says_or_that_the_answer_doubts() -> None:
    assert label_faults(NAMED, [turned(27.0, method="stated")]) == ()
    doubted = Report(verdict="ambiguous", sentence="The speed is not decided: x.", level="kinematics")
    assert label_faults(doubted, [turned(27.0)]) == ()
