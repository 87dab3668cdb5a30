"""Held-out data before and after: how far the model is off, what the answer and its rivals take off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from reconcile.report.figures.bars import NAME_WIDTH, row_name
from reconcile.report.markup import Markup, tag
from reconcile.report.plot import BOTTOM, TOP, Frame, ticks
from reconcile.report.words import distance, gain, percent, reached, strongest_placebo
from reconcile.verdict import HeldOut

ROW = 26.0
LOWEST = -0.5
"""Gains below are cut off, their figure tells them."""
REACHED = "expected of a perfect model"


@dataclass(frozen=True, kw_only=True)
class _Bar:
    name: str
    value: float
    said: str
    css: str = "rival"
    ends: tuple[float, float] | None = None


def _bar(frame: Frame, at: float, bar: _Bar) -> list[Markup]:
    """From zero to the value, with its interval and its figure behind both."""
    zero, end = frame.px(0.0), frame.px(bar.value)
    left, right = min(zero, end), max(zero, end)
    parts = [
        row_name(frame, at, bar.name, bar.css),
        tag("rect", x=left, y=at - 8, width=max(right - left, 1.0), height=16.0, css=f"bar {bar.css}"),
    ]
    if bar.ends is not None and all(math.isfinite(e) for e in bar.ends):
        low, high = (frame.px(e) for e in bar.ends)
        parts.append(tag("line", x1=low, x2=high, y1=at, y2=at, css="whisker"))
        parts += [tag("line", x1=e, x2=e, y1=at - 5, y2=at + 5, css="whisker") for e in (low, high)]
        right = max(right, high)
    parts.append(tag("text", bar.said, x=right + 6, y=at + 4, css="tick said"))
    return parts


def _panel(
    bars: Sequence[_Bar], x: tuple[float, float], label: str, limit: _Bar | None, title: str, whole: float = math.inf
) -> Markup:
    """Bars over one axis; `limit`: what a perfect model would reach, as a line through all of them; `whole`: where the
    figures of the axis end."""
    height = TOP + BOTTOM + ROW * (len(bars) + 0.7)
    at_most = [v for v in ticks(*x, about=8) if v <= whole]
    frame = Frame(x=x, y=(0.0, 1.0), x_label=label, y_label="", height=height, left=NAME_WIDTH, x_ticks=at_most)
    zero, bottom = frame.px(0.0), height - BOTTOM
    parts = [frame.axes(y_ticks=False), tag("line", x1=zero, x2=zero, y1=TOP, y2=bottom, css="zero")]
    if limit is not None and math.isfinite(limit.value):
        at = frame.px(limit.value)
        parts.append(tag("line", x1=at, x2=at, y1=TOP + 6, y2=bottom, css="ceiling"))
        place, side = (at - 6, "end") if at > 0.6 * frame.width else (at + 6, "")
        parts.append(tag("text", f"{limit.name}: {limit.said}", x=place, y=TOP + 14, css=f"tick ceiling-name {side}"))
    for i, bar in enumerate(bars):
        parts += _bar(frame, TOP + ROW * (i + 1.2), bar)
    return frame.svg(*parts, title=title)


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
    label = f"how far the model is off on data never fitted, {unit} (less is better)"
    most = max(bar.value for bar in bars) or 1.0
    return _panel(bars, (0.0, 1.2 * most), label, limit, "Held-out data without and with the answer")


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
    x = max(min(0.0, *finite), 100 * LOWEST), 1.6 * max(10.0, *finite)
    return _panel(
        bars,
        x,
        "share of that error taken off, % (more is better)",
        limit,
        "Gain of the answer and of its rivals",
        100.0,
    )


def _ends(found: HeldOut) -> tuple[float, float]:
    return 100 * found.gain_low, 100 * found.gain_high
