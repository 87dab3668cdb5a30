"""Held-out data before and after: how far the model is off, what the answer and its rivals take off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from reconcile.report.figures.bars import Rows, for_screens
from reconcile.report.markup import Markup, tag
from reconcile.report.named import percent
from reconcile.report.plot import BOTTOM, RIGHT, TOP, Frame, text_width, ticks
from reconcile.report.words import distance, gain, reached, strongest_placebo
from reconcile.verdict import HeldOut

AIR = 4.0
"""Of a row, over those of a ranking, pixels."""
LOWEST = -0.5
"""Gains below are cut off, their figure tells them."""
EXPECTED = "expected of a "
REACHED = f"{EXPECTED}perfect model"
GAP, TICK, FOR_THE_LIMIT = 6.0, 11.0, 18.0
"""Pixels: between a bar and its figure, of a figure's letters, of the row with what a perfect model would reach."""


@dataclass(frozen=True, kw_only=True)
class _Bar:
    name: str
    value: float
    said: str
    css: str = "rival"
    ends: tuple[float, float] | None = None


@dataclass(frozen=True, kw_only=True)
class _Axis:
    """What the axis says, wide and narrow, where it begins, ends at least, and where its figures end."""

    labels: tuple[str, str]
    low: float
    high: float
    whole: float = math.inf


def _bar(frame: Frame, at: float, bar: _Bar) -> list[Markup]:
    """From zero to the value, with its interval and its figure behind both."""
    zero, end = frame.px(0.0), frame.px(bar.value)
    left, right = min(zero, end), max(zero, end)
    parts = [tag("rect", x=left, y=at - 8, width=max(right - left, 1.0), height=16.0, css=f"bar {bar.css}")]
    if bar.ends is not None and all(math.isfinite(e) for e in bar.ends):
        low, high = (frame.px(e) for e in bar.ends)
        parts.append(tag("line", x1=low, x2=high, y1=at, y2=at, css="whisker"))
        parts += [tag("line", x1=e, x2=e, y1=at - 5, y2=at + 5, css="whisker") for e in (low, high)]
        right = max(right, high)
    parts.append(tag("text", bar.said, x=right + GAP, y=at + 4, css="tick said"))
    return parts


def _ends_at(bars: Sequence[_Bar], axis: _Axis, rows: Rows) -> float:
    """Where the axis ends so that the figure behind every bar has room."""
    room = rows.width - rows.left - RIGHT
    end = axis.high
    for bar in bars:
        right = max([bar.value, 0.0, *(e for e in bar.ends or () if math.isfinite(e))])
        left_over = room - GAP - text_width(bar.said, size=TICK)
        end = max(end, axis.low + (right - axis.low) * room / max(left_over, 0.25 * room))
    return end


def _panel(bars: Sequence[_Bar], axis: _Axis, limit: _Bar | None, title: str) -> Markup:
    """Bars over one axis; `limit`: what a perfect model would reach, as a line through all of them."""
    return for_screens(lambda rows: _drawn(bars, axis, limit, title, rows))


def _drawn(bars: Sequence[_Bar], axis: _Axis, limit: _Bar | None, title: str, rows: Rows) -> Markup:
    row = rows.row + AIR
    height = TOP + BOTTOM + row * len(bars) + FOR_THE_LIMIT
    x = axis.low, _ends_at(bars, axis, rows)
    at_most = [v for v in ticks(*x, about=5 if rows.above else 8) if v <= axis.whole]
    frame = rows.frame(x, height, axis.labels[rows.above], at_most)
    zero, bottom = frame.px(0.0), height - BOTTOM
    parts = [frame.axes(y_ticks=False), tag("line", x1=zero, x2=zero, y1=TOP, y2=bottom, css="zero")]
    if limit is not None and math.isfinite(limit.value):
        at = frame.px(limit.value)
        said = f"{limit.name.removeprefix(EXPECTED) if rows.above else limit.name}: {limit.said}"
        parts.append(tag("line", x1=at, x2=at, y1=TOP + 6, y2=bottom, css="ceiling"))
        beyond = at + GAP + text_width(said, size=TICK, bold=True) > rows.width
        place, side = (at - GAP, "end") if beyond else (at + GAP, "")
        parts.append(tag("text", said, x=place, y=TOP + 14, css=f"tick ceiling-name {side}"))
    for i, bar in enumerate(bars):
        at = TOP + FOR_THE_LIMIT + row * (i + (0.7 if rows.above else 0.5))
        parts += [rows.name(at, bar.name, bar.css), *_bar(frame, at, bar)]
    return frame.svg(*parts, title=title, css=rows.css)


def distances(found: HeldOut, subject: str) -> Markup:
    """Two bars: how far the model is off without and with the answer, on data it was not fitted to."""
    pairs = ((f"without {subject}", found.before, "off"), (f"with {subject}", found.after, "on"))
    scale, unit = (100.0, "%") if found.unit in ("", "1") else (1.0, found.unit)
    bars = [
        _Bar(name=n, value=scale * v, said=distance(v, found.unit), css=css) for n, v, css in pairs if math.isfinite(v)
    ]
    if not bars:
        return Markup("")
    limit = None
    expected = reached(found)
    if expected is not None:
        left = found.before * (1.0 - expected)
        limit = _Bar(name=REACHED, value=scale * left, said=distance(left, found.unit))
    off = f"off on data never fitted, {unit} (less is better)"
    axis = _Axis(labels=(f"how far the model is {off}", off), low=0.0, high=max(bar.value for bar in bars) or 1.0)
    return _panel(bars, axis, limit, "Held-out data without and with the answer")


def gains(found: HeldOut, subject: str) -> Markup:
    """What share of the distance each takes off: the answer with its 90 % interval, and its rivals."""
    if not math.isfinite(found.gain):
        return Markup("")
    bars = [_Bar(name=f"with {subject}", value=100 * found.gain, said=gain(found), css="on", ends=_ends(found))]
    best = strongest_placebo(found)
    rivals = (
        ("parameters retuned, no effect", found.retuned),
        ("black box with as many numbers", found.black_box),
        ("placebo: the middle of wrong ones", found.placebo),
        ("placebo: the strongest", None if best is None else best.gain),
    )
    for name, share in rivals:
        if share is not None and math.isfinite(share):
            said = percent(share) + (", beyond the scale" if share < LOWEST else "")
            bars.append(_Bar(name=name, value=100 * max(share, LOWEST), said=said))
    expected = reached(found)
    limit = None if expected is None else _Bar(name=REACHED, value=100 * expected, said=percent(expected))
    told = [v for b in bars for v in (b.value, *(b.ends or ()))] + ([limit.value] if limit else [])
    finite = [v for v in told if math.isfinite(v)]
    low, high = max(min(0.0, *finite), 100 * LOWEST), max(10.0, *finite)
    label = "share of that error taken off, % (more is better)"
    axis = _Axis(labels=(label, label), low=low, high=high, whole=100.0)
    return _panel(bars, axis, limit, "Gain of the answer and of its rivals")


def _ends(found: HeldOut) -> tuple[float, float]:
    return 100 * found.gain_low, 100 * found.gain_high
