"""Reports where no line of a test confirms its stated speed and its baseline turns at another one.

A baseline is of the same speed as its test. Where the baseline's lines say how fast it turned and the test's do not, a
stated speed far from that is more likely wrong than right; every order, and so every name, hangs on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.kinematics.observe import Observation
from reconcile.verdict import NextExperiment, Report

APART = 0.05
"""Relative difference of the speeds from which it is doubted: slip of a drive and labels of published rigs stay below,
the 7 % of one rig apart, whose tests show lines of their own."""
SAYS = ("explained", "ambiguous", "unknown_physics")


def speeds_apart(tests: Sequence[Observation], baselines: Sequence[Observation]) -> tuple[float, float] | None:
    """Stated speed of a test that nothing confirms and the confirmed speed of the nearest baseline, Hz, where they lie
    apart in most of the tests; else None."""
    sure = [b.speed.speed_hz for b in baselines if b.speed.method != "stated"]
    if not sure:
        return None
    found = []
    for test in (t for t in tests if t.speed.method == "stated"):
        nearest = min(sure, key=lambda hz, own=test.speed.speed_hz: abs(hz / own - 1.0))  # type: ignore[misc]
        if abs(nearest / test.speed.speed_hz - 1.0) > APART:
            found.append((test.speed.speed_hz, nearest))
    return found[0] if 2 * len(found) > len(tests) else None


def with_speeds(report: Report, tests: Sequence[Observation], baselines: Sequence[Observation]) -> Report:
    """The report, which names nothing where the speeds lie apart."""
    apart = speeds_apart(tests, baselines)
    if apart is None or report.verdict not in SAYS:
        return report
    stated, other = apart
    note = (
        f"whether the test turns at {stated:.4g} Hz as stated: no line confirms it, its baseline is at {other:.4g} Hz"
    )
    return replace(
        report,
        verdict="ambiguous",
        sentence=f"The speed is not decided: no line confirms the stated {stated:.4g} Hz, and the baseline turns at "
        f"{other:.4g} Hz. If it is as stated: {report.sentence}",
        causes=tuple(replace(c, named=False) for c in report.causes),
        undecidable=(note, *report.undecidable),
        next_experiment=NextExperiment(sentence="Record with a tacho, or state the speed the test really had."),
    )
