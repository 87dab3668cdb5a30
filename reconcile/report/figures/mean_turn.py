"""The mean turn of a gear: how much of what comes back with every turn sits at each of its angles."""

from __future__ import annotations

import math
from collections.abc import Mapping

from reconcile.report.figures.maps import QUARTERS, window_bar
from reconcile.report.markup import Markup
from reconcile.report.pictures import number, numbers, text
from reconcile.report.plot import Frame, span
from reconcile.report.strict import Plain
from reconcile.verdict import AngleWindow

KEYS = (("test", "observed"), ("baseline", "before"))


def mean_turn(picture: Mapping[str, Plain], window: AngleWindow | None) -> Markup:
    """One panel of `mean_turn`; nothing where the test's curve is missing. The window of that shaft is a bar above."""
    angle = numbers(picture.get("angle_deg"))
    curves = [(css, numbers(picture.get(f"{key}_db"))) for key, css in reversed(KEYS)]
    drawn = [(css, y) for css, y in curves if any(math.isfinite(v) for v in y)]
    if not any(css == "observed" for css, _ in drawn):
        return Markup("")
    frame = Frame(
        x=(0.0, 360.0),
        y=span(*(y for _, y in drawn)),
        x_label=f"angle of {text(picture.get('shaft'), 'the shaft')}, degrees",
        y_label="over the middle of the turn, dB",
        x_ticks=QUARTERS,
    )
    shaft = text(picture.get("shaft"))
    bar = window_bar(frame, window) if window is not None and window.shaft == shaft else Markup("")
    lines = (frame.curve(angle, y, css) for css, y in drawn)
    return frame.svg(frame.axes(), *lines, bar, title=f"Mean turn of {text(picture.get('gear'))}")


def turn_words(picture: Mapping[str, Plain]) -> str:
    """What is drawn, in words."""
    turns, pitch = number(picture.get("turns")), number(picture.get("window_deg"))
    words = (
        f"{text(picture.get('gear'))}, mean of {turns:.0f} turns at {number(picture.get('speed_hz')):.4g} Hz of the "
        "drive shaft, all sensors and bands together without the lines of the teeth, in windows of "
        f"{pitch:.2g} degrees. Angles count from {text(picture.get('start'), 'the first sample')}"
    )
    if "baseline_db" in picture and not picture.get("same_start"):
        return f"{words}; those of the baseline from its own: only how far it stands out is to be compared."
    return f"{words}."
