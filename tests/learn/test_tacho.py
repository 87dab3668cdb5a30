"""Pulses that cover a part, contradict the statement or are of another shaft don't count in silence."""

from __future__ import annotations

import numpy as np
import pytest

from learn.classify import classify
from learn.model import default_model
from learn.tacho import pulses_of
from signals.recording import Operating, Recording, Tacho
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE, SECONDS = 4000.0, 2.0


def recording(times_s: FloatArray, stated_hz: float | None = 25.0, per_turn: int = 1, shaft: str = "a") -> Recording:
    return Recording(
        sampling_rate_hz=RATE,
        channels=(Channel(name="c", quantity="acceleration", unit="m/s^2", location="", axis=""),),
        samples=np.random.default_rng(1).standard_normal((1, int(RATE * SECONDS))),
        operating=None if stated_hz is None else Operating(shaft="a", speed_hz=stated_hz),
        tacho=Tacho(shaft=shaft, pulse_times_s=times_s, pulses_per_revolution=per_turn),
    )


def pulses(hz: float, first_s: float = 0.0, last_s: float = SECONDS) -> FloatArray:
    return np.arange(first_s, last_s, 1 / hz)


def test_pulses_all_along_that_agree_are_believed_without_a_word() -> None:
    found = pulses_of(recording(pulses(25.5)))
    assert found.firm and found.used and found.speed_hz == pytest.approx(25.5)
    assert found.remarks == () and found.faults() == []


@pytest.mark.parametrize("first_s", [10.0, -5.0])
def test_pulses_outside_are_refused(first_s: float) -> None:
    with pytest.raises(SpecError) as refused:
        pulses_of(recording(pulses(25.0, first_s, first_s + 1.0)))
    (problem,) = refused.value.problems
    assert problem.field == "tacho.pulse_times_s" and problem.given and problem.allowed == "times within 0 to 2"


def test_a_few_pulses_are_where_the_search_starts_unless_they_contradict() -> None:
    found = pulses_of(recording(pulses(25.0, 0.0, 0.1)))
    assert found.used and not found.firm and found.kinds == ("partial",) and "cover 4%" in found.remarks[0]
    assert pulses_of(recording(pulses(40.0, 0.0, 0.1), None)).used
    wrong = pulses_of(recording(pulses(40.0, 0.0, 0.1)))
    assert not wrong.used and wrong.kinds == ("partial", "contradicted")
    assert "40 Hz" in wrong.remarks[1] and "25 Hz" in wrong.remarks[1]
    assert not pulses_of(recording(pulses(25.0, 0.0, 0.1)), trust=True).used


def test_a_contradiction_is_told_with_both_numbers() -> None:
    found = pulses_of(recording(pulses(50.0)))
    assert found.firm and found.kinds == ("contradicted",)
    assert "50 Hz" in found.remarks[0] and "25 Hz" in found.remarks[0]
    assert "is pulses_per_revolution 2 (2 pulses a turn)?" in found.remarks[0]
    assert "pulses_per_revolution" not in pulses_of(recording(pulses(33.0))).remarks[0]
    assert "does it pulse once in 2 turns" in pulses_of(recording(pulses(12.5))).remarks[0]


def test_lost_and_doubled_pulses_are_no_speed() -> None:
    """A hole in the middle leaves first and last pulse where they were."""
    all_of_them = pulses(25.0)
    hole = np.delete(all_of_them, slice(12, 37))
    few = np.delete(all_of_them, [7, 19, 33])
    doubled = np.sort(np.concatenate([all_of_them, all_of_them[[5, 22, 40]] + 0.002]))
    for times, steps in ((hole, 1), (few, 3), (doubled, 6)):
        found = pulses_of(recording(times, None))
        assert not found.firm and found.used and "irregular" in found.kinds, found
        assert found.speed_hz == pytest.approx(25.0, rel=1e-3)
        assert f"{steps} of its steps" in found.remarks[0] or times is doubled
    assert not pulses_of(recording(hole), trust=True).used


def test_a_speed_that_changes_and_marks_that_are_uneven_are_regular() -> None:
    turns = np.arange(0.0, 60.0)
    ramp = np.cumsum(1.0 / np.linspace(20.0, 40.0, 60))
    ramp = ramp / ramp[-1] * 1.99
    assert pulses_of(recording(ramp, None)).firm
    two = np.sort(np.concatenate([turns, turns + 0.45])) / 30.5
    assert pulses_of(recording(two, None, per_turn=2)).kinds == ()


def test_pulses_of_another_shaft_and_too_few_are_not_used() -> None:
    assert pulses_of(recording(pulses(25.0), shaft="b")).faults() == [
        {"channel": "tacho", "kind": "other_shaft", "left_out": True}
    ]
    assert pulses_of(recording(np.array([0.1, 1.9]))).kinds == ("few_pulses",)


@pytest.mark.slow
def test_the_answer_says_what_became_of_the_pulses() -> None:
    found = classify(recording(pulses(40.0, 0.0, 0.1)), default_model())
    assert found["speed"]["method"] != "tacho" and found["speed"]["speed_hz"] == pytest.approx(25.0, rel=0.06)
    assert [f["kind"] for f in found["measurement_faults"] if f["channel"] == "tacho"] == ["partial", "contradicted"]
    assert any("40 Hz" in remark for remark in found["remarks"])
    near = classify(recording(pulses(40.0, 0.0, 0.1), None), default_model())
    assert near["speed"]["speed_hz"] == pytest.approx(40.0, rel=0.06)
