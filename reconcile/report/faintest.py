"""Section of the page: what such recordings would have shown, where nothing is missing."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.sections import section, table
from reconcile.verdict import Faintest, Report

EXPLAINED = (
    "Every effect was simulated at some eight sizes, with the rest of its numbers drawn, on machines of this kind and "
    "heard through these sensors with their noise. A cell is the smallest size from which all were told from a sound "
    "machine by the pattern or the strength of the change; behind it how many of all sizes were. What lies below, or "
    "stands under “not told”, may be there unseen: “nothing missing” does not speak of it."
)
STRIKING = (
    "* strikes once each time it passes: such impacts are looked for apart, and mostly tell far smaller ones than the "
    "table, which is of patterns and strengths alone. "
    "A spall outside the load zone shows nothing at any size."
)


def faintest(report: Report) -> Markup:
    """One row an effect: where it would have been told from which size on, and where not up to which."""
    if not report.faintest:
        return Markup("")
    effects: dict[str, list[Faintest]] = {}
    for one in report.faintest:
        effects.setdefault(one.term, []).append(one)
    rows = [_row(found) for found in sorted(effects.values(), key=_worst)]
    heads = ("effect, its size", "told from", "not told, up to")
    notes = [STRIKING] if any(one.strikes for one in report.faintest) else []
    explained = tag("p", EXPLAINED, css="muted")
    return section(
        "What would have been seen", explained, *(tag("p", n, css="muted") for n in notes), table(heads, rows)
    )


def _worst(found: Sequence[Faintest]) -> tuple[float, str]:
    """Effects that are told least come first."""
    return sum(one.seen for one in found) / sum(one.simulated for one in found), found[0].term


def _row(found: Sequence[Faintest]) -> tuple[str, str, str]:
    first = found[0]
    mark = "*" if first.strikes else ""
    told_at = [f"{f.site} {_size(f.seen_from, f)}{_count(f)}" for f in found if f.seen_from is not None]
    not_at = [f"{f.site} {_size(f.largest, f)}{_count(f)}" for f in found if f.seen_from is None]
    name = f"{first.term.replace('_', ' ')}{mark}, {first.name.replace('_', ' ')}"
    return name, ", ".join(told_at) or "–", ", ".join(not_at) or "–"


def _size(value: float, found: Faintest) -> str:
    return figure_text(value, found.unit, digits=2)


def _count(found: Faintest) -> str:
    return f" ({found.seen} of {found.simulated} sizes)"
