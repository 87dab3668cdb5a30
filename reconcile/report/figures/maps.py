"""Maps of coloured cells: residual over shaft angle and order, force over displacement and velocity."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

from reconcile.report.figures.colour import diverging
from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.pictures import numbers, rows, text
from reconcile.report.plot import TOP, Frame
from reconcile.report.strict import Plain
from reconcile.verdict import AngleWindow

MOST_CELLS = 6000
LEGEND_STEPS = 21


def _edges(places: Sequence[float]) -> list[float]:
    """Borders half way between the places."""
    if len(places) == 1:
        return [places[0] - 0.5, places[0] + 0.5]
    inner = [0.5 * (a + b) for a, b in pairwise(places)]
    return [2 * places[0] - inner[0], *inner, 2 * places[-1] - inner[-1]]


def _coarse(x: list[float], y: list[float], table: list[list[float]]) -> tuple[list[float], list[list[float]]]:
    """Every n-th column where there are too many cells for a page."""
    step = max(1, math.ceil(len(x) * len(y) / MOST_CELLS))
    return x[::step], [row[::step] for row in table]


def _legend(frame: Frame, limit: float, label: str) -> Markup:
    left, width = frame.width - 200.0, 120.0
    cell = width / LEGEND_STEPS
    shares = [2.0 * k / (LEGEND_STEPS - 1) - 1.0 for k in range(LEGEND_STEPS)]
    cells = [
        tag("rect", x=left + k * cell, y=2.0, width=cell + 0.5, height=8.0, fill=diverging(s))
        for k, s in enumerate(shares)
    ]
    ends = tag("text", f"-{figure_text(limit)}", x=left - 4, y=10, css="tick end")
    more = tag("text", figure_text(limit), x=left + width + 4, y=10, css="tick")
    return Markup("".join([*cells, ends, more, tag("text", label, x=left - 50, y=10, css="tick end")]))


def _cells(frame: Frame, x: Sequence[float], y: Sequence[float], table: Sequence[Sequence[float]], limit: float) -> str:
    across, up = _edges(x), _edges(y)
    parts = []
    for j, row in enumerate(table[: len(y)]):
        for i, value in enumerate(row[: len(x)]):
            if not math.isfinite(value):
                continue
            left, right = frame.px(across[i]), frame.px(across[i + 1])
            top, bottom = frame.py(up[j + 1]), frame.py(up[j])
            fill = diverging(value / limit)
            parts.append(tag("rect", x=left, y=top, width=right - left + 0.3, height=bottom - top + 0.3, fill=fill))
    return "".join(parts)


def _map(picture: Mapping[str, Plain], keys: tuple[str, str], labels: tuple[str, str, str], title: str) -> Markup:
    x, y, table = numbers(picture.get(keys[0])), numbers(picture.get(keys[1])), rows(picture.get("value"))
    if not x or not y or not table:
        return Markup("")
    x, table = _coarse(x, y, table)
    limit = max((abs(v) for row in table for v in row if math.isfinite(v)), default=1.0) or 1.0
    across, up = _edges(x), _edges(y)
    frame = Frame(x=(across[0], across[-1]), y=(up[0], up[-1]), x_label=labels[0], y_label=labels[1], height=280.0)
    cells = Markup(_cells(frame, x, y, table, limit))
    return frame.svg(cells, frame.axes(), _legend(frame, limit, labels[2]), title=title)


def heat(picture: Mapping[str, Plain], window: AngleWindow | None) -> Markup:
    """A panel of `heat`, with the located window of the revolution as a bar."""
    shaft = text(picture.get("shaft"))
    drawn = _map(picture, ("angle_deg", "order"), (f"angle of {shaft}, degrees", "order", "dB"), f"Residual on {shaft}")
    if window is None or window.shaft != shaft or not drawn:
        return drawn
    angles = numbers(picture.get("angle_deg"))
    across = _edges(_coarse(angles, numbers(picture.get("order")), [])[0])
    frame = Frame(x=(across[0], across[-1]), y=(0, 1), x_label="", y_label="", height=280.0)
    pieces = [(window.low_deg % 360.0, window.high_deg % 360.0)]
    if pieces[0][0] > pieces[0][1]:
        pieces = [(0.0, pieces[0][1]), (pieces[0][0], 360.0)]
    bars = [
        tag("rect", x=frame.px(a), y=TOP - 4, width=max(frame.px(b) - frame.px(a), 2.0), height=4.0, css="window")
        for a, b in pieces
    ]
    return Markup(drawn[: -len("</svg>")] + "".join(bars) + "</svg>")


def force_map(picture: Mapping[str, Plain]) -> Markup:
    """A panel of `force_map`."""
    labels = (text(picture.get("x_label")), text(picture.get("y_label")), text(picture.get("value_label")))
    return _map(picture, ("x", "y"), labels, f"Force over {labels[0]} and {labels[1]}")
