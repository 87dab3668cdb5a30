"""Gain of a sensor's path over frequency: what a simulated spectrum passes on its way to the recording."""

from __future__ import annotations

from collections.abc import Mapping

from reconcile.report.markup import Markup
from reconcile.report.pictures import numbers, text
from reconcile.report.plot import Frame, span
from reconcile.report.strict import Plain


def path(picture: Mapping[str, Plain]) -> Markup:
    """One panel of `paths`."""
    frequency, gain = numbers(picture.get("frequency_hz")), numbers(picture.get("gain_db"))
    ends = span(frequency, pad=0.0)
    frame = Frame(x=ends, y=span(gain), x_label="frequency, Hz", y_label="gain, dB", height=180.0, log=ends[0] > 0.0)
    drawn = frame.curve(frequency, gain, "after")
    return frame.svg(frame.axes(), drawn, title=f"Path to {text(picture.get('channel'))}")
