"""The force of an unknown physics by lines: rms over the order, with its 90 % band, one panel an operating point."""

from __future__ import annotations

import math
from dataclasses import dataclass

from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.plot import BOTTOM, Frame
from reconcile.verdict import EstimatedForce, PointForce, operating_point

ARGUMENTS = ("order", "speed_hz", "torque_ratio", "force_n", "low_n", "high_n")
DEEP = 0.3
"""Share of the smallest force told down to which the axis goes: what may be 0 has no end on a logarithmic one."""
WORDS = (
    ("told", "size told: dot, with its 90 % band (a quarter of such lines of made machines were products of others)"),
    ("open", "there may be no force: dashed from the foot to its 90 % upper end, a ring"),
)
WIDTH = 5.0
"""Least ratio of the ends of the horizontal axis, so that a figure stands on it."""
MOST_DECADES = 6.0
"""Of the vertical axis, from its top, unless sizes told need more."""


@dataclass(frozen=True, kw_only=True)
class _Line:
    order: float
    force_n: float
    low_n: float
    high_n: float


def by_lines(force: EstimatedForce) -> Markup:
    """A legend and a panel an operating point, a sentence under each title; nothing where no lines are told."""
    if any(key not in force.samples for key in ARGUMENTS) or not force.samples["order"]:
        return Markup("")
    lines: dict[tuple[float, float], list[_Line]] = {}
    for order, speed, torque, value, low, high in zip(*(force.samples[key] for key in ARGUMENTS), strict=True):
        if order > 0.0 and high > 0.0 and math.isfinite(high):
            lines.setdefault((speed, torque), []).append(_Line(order=order, force_n=value, low_n=low, high_n=high))
    told = [line for own in lines.values() for line in own]
    if not told:
        return Markup("")
    x = _wide(min(line.order for line in told) / 1.3, max(line.order for line in told) * 1.3)
    top = 1.5 * max(line.high_n for line in told)
    foot = max(DEEP * min(line.high_n for line in told), top * 10.0**-MOST_DECADES)
    y = min([foot, *(DEEP * line.low_n for line in told if line.low_n > 0.0)]), top
    spans = [tag("span", tag("i", css=f"k-{css}"), words) for css, words in WORDS]
    sums = {(point.speed_hz, point.torque_ratio): point for point in force.points}
    panels = [_panel(own, operating_point(*at), sums.get(at), x, y) for at, own in sorted(lines.items())]
    return Markup(tag("div", *spans, css="key") + "".join(panels))


def _wide(low: float, high: float) -> tuple[float, float]:
    """The limits, `WIDTH` apart at least."""
    room = math.sqrt(max(WIDTH * low / high, 1.0))
    return low / room, high * room


def summed(point: PointForce) -> str:
    """`12 N rms (90 %: 5 N to 30 N) at 4 lines together`, or the upper end alone."""
    if point.lines == 0:
        return (
            f"no line tells a force for sure: at most {figure_text(point.high_n, digits=2)} N rms of all lines (90 %)"
        )
    ends = f"{figure_text(point.low_n, digits=2)} N to {figure_text(point.high_n, digits=2)} N"
    lines = "1 line" if point.lines == 1 else f"{point.lines} lines together"
    return f"{figure_text(point.force_n, digits=2)} N rms (90 %: {ends}) at {lines}"


def _panel(
    lines: list[_Line], at_point: str, point: PointForce | None, x: tuple[float, float], y: tuple[float, float]
) -> Markup:
    frame = Frame(
        x=x, y=y, x_label="order of the drive shaft", y_label="force rms, N", height=280.0, log=True, log_y=True
    )
    parts = [frame.axes()]
    for line in sorted(lines, key=lambda one: one.low_n > 0.0):
        at, open_ = frame.px(line.order), line.low_n <= 0.0
        foot = frame.height - BOTTOM if open_ else frame.py(line.low_n)
        css = "spread open" if open_ else "spread"
        parts.append(tag("line", x1=at, x2=at, y1=foot, y2=frame.py(line.high_n), css=css))
        size = f"at most {figure_text(line.high_n)}" if open_ else figure_text(line.force_n)
        said = tag("title", f"order {figure_text(line.order)}: {size} N")
        css = "dot" if open_ else "dot told"
        parts.append(tag("circle", said, cx=at, cy=frame.py(line.high_n if open_ else line.force_n), r=3.5, css=css))
    title = f"Force over order at {at_point}"
    words = summed(point) if point is not None else "no line tells a force for sure here"
    return Markup(
        tag("h3", title)
        + tag("p", words, css="muted")
        + frame.svg(*parts, title=f"Estimated force over order at {at_point}")
    )
