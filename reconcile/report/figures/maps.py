"""Maps of coloured cells: residual over shaft angle and order, force over displacement and velocity."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import median

from reconcile.report.figures.colour import diverging
from reconcile.report.markup import Markup, figure_text, tag
from reconcile.report.pictures import numbers, rows, text
from reconcile.report.plot import BOTTOM, LEFT, TOP, Frame, fitting
from reconcile.report.strict import Plain
from reconcile.verdict import AngleWindow

MOST_CELLS = 6000
LEGEND_STEPS = 21
LETTER = 7.0
"""Width of a letter of the legend, pixels."""
SHADES = 24
"""Steps of the colour to either side."""
NAMES = 215.0
"""Room for the names of rows, pixels."""
LEAST_VARYING_DB = 3.0
"""Least difference over a turn that is drawn of a sensor, or"""
STANDS_OUT, LEAST_SEEN_DB = 10.0, 0.1
"""what is so many times the median deviation, and so much at least: of noise alone the difference is seven times it."""
QUARTERS = tuple(45.0 * k for k in range(9))


@dataclass(frozen=True, kw_only=True)
class _Labels:
    """What the axes and the colours are, and the names of the rows where they have no numbers."""

    x: str
    y: str
    value: str
    title: str
    rows: tuple[str, ...] = ()


def _edges(places: Sequence[float]) -> list[float]:
    """Borders half way between the places."""
    if len(places) == 1:
        return [places[0] - 0.5, places[0] + 0.5]
    inner = [0.5 * (a + b) for a, b in pairwise(places)]
    return [2 * places[0] - inner[0], *inner, 2 * places[-1] - inner[-1]]


def _coarse(
    x: list[float], y: list[float], table: list[list[float]], most: int
) -> tuple[list[float], list[list[float]]]:
    """Every n-th column where there are too many cells for a page."""
    step = max(1, math.ceil(len(x) * len(y) / most))
    return x[::step], [row[::step] for row in table]


def _legend(frame: Frame, limit: float, label: str) -> Markup:
    left, width = frame.width - 200.0, 120.0
    cell = width / LEGEND_STEPS
    shares = [2.0 * k / (LEGEND_STEPS - 1) - 1.0 for k in range(LEGEND_STEPS)]
    cells = [
        tag("rect", x=left + k * cell, y=2.0, width=cell + 0.5, height=7.0, fill=diverging(s))
        for k, s in enumerate(shares)
    ]
    lowest = f"-{figure_text(limit)}"
    ends = tag("text", lowest, x=left - 4, y=10, css="tick end")
    more = tag("text", figure_text(limit), x=left + width + 4, y=10, css="tick")
    before = left - 4 - LETTER * (len(lowest) + 1)
    return Markup("".join([*cells, ends, more, tag("text", label, x=before, y=10, css="tick end")]))


def _cells(frame: Frame, x: Sequence[float], y: Sequence[float], table: Sequence[Sequence[float]], limit: float) -> str:
    """Cells of one shade are one path: a map takes a quarter of the room."""
    across, up = _edges(x), _edges(y)
    shades = dict[str, list[str]]()
    for j, row in enumerate(table[: len(y)]):
        top, bottom = frame.py(up[j + 1]), frame.py(up[j])
        for i, value in enumerate(row[: len(x)]):
            if not math.isfinite(value):
                continue
            left, right = frame.px(across[i]), frame.px(across[i + 1])
            width, height = right - left + 0.3, bottom - top + 0.3
            fill = diverging(round(SHADES * value / limit) / SHADES)
            cell = f"M{left:.1f} {top:.1f}h{width:.1f}v{height:.1f}h-{width:.1f}z"
            shades.setdefault(fill, []).append(cell)
    return "".join(tag("path", d="".join(cells), fill=fill) for fill, cells in shades.items())


def _row_names(frame: Frame, names: Sequence[str]) -> Markup:
    parts = []
    for i, name in enumerate(names):
        shown = fitting(name, frame.left - 10)
        at = frame.py(i + 1.0) + 4
        parts.append(tag("text", shown, tag("title", name), x=frame.left - 6, y=at, css="tick end"))
    return Markup("".join(parts))


def _map(
    x: list[float],
    y: list[float],
    table: list[list[float]],
    labels: _Labels,
    most: int = MOST_CELLS,
    ends: tuple[float, float] | None = None,
) -> tuple[Frame, Markup] | None:
    """The panel's frame and what is drawn in it."""
    if not x or not y or not table:
        return None
    x, table = _coarse(x, y, table, most)
    limit = max((abs(v) for row in table for v in row if math.isfinite(v)), default=1.0) or 1.0
    across, up = _edges(x), _edges(y)
    turn = "degrees" in labels.x
    frame = Frame(
        x=ends or (across[0], across[-1]),
        y=(up[0], up[-1]),
        x_label=labels.x,
        y_label=labels.y,
        height=TOP + BOTTOM + max(22.0 * len(y), 44.0) if labels.rows else 280.0,
        left=NAMES if labels.rows else LEFT,
        x_ticks=QUARTERS if turn and across[-1] - across[0] > 300.0 else (),
    )
    cells = Markup(_cells(frame, x, y, table, limit))
    names = _row_names(frame, labels.rows[: len(y)])
    return frame, Markup(cells + frame.axes(y_ticks=not labels.rows) + names + _legend(frame, limit, labels.value))


