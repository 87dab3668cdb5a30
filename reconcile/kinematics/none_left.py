"""Words of reports whose baselines were all left out: there was one, and what is wrong with it can be put right."""

from __future__ import annotations

from dataclasses import replace

from reconcile.kinematics.answer import NO_BASELINE, SOUND, SOUND_TOO, WITHOUT
from reconcile.verdict import NextExperiment, Report

WORDS = {NO_BASELINE: "the baseline was left out", WITHOUT: "without a baseline that can be used"}
MEND = NextExperiment(
    sentence="Put right what is wrong with the baseline, which was left out, or record the machine in a sound state."
)


def with_none_left(report: Report, *, given: bool, left: bool) -> Report:
    """The report, which does not say that there was no baseline where one was given and none is left."""
    if not given or left:
        return report
    mended = report.next_experiment in (SOUND, SOUND_TOO)
    return replace(
        report,
        sentence=_said(report.sentence),
        undecidable=tuple(_said(text) for text in report.undecidable),
        next_experiment=MEND if mended else report.next_experiment,
    )


def _said(text: str) -> str:
    for none, left_out in WORDS.items():
        text = text.replace(none, left_out)
    return text
