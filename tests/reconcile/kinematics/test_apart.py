"""A stated speed that no line confirms and that lies apart from the baseline's names nothing."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.kinematics.apart import APART, speeds_apart, with_speeds
from reconcile.verdict import Cause, Report, Word

FOUND = Report(
    verdict="explained",
    sentence="A local defect on a ball of drive_end.",
    level="kinematics",
    causes=(Cause(term="ball_spall", site="drive_end", score=9.0, named=True),),
)


def turning(speed_hz: float, method: str) -> SimpleNamespace:
    return SimpleNamespace(speed=SimpleNamespace(speed_hz=speed_hz, method=method))


def told(tests: list[tuple[float, str]], baselines: list[tuple[float, str]], report: Report = FOUND) -> Report:
    made = [[turning(*one) for one in several] for several in (tests, baselines)]
    return with_speeds(report, *made)  # type: ignore[arg-type]


def test_a_far_speed_that_nothing_confirms_is_doubted() -> None:
    report = told([(45.0, "stated")], [(29.93, "harmonics")])
    assert report.verdict == "ambiguous" and not any(c.named for c in report.causes)
    assert "45 Hz" in report.sentence and "29.93 Hz" in report.sentence and FOUND.sentence in report.sentence
    assert report.undecidable[0].startswith("whether the test turns at 45 Hz")
    assert report.next_experiment is not None and "tacho" in report.next_experiment.sentence


@pytest.mark.parametrize(
    ("tests", "baselines"),
    [
        ([(45.0, "harmonics")], [(29.93, "harmonics")]),  # the test's own lines say so
        ([(45.0, "stated")], [(29.93, "stated")]),  # nothing says how fast the baseline turned
        ([(45.0, "stated")], []),
        ([(30.0, "stated")], [(29.93, "harmonics")]),
        ([(45.0, "stated")], [(29.93, "harmonics"), (45.3, "tacho")]),  # one of the baselines is of this speed
        ([(45.0, "stated"), (30.0, "stated")], [(29.93, "harmonics")]),  # not most of the tests
    ],
)
def test_otherwise_the_report_stays(tests: list[tuple[float, str]], baselines: list[tuple[float, str]]) -> None:
    assert told(tests, baselines) is FOUND


@pytest.mark.parametrize("word", ["nothing_missing", "not_decidable", "measurement_fault"])
def test_what_names_nothing_stays(word: Word) -> None:
    quiet = Report(verdict=word, sentence="x", level="kinematics")
    assert told([(45.0, "stated")], [(29.93, "harmonics")], quiet) is quiet


def test_the_bound_is_a_share_of_the_stated_speed() -> None:
    for share, apart in ((0.9 * APART, False), (1.1 * APART, True)):
        tests, baselines = [turning(40.0, "stated")], [turning(40.0 * (1.0 - share), "harmonics")]
        assert (speeds_apart(tests, baselines) is not None) is apart  # type: ignore[arg-type]
