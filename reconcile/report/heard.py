"""Why this place and not its rival: what the sensors hear of each, in words beside the ranking."""

from __future__ import annotations

from collections.abc import Iterator

from reconcile.report.markup import Markup, tag
from reconcile.report.named import readable
from reconcile.verdict import Report

STAGE, KEY = "judge", "heard_less_likely"
LEAST = 0.5
"""Log evidence (1.6 times as likely) below which sensors do not tell two places apart."""


def against_places(report: Report) -> Markup:
    """A line for the effects whose place is less likely by which sensor hears which band; nothing where none is."""
    told = [f"{readable(label)} by {value:.1f}" for label, value in _heard(report) if value >= LEAST]
    if not told:
        return Markup("")
    words = (
        "By which sensor hears which band a place is less likely than another with the same lines: "
        f"{', '.join(told)} of log evidence. The score has it in it."
    )
    return tag("p", words, css="muted")


def _heard(report: Report) -> Iterator[tuple[str, float]]:
    """Effect and place with the log evidence against it, as the stage has them: `outer_spall@bearing4: 8.0`."""
    for stage in report.stages:
        found = stage.get(KEY) if stage.get("name") == STAGE else None
        for row in found if isinstance(found, (list, tuple)) else ():
            label, _, value = str(row).rpartition(": ")
            yield label, float(value)
