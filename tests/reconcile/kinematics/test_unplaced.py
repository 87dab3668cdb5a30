"""Where nothing confirms the label and strong lines stand that no part makes, silence says nothing of the machine."""

from __future__ import annotations

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.elsewhere import ADVICE
from reconcile.kinematics.families import ties
from reconcile.kinematics.unplaced import with_risen, with_unplaced
from reconcile.verdict import Report
from tests.strategies.half import RATE_HZ, N, recorded, shaft_lines

BEARING = {"name": "drive_end", "shaft": "shaft", "catalogue": "6205"}
SPEC = read_kinematic_spec({"kinematics": {"shafts": [{"name": "shaft"}], "bearings": [BEARING]}})
TIE = ties(SPEC)
LABEL_HZ = 40.0


@dataclass(frozen=True)
class Seen:
    """What is read of an observation."""

    recording: object
    speed: object
    label: str = "test 1"


def seen(lines: dict[float, float], method: str = "stated") -> Seen:
    """Sines (Hz, amplitude) in noise, and how the speed was read."""
    rng, t = np.random.default_rng(5), np.arange(N) / RATE_HZ
    row = 0.3 * rng.standard_normal(N) + sum(a * np.sin(2 * np.pi * hz * t) for hz, a in lines.items())
    speed = SimpleNamespace(shaft="shaft", speed_hz=LABEL_HZ, method=method)
    return Seen(recording=recorded(row, LABEL_HZ), speed=speed)


def said(*several: Seen, verdict: str = "nothing_missing") -> Report:
    report = Report(verdict=verdict, sentence="No family.", level="kinematics")  # type: ignore[arg-type]
    return with_unplaced(report, TIE, several)  # type: ignore[arg-type]


def test_strong_lines_of_no_part_leave_the_speed_open() -> None:
    report = said(seen({23.6: 0.5, 47.2: 0.4}))
    assert report.verdict == "not_decidable" and report.next_experiment == ADVICE
    assert "no line confirms the stated 40 Hz" in report.sentence and report.sentence.endswith("No family.")
    assert "test 1: at 23.6, 47.2 Hz" in report.sentence and "40 Hz as stated" in report.undecidable[0]


@pytest.mark.parametrize(
    ("lines", "method"),
    [
        ({}, "stated"),  # nothing was heard
        ({23.6: 0.05, 47.2: 0.05}, "stated"),  # too weak to be the machine
        ({40.8: 0.5, 81.6: 0.3}, "stated"),  # the shaft's own, if the label is a little off
        ({39.6: 0.05, 52.4: 0.5, 104.8: 0.4}, "stated"),  # a neighbour's, beside a line of the shaft
        ({0.398 * 40.0: 0.5, 3.58 * 40.0: 0.5}, "stated"),  # the bearing's
        ({23.6: 0.5, 47.2: 0.4}, "tacho"),
        ({23.6: 0.5, 47.2: 0.4}, "harmonics"),
    ],
)
def test_other_silence_stays(lines: dict[float, float], method: str) -> None:
    assert said(seen(lines, method)).verdict == "nothing_missing"


def test_a_multiple_of_a_foreign_line_near_twice_the_label_is_none_of_the_shaft() -> None:
    assert said(seen({24.6: 0.5, 49.2: 0.4, 73.8: 0.3})).verdict == "not_decidable"


def test_every_test_must_have_them_and_other_answers_stay() -> None:
    strange = seen({23.6: 0.5, 47.2: 0.4})
    assert said(strange, seen({40.2: 0.5})).verdict == "nothing_missing"
    assert said(strange, verdict="explained").verdict == "explained"


@pytest.mark.slow
def test_a_sound_machine_far_from_its_label_is_not_called_sound() -> None:
    """Too few lines for the speed to be told from them."""
    rng = np.random.default_rng(2)
    rows = [shaft_lines(rng, 23.7) + 0.3 * rng.standard_normal(N) for _ in range(2)]
    report = reconcile_kinematics(SPEC, [recorded(rows[0], LABEL_HZ)], [recorded(rows[1], LABEL_HZ)], seed=0)
    assert report.verdict == "not_decidable" and "no line confirms the stated 40 Hz" in report.sentence


def candidate(kind: str = "outer", z: float = 12.0, *, risen: bool = True) -> SimpleNamespace:
    return SimpleNamespace(family=SimpleNamespace(kind=kind, site="drive_end"), z=z, risen=risen)


def told(*every: SimpleNamespace, method: str = "stated", verdict: str = "nothing_missing") -> Report:
    report = Report(verdict=verdict, sentence="No family.", level="kinematics")  # type: ignore[arg-type]
    return with_risen(report, every, (seen({}, method),))  # type: ignore[arg-type]


def test_lines_of_a_bearing_that_rose_under_a_label_that_nothing_confirms_are_no_nothing() -> None:
    report = told(candidate(z=6.0), candidate("inner", 12.0))
    assert report.verdict == "not_decidable" and report.next_experiment == ADVICE
    assert "no line confirms the stated 40 Hz" in report.sentence
    assert "lines of the inner race of drive_end rose (12.0 robust deviations)" in report.sentence


def test_they_are_chance_below_five_deviations_or_no_bearings_or_as_in_the_baseline_or_at_a_known_speed() -> None:
    for one in (candidate(z=4.9), candidate("turn"), candidate(risen=False)):
        assert told(one).verdict == "nothing_missing"
    assert told(candidate(), method="harmonics").verdict == "nothing_missing"
    assert told(candidate(), verdict="explained").verdict == "explained"
    assert told().verdict == "nothing_missing"
