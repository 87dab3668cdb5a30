"""Rows with intervals: the ranking of candidates, and the features that changed."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from reconcile.report.markup import Markup, tag
from reconcile.report.named import readable
from reconcile.report.pictures import number, text
from reconcile.report.plot import BOTTOM, TOP, Frame, fitting, span, text_width
from reconcile.report.strict import Plain

MOST_ROWS = 30
MARGIN = 8.0
NARROWEST = 0.7
"""Share of its width to which a name is squeezed before it is cut."""


@dataclass(frozen=True, kw_only=True)
class Rows:
    """How rows with names are laid out: names left of the axes, or `above` each row where the screen is narrow."""

    css: str
    width: float
    left: float
    row: float
    above: bool = False

    def frame(self, x: tuple[float, float], height: float, label: str, x_ticks: Sequence[float] = ()) -> Frame:
        """Axes beside the names; rows have no figures of their own."""
        return Frame(
            x=x, y=(0.0, 1.0), x_label=label, y_label="", width=self.width, height=height, left=self.left,
            x_ticks=x_ticks,
        )  # fmt: skip

    def name(self, at: float, name: str, css: str = "") -> Markup:
        """A row's name, squeezed or cut to fit; whole where one rests on it."""
        if self.above:
            x, y, place, room = MARGIN, at - 12, "said", self.width - 2 * MARGIN
        else:
            x, y, place, room = self.left - MARGIN, at + 4, "end", self.left - 2 * MARGIN
        bold = css == "named"
        squeezed: dict[str, object] = {}
        if room < text_width(name, bold=bold) <= room / NARROWEST:
            squeezed = {"textLength": f"{room:g}", "lengthAdjust": "spacingAndGlyphs"}
        shown = name if squeezed else fitting(name, room, bold=bold)
        return tag("text", shown, tag("title", name), x=x, y=y, css=f"row-name {place} {css}", **squeezed)


WIDE = Rows(css="plot wide", width=720.0, left=285.0, row=22.0)
NARROW = Rows(css="plot narrow", width=360.0, left=16.0, row=42.0, above=True)


def for_screens(draw: Callable[[Rows], Markup]) -> Markup:
    """The panel twice: the page shows the one that its width has room for."""
    return Markup(draw(WIDE) + draw(NARROW))


def _frame(values: Sequence[float], count: int, label: str, rows: Rows) -> Frame:
    return rows.frame(span([*values, 0.0]), TOP + BOTTOM + rows.row * count, label)


def _row_at(place: int, rows: Rows) -> float:
    """Height of the mark of a row: in its middle, or below its name."""
    return TOP + rows.row * (place + (0.72 if rows.above else 0.5))


def _interval(frame: Frame, at: float, low: float, high: float, css: str) -> Markup:
    if not (math.isfinite(low) and math.isfinite(high)):
        return Markup("")
    return tag("line", x1=frame.px(low), x2=frame.px(high), y1=at, y2=at, css=f"interval {css}")


def _zero(frame: Frame) -> Markup:
    at = frame.px(0.0)
    return tag("line", x1=at, x2=at, y1=TOP, y2=frame.height - BOTTOM, css="zero")


def _with_forms(kept: Sequence[Mapping[str, Plain]]) -> list[tuple[str, Mapping[str, Plain]]]:
    """Names and rows; other forms of an effect follow the one they count with, as `or: ...`."""
    labels = {text(item.get("label")) for item in kept}
    ordered: list[tuple[str, Mapping[str, Plain]]] = []
    for item in kept:
        if text(item.get("form_of")) in labels:
            continue
        label = text(item.get("label"))
        ordered.append((readable(label), item))
        ordered += [(f"or: {readable(text(f.get('label')))}", f) for f in kept if label and f.get("form_of") == label]
    return ordered


def ranking(pictures: Sequence[Mapping[str, Plain]]) -> Markup:
    """`ranking` as dots with 90 % intervals, the best first, other forms under theirs; what may be named is filled."""
    kept = _with_forms(sorted(pictures, key=lambda p: -number(p.get("score"), -math.inf))[:MOST_ROWS])
    return for_screens(lambda rows: _ranking(kept, rows))


def _ranking(kept: Sequence[tuple[str, Mapping[str, Plain]]], rows: Rows) -> Markup:
    values = [number(p.get(key)) for _, p in kept for key in ("score", "low", "high")]
    frame = _frame(values, len(kept), "score: log evidence over nothing missing", rows)
    parts = [frame.axes(y_ticks=False), _zero(frame)]
    for i, (name, item) in enumerate(kept):
        at = _row_at(i, rows)
        css = "named" if item.get("named") is True else "other"
        parts += [rows.name(at, name, css)]
        parts += [_interval(frame, at, number(item.get("low")), number(item.get("high")), css)]
        score = number(item.get("score"))
        if math.isfinite(score):
            parts += [tag("circle", cx=frame.px(score), cy=at, r=4.5, css=f"dot {css}")]
    return frame.svg(*parts, title="Candidates by predictive score", css=rows.css)


def changes(pictures: Sequence[Mapping[str, Plain]]) -> Markup:
    """`changes`: observed change as a dot, the null's band behind it, what the answer gives as a bar."""
    kept = sorted(pictures, key=lambda p: -abs(number(p.get("observed_db"), 0.0)))[:MOST_ROWS]
    return for_screens(lambda rows: _changes(kept, rows))


def _changes(kept: Sequence[Mapping[str, Plain]], rows: Rows) -> Markup:
    values = [number(p.get(key)) for p in kept for key in ("observed_db", "low", "high", "fitted_db")]
    frame = _frame(values, len(kept), "change against what was expected, dB", rows)
    parts = [frame.axes(y_ticks=False), _zero(frame)]
    for i, item in enumerate(kept):
        at = _row_at(i, rows)
        observed, fitted = number(item.get("observed_db")), number(item.get("fitted_db"))
        parts += [rows.name(at, text(item.get("feature")))]
        parts += [_interval(frame, at, number(item.get("low")), number(item.get("high")), "null")]
        if math.isfinite(fitted):
            x = frame.px(fitted)
            parts += [tag("line", x1=x, x2=x, y1=at - 7, y2=at + 7, css="fitted")]
        if math.isfinite(observed):
            parts += [tag("circle", cx=frame.px(observed), cy=at, r=4.0, css="dot observed-dot")]
    return frame.svg(*parts, title="Features that changed", css=rows.css)
