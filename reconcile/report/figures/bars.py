"""Rows with intervals: the ranking of candidates, and the features that changed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import number, text
from reconcile.report.plot import BOTTOM, TOP, Frame, span
from reconcile.report.strict import Plain
from reconcile.report.words import readable

ROW, NAME_WIDTH, MOST_ROWS = 22.0, 250.0, 30
LONGEST_NAME = 38


def _frame(values: Sequence[float], count: int, label: str) -> Frame:
    return Frame(
        x=span([*values, 0.0]),
        y=(0.0, float(count)),
        x_label=label,
        y_label="",
        height=TOP + BOTTOM + ROW * count,
        left=NAME_WIDTH,
    )


def row_name(frame: Frame, at: float, name: str, css: str = "") -> Markup:
    """A row's name left of the axes, cut to fit; whole where one rests on it."""
    shown = name if len(name) <= LONGEST_NAME else f"{name[: LONGEST_NAME - 1]}…"
    return tag("text", shown, tag("title", name), x=frame.left - 8, y=at + 4, css=f"row-name end {css}")


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
    values = [number(p.get(key)) for _, p in kept for key in ("score", "low", "high")]
    frame = _frame(values, len(kept), "score: log evidence over nothing missing")
    parts = [frame.axes(y_ticks=False), _zero(frame)]
    for i, (name, item) in enumerate(kept):
        at = TOP + ROW * (i + 0.5)
        css = "named" if item.get("named") is True else "other"
        parts += [row_name(frame, at, name, css)]
        parts += [_interval(frame, at, number(item.get("low")), number(item.get("high")), css)]
        score = number(item.get("score"))
        if math.isfinite(score):
            parts += [tag("circle", cx=frame.px(score), cy=at, r=4.5, css=f"dot {css}")]
    return frame.svg(*parts, title="Candidates by predictive score")


def changes(pictures: Sequence[Mapping[str, Plain]]) -> Markup:
    """`changes`: observed change as a dot, the null's band behind it, what the answer gives as a bar."""
    kept = sorted(pictures, key=lambda p: -abs(number(p.get("observed_db"), 0.0)))[:MOST_ROWS]
    values = [number(p.get(key)) for p in kept for key in ("observed_db", "low", "high", "fitted_db")]
    frame = _frame(values, len(kept), "change against what was expected, dB")
    parts = [frame.axes(y_ticks=False), _zero(frame)]
    for i, item in enumerate(kept):
        at = TOP + ROW * (i + 0.5)
        observed, fitted = number(item.get("observed_db")), number(item.get("fitted_db"))
        parts += [row_name(frame, at, text(item.get("feature")))]
        parts += [_interval(frame, at, number(item.get("low")), number(item.get("high")), "null")]
        if math.isfinite(fitted):
            x = frame.px(fitted)
            parts += [tag("line", x1=x, x2=x, y1=at - 7, y2=at + 7, css="fitted")]
        if math.isfinite(observed):
            parts += [tag("circle", cx=frame.px(observed), cy=at, r=4.0, css="dot observed-dot")]
    return frame.svg(*parts, title="Features that changed")
