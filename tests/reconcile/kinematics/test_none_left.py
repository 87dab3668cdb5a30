"""Where a baseline was given and is left out, the report does not say that there was none, and asks to put it right."""

from __future__ import annotations

from reconcile.kinematics.answer import NO_BASELINE, SOUND, SOUND_TOO, WITHOUT
from reconcile.kinematics.none_left import MEND, with_none_left
from reconcile.verdict import NextExperiment, Report

LOOK = NextExperiment(sentence="Look.")


def told(next_experiment: NextExperiment) -> Report:
    return Report(
        verdict="not_decidable",
        sentence=f"Lines are there; {WITHOUT} nothing tells.",
        level="kinematics",
        undecidable=(f"what was there before: {NO_BASELINE}", "how large it is"),
        next_experiment=next_experiment,
    )


def test_a_baseline_that_was_left_out_is_not_called_absent() -> None:
    for asked in (SOUND, SOUND_TOO):
        report = with_none_left(told(asked), given=True, left=False)
        assert not any(NO_BASELINE in text for text in (report.sentence, *report.undecidable))
        assert "a baseline that can be used" in report.sentence and "was left out" in report.undecidable[0]
        assert report.undecidable[1] == "how large it is" and report.next_experiment == MEND
    assert with_none_left(told(LOOK), given=True, left=False).next_experiment == LOOK


def test_nothing_changes_where_there_was_none_or_one_is_left() -> None:
    for given, left in ((False, False), (True, True)):
        assert with_none_left(told(SOUND), given=given, left=left) == told(SOUND)
