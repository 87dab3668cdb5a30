"""Held-out signal over time: measured, and as predicted before and after."""

from __future__ import annotations

from collections.abc import Mapping

from reconcile.report.markup import Markup
from reconcile.report.pictures import numbers, text
from reconcile.report.plot import Frame, span
from reconcile.report.strict import Plain


def trace(picture: Mapping[str, Plain]) -> Markup:
    """One panel of `traces`."""
    time = numbers(picture.get("time_s"))
    curves = [(numbers(picture.get(key)), key) for key in ("observed", "before", "after")]
    unit = text(picture.get("unit"))
    frame = Frame(x=span(time, pad=0.0), y=span(*(y for y, _ in curves)), x_label="time, s", y_label=unit)
    drawn = [frame.curve(time, y, css) for y, css in curves]
    return frame.svg(frame.axes(), *drawn, title=text(picture.get("title"), "Held-out signal"))
