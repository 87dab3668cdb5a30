"""The report on a recording: pulses are held against the stated speed."""

from __future__ import annotations

import numpy as np
import pytest

from signals.ingest.parse import Ingested
from signals.ingest.report import report
from signals.recording import Operating, Recording, Tacho
from sim.core.response import Channel

CHANNEL = Channel(name="a", quantity="acceleration", unit="m/s^2", location="", axis="")


def remarks(
    pulses_hz: float, stated_hz: float | None, per_turn: int = 1, shaft: str = "input", missed: int = 0
) -> list[str]:
    rng = np.random.default_rng(1)
    times = np.delete(np.arange(0.01, 1.9, 1.0 / pulses_hz), slice(20, 20 + missed))
    recording = Recording(
        sampling_rate_hz=2000.0, channels=(CHANNEL,), samples=rng.normal(size=(1, 4000)),
        operating=None if stated_hz is None else Operating(shaft="input", speed_hz=stated_hz),
        tacho=Tacho(shaft=shaft, pulse_times_s=times, pulses_per_revolution=per_turn),
    )  # fmt: skip
    found = report(Ingested(recording=recording, remarks=("first",)))["remarks"]
    assert isinstance(found, list) and found[0] == "first"
    return found[1:]


@pytest.mark.parametrize(("pulses_hz", "per_turn", "stated_hz"), [(39.1, 1, 30.0), (60.0, 1, 30.0), (30.0, 1, 1800.0)])
def test_pulses_of_another_speed_than_stated_are_remarked_on(pulses_hz: float, per_turn: int, stated_hz: float) -> None:
    (said,) = remarks(pulses_hz, stated_hz, per_turn)
    assert f"turns at {pulses_hz / per_turn:.4g} Hz, stated are {stated_hz:.4g} Hz" in said
    assert "pulses_per_revolution" in said


def test_pulses_of_the_stated_speed_or_of_another_shaft_are_not() -> None:
    assert remarks(30.9, 30.0) == [], "labels are some per cent wrong"
    assert remarks(60.0, 30.0, per_turn=2) == []
    assert remarks(60.0, 30.0, shaft="output") == []
    assert remarks(60.0, None) == []
    assert remarks(30.0, 30.0, missed=6) == [], "a fifth of a second without pulses is no other speed"


@pytest.mark.parametrize(("stated_hz", "asked"), [(1806.0, True), (700.0, True), (699.0, False), (30.1, False)])
def test_a_speed_that_hardly_any_machine_has_is_asked_about_where_no_pulses_tell(stated_hz: float, asked: bool) -> None:
    samples = np.random.default_rng(1).normal(size=(1, 4000))
    operating = Operating(shaft="input", speed_hz=stated_hz)
    recording = Recording(sampling_rate_hz=2000.0, channels=(CHANNEL,), samples=samples, operating=operating)
    told = report(Ingested(recording=recording, remarks=()))["remarks"]
    said = f"few machines turn at {stated_hz:g} Hz: is it in revolutions per minute? Then state {stated_hz / 60:.4g} Hz"
    assert told == ([f"operating.speed_hz: {said}"] if asked else [])
