"""Observed spectrum with the model before and after, and the lines that changed."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

from reconcile.report.formula import drawn_formula
from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import number, numbers, text
from reconcile.report.plot import TOP, Frame, span
from reconcile.report.strict import Plain
from reconcile.verdict import LineChange

MOST_MARKS = 8
ONE_PLACE = 2.0
"""Pixels within which lines stand at one place."""
OR = " or "
LETTER = 7.0
"""Width of a letter, pixels."""
HEADROOM = 0.12
"""Share of the height that is kept for the names of lines."""
BELOW_FLOOR = 20.0
"""Decibels under the lowest measured level down to which is drawn: what a model says below that nobody measured."""
WIDE = 30.0
"""Highest over lowest frequency from which on their axis is logarithmic, as third octaves want it."""


def in_third_octaves(frequency_hz: Sequence[float]) -> bool:
    """Whether a spectrum's values are levels of third octaves: each centre a third of an octave above the last."""
    pairs = list(pairwise(frequency_hz))
    return bool(pairs) and all(a > 0.0 and abs(math.log2(b / a) - 1.0 / 3.0) < 0.01 for a, b in pairs)


def _marks(frame: Frame, lines: Sequence[LineChange]) -> Markup:
    """The largest changes as ticks with names, of lines at one place all of them; names that would collide are left to
    the table."""
    inside = [line for line in lines if frame.x[0] <= line.frequency_hz <= frame.x[1]]
    kept = sorted(inside, key=lambda line: -abs(line.change_db))[:MOST_MARKS]
    parts, taken = [], list[tuple[float, float]]()
    for line in kept:
        at = frame.px(line.frequency_hz)
        css = "up" if line.change_db >= 0 else "down"
        parts.append(tag("line", x1=at, x2=at, y1=TOP, y2=TOP + 7, css=f"mark {css}"))
        name = OR.join(
            dict.fromkeys(drawn_formula(x.label) for x in kept if abs(frame.px(x.frequency_hz) - at) <= ONE_PLACE)
        )
        half = 0.5 * LETTER * len(name)
        middle = min(max(at, frame.left + half), max(frame.width - half, frame.left + half))
        if all(abs(middle - other) > half + room for other, room in taken):
            taken.append((middle, half))
            parts.append(tag("text", name, x=middle, y=TOP + 17, css=f"tick mid said mark-name {css}"))
    return Markup("".join(parts))


def spectrum(picture: Mapping[str, Plain], lines: Sequence[LineChange]) -> Markup:
    """One panel of `spectra`; of `lines` those of this channel and operating point, or of none in particular."""
    x = numbers(picture.get("frequency_hz"))
    named = (("observed_db", "observed"), ("before_db", "before"), ("after_db", "after"))
    curves = [(numbers(picture.get(key)), css) for key, css in named]
    ends, (low, high) = span(x, pad=0.0), span(*(y for y, _ in curves))
    low = max(low, min((y for y in curves[0][0] if math.isfinite(y)), default=low) - BELOW_FLOOR)
    thirds = in_third_octaves(x)
    over = f" re {text(picture.get('reference'))}" if picture.get("reference") else ""
    frame = Frame(
        x=ends,
        y=(low, high + HEADROOM * (high - low)),
        x_label="centre of the third octave, Hz" if thirds else "frequency, Hz",
        y_label=f"level of the third octave, dB{over}" if thirds else f"level, dB{over}",
        log=0.0 < WIDE * ends[0] <= ends[1],
    )
    drawn = [frame.curve(x, y, css) for y, css in curves]
    channel = text(picture.get("channel"))
    here = [line for line in lines if line.channel in ("", channel) and _at_point(line, picture)]
    return frame.svg(
        frame.axes(), *drawn, _marks(frame, here), title=f"{'Third-octave s' if thirds else 'S'}pectrum of {channel}"
    )


def _at_point(line: LineChange, picture: Mapping[str, Plain]) -> bool:
    if line.speed_hz is None or picture.get("speed_hz") is None:
        return True
    return (line.speed_hz, line.torque_ratio) == (picture["speed_hz"], number(picture.get("torque_ratio"), 1.0))
