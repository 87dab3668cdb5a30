"""A size whose interval is so wide that it is next to none: said among what is undecided, with what would narrow it."""

from __future__ import annotations

from dataclasses import replace

from reconcile.report.markup import figure_text
from reconcile.report.words import cause, size_name, sizes
from reconcile.verdict import Cause, NextExperiment, Report

WIDE = 8.0
"""Upper over lower end of a 90 % interval, from which on a size is known to a factor only."""

NARROWS = (
    "Record at one or two more speeds or loads, with a baseline each: a size shows in how the change grows with them, "
    "and at one operating point a resonance may pass for it."
)


def with_wide(report: Report) -> Report:
    """The report, which says of each named effect whose size is known no better than to a factor of `WIDE` that it is
    so; of a size that only has an upper bound the report says that already."""
    told = tuple(_said(c) for c in report.causes if c.named and factor(c) >= WIDE)
    if not told:
        return report
    advice = report.next_experiment or NextExperiment(sentence=NARROWS)
    return replace(report, undecidable=(*report.undecidable, *told), next_experiment=advice)


def factor(found: Cause) -> float:
    """Upper over lower end of the interval of the size; 1 where there is no size, or an end of it is 0."""
    size = found.severity
    if size is None or size.low * size.high <= 0.0:
        return 1.0
    ends = sorted((abs(size.low), abs(size.high)))
    return ends[1] / ends[0]


def _said(found: Cause) -> str:
    assert found.severity is not None
    _, low, high = sizes(found.severity)
    what = f"the {size_name(found) or 'size'} of {cause(found)}"
    return f"{what}, known to a factor of {figure_text(factor(found), digits=2)} only (90 %: {low} to {high})"