def window_bar(frame: Frame, window: AngleWindow) -> Markup:
    """The located window as a bar along the upper edge, in two pieces where it goes over the pulse."""
    low, high = window.low_deg % 360.0, window.high_deg % 360.0
    pieces = [(low, high)] if low <= high else [(0.0, high), (low, 360.0)]
    return Markup(
        "".join(
            tag("rect", x=frame.px(a), y=TOP, width=max(frame.px(b) - frame.px(a), 2.0), height=5.0, css="window")
            for a, b in pieces
        )
    )


def heat(picture: Mapping[str, Plain], window: AngleWindow | None, most: int = MOST_CELLS) -> Markup:
    """A panel of `heat` of at most so many cells, with the located window of the revolution as a bar."""
    shaft, names = text(picture.get("shaft")), picture.get("rows")
    rows_named = tuple(str(name) for name in names) if isinstance(names, list) else ()
    labels = _Labels(
        x=f"angle of shaft {shaft}, degrees",
        y="sensor" if rows_named else f"order of shaft {shaft}",
        value=text(picture.get("value_label"), "change, dB"),
        title=f"Over the turn of shaft {shaft}",
        rows=rows_named[::-1],
    )
    order, value = numbers(picture.get("order")), rows(picture.get("value"))
    if rows_named:  # the first on top
        order, value = [k + 1.0 for k in range(len(rows_named))], value[::-1]
    drawn = _map(numbers(picture.get("angle_deg")), order, value, labels, most)
    if drawn is None:
        return Markup("")
    frame, inside = drawn
    bar = window_bar(frame, window) if window is not None and window.shaft == shaft else Markup("")
    return frame.svg(inside, bar, title=labels.title)


def varying(picture: Mapping[str, Plain]) -> tuple[dict[str, Plain], int]:
    """The picture of a turn without the sensors that hardly change over it, and how many those are; with no values
    where none is left. A map by order is kept whole or left out whole."""
    values = picture.get("value")
    table = values if isinstance(values, list) else []
    lively = [_lively(_finite(row)) for row in rows(table)]
    names = picture.get("rows")
    if not isinstance(names, list):
        return {**picture, "value": list(table) if any(lively) else []}, 0
    kept = [i for i, alive in enumerate(lively[: len(names)]) if alive]
    return {**picture, "rows": [names[i] for i in kept], "value": [table[i] for i in kept]}, len(names) - len(kept)


def _lively(values: Sequence[float]) -> bool:
    """Whether energies over a turn change much, or stand out at a place of it where they are even elsewhere."""
    if not values:
        return False
    span, middle = max(values) - min(values), median(values)
    even = median([abs(v - middle) for v in values])
    return span >= LEAST_VARYING_DB or span >= max(STANDS_OUT * even, LEAST_SEEN_DB)


def _finite(row: Sequence[float]) -> list[float]:
    return [v for v in row if math.isfinite(v)]


def across(picture: Mapping[str, Plain]) -> tuple[float, float] | None:
    """Ends of the horizontal axis of a map."""
    x = numbers(picture.get("x"))
    return (_edges(x)[0], _edges(x)[-1]) if x else None


def map_words(picture: Mapping[str, Plain]) -> Markup:
    """Title of a force map, and how to read it."""
    x_label, y_label = (text(picture.get(key)).split(",")[0] for key in ("x_label", "y_label"))
    said = f"Mean of the estimated force at each {x_label} and {y_label}; blank where the motion never came."
    return Markup(tag("h3", f"Force over {x_label} and {y_label}") + tag("p", said, css="muted"))


def force_map(picture: Mapping[str, Plain], ends: tuple[float, float] | None = None) -> Markup:
    """A panel of `force_map`, over `ends` where those are given."""
    x_label, y_label = text(picture.get("x_label")), text(picture.get("y_label"))
    labels = _Labels(
        x=x_label,
        y=y_label,
        value=f"force, {text(picture.get('value_label'))}",
        title=f"Force over {x_label} and {y_label}",
    )
    table = rows(picture.get("value"))
    drawn = _map(numbers(picture.get("x")), numbers(picture.get("y")), table, labels, ends=ends)
    return Markup("") if drawn is None else drawn[0].svg(drawn[1], title=labels.title)
