"""The section of overall levels: what every hand-held instrument shows, before and now."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.pictures import several, text
from reconcile.report.sections import section, table
from reconcile.report.strict import Plain
from reconcile.verdict import Report

SHOWN = 48
NOTE = (
    "Root mean square of the whole record. It tells that something changed, not what: resonances, speed and load move "
    "it as well."
)
ELSEWHERE = " Where no baseline stands, none was recorded at that speed and load."
VELOCITY = " Velocity: between 10 and 1000 Hz, the quantity of ISO 20816-1."


def overall(report: Report) -> Markup:
    """A row for each channel and operating point; nothing without recordings' levels."""
    rows = [row for row in several(report.pictures, "levels") if _number(row.get("now")) is not None]
    if not rows:
        return Markup("")
    based = any(_number(row.get("before")) is not None for row in rows)
    moving = any(_number(row.get("velocity_now")) is not None for row in rows)
    heads = ["channel", "operating point, as stated", *(["baseline"] if based else []), "now"]
    heads += ["change"] if based else []
    if moving:
        heads += [*(["velocity, baseline"] if based else []), "velocity, now"]
    body = [_row(row, based, moving) for row in rows[:SHOWN]]
    more = f" {len(rows) - SHOWN} further rows are in report.json." if len(rows) > SHOWN else ""
    away = ELSEWHERE if any(row.get("elsewhere") is True for row in rows) else ""
    note = tag("p", f"{NOTE}{away}{VELOCITY if moving else ''}{more}", css="muted")
    return section("Overall level", table(heads, body), note)


def _row(row: Mapping[str, Plain], based: bool, moving: bool) -> Sequence[str]:
    unit = text(row.get("unit"))
    before, now = _number(row.get("before")), _number(row.get("now"))
    cells = [text(row.get("channel")), text(row.get("at"))]
    cells += [*([_level(before, unit)] if based else []), _level(now, unit), *([_change(before, now)] if based else [])]
    if moving:
        velocities = [_number(row.get("velocity_before")), _number(row.get("velocity_now"))]
        told = [_level(None if v is None else 1e3 * v, "mm/s") for v in velocities]
        cells += told if based else told[1:]
    return cells


def _level(value: float | None, unit: str) -> str:
    return "–" if value is None else f"{figure_text(value)} {unit.replace('^2', '²')}".strip()


def _change(before: float | None, now: float | None) -> str:
    """As a factor and in decibels."""
    if before is None or now is None or before <= 0.0 or now <= 0.0:
        return "–"
    ratio = now / before
    return f"{figure_text(ratio)} times ({20.0 * math.log10(ratio):+.1f} dB)"


def _number(value: object) -> float | None:
    return float(value) if isinstance(value, int | float) and math.isfinite(value) else None
