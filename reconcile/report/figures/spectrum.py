"""Observed spectrum with the model before and after, and the lines that changed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import numbers, text
from reconcile.report.plot import TOP, Frame, span
from reconcile.report.strict import Plain
from reconcile.verdict import LineChange

MOST_MARKS = 8


def _marks(frame: Frame, lines: Sequence[LineChange]) -> Markup:
    """The largest changes as ticks with names; names that would collide are left to the table."""
    inside = [line for line in lines if frame.x[0] <= line.frequency_hz <= frame.x[1]]
    kept = sorted(inside, key=lambda line: -abs(line.change_db))[:MOST_MARKS]
    parts, taken = [], list[float]()
    for line in kept:
        at = frame.px(line.frequency_hz)
        css = "up" if line.change_db >= 0 else "down"
        parts.append(tag("line", x1=at, x2=at, y1=TOP, y2=TOP + 7, css=f"mark {css}"))
        if all(abs(at - other) > 62 for other in taken):
            taken.append(at)
            parts.append(tag("text", line.label, x=at, y=TOP + 17, css=f"tick mid mark-name {css}"))
    return Markup("".join(parts))


def spectrum(picture: Mapping[str, Plain], lines: Sequence[LineChange]) -> Markup:
    """One panel of `spectra`; `lines` are those of this channel or of no channel in particular."""
    x = numbers(picture.get("frequency_hz"))
    named = (("observed_db", "observed"), ("before_db", "before"), ("after_db", "after"))
    curves = [(numbers(picture.get(key)), css) for key, css in named]
    frame = Frame(x=span(x, pad=0.0), y=span(*(y for y, _ in curves)), x_label="frequency, Hz", y_label="level, dB")
    drawn = [frame.curve(x, y, css) for y, css in curves]
    channel = text(picture.get("channel"))
    here = [line for line in lines if line.channel in ("", channel)]
    return frame.svg(frame.axes(), *drawn, _marks(frame, here), title=f"Spectrum of {channel}")
