"""Pictures of a stored result; the same result gives the same picture."""

from __future__ import annotations

import io
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from jobs.errors import UnknownArtefact
from jobs.results import ResultReader
from jobs.thinning import highest, min_max

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MAX_POINTS = 6000
_LOCK = threading.Lock()
"""Matplotlib's settings are global to the process."""


def draw(reader: ResultReader, name: str, channel: str, suffix: str) -> bytes:
    """A picture as PNG or SVG. Drawn without the global state of pyplot: several requests may draw at once."""
    import matplotlib as mpl  # noqa: PLC0415  (a tenth of a server's start, for what few requests ask)
    from matplotlib.figure import Figure  # noqa: PLC0415

    figure = Figure(figsize=(10, 4), dpi=110, layout="constrained")
    axes = figure.add_subplot()
    _DRAW[name](axes, reader, channel)
    axes.set_title(channel, loc="left", fontsize=10)
    axes.grid(alpha=0.3)
    stream = io.BytesIO()
    # The date and random element names would make every drawing of the same result differ.
    with _LOCK, mpl.rc_context({"svg.hashsalt": "sideband", "svg.fonttype": "none"}):
        figure.savefig(stream, format=suffix, metadata={"Date": None} if suffix == "svg" else {"Software": None})
    return stream.getvalue()


def default_channel(reader: ResultReader) -> str:
    """The first acceleration that has a spectrum, or simply the first channel."""
    with_spectrum = {entry.channel for entry in reader.manifest.spectra}
    channels = reader.manifest.channels
    if not channels:
        raise UnknownArtefact("channel", "any", ())
    chosen = next((c for c in channels if c.quantity == "acceleration" and c.name in with_spectrum), channels[0])
    return chosen.name


def _signal(axes: Axes, reader: ResultReader, channel: str) -> None:
    about = reader.channel(channel)
    values = reader.signal(channel, 0, reader.manifest.samples)
    x, y = min_max(np.arange(values.size) / reader.manifest.sampling_rate_hz, values, MAX_POINTS)
    axes.plot(x, y, linewidth=0.6)
    axes.set_xlabel("time, s")
    axes.set_ylabel(f"{about.quantity}, {about.unit}")


def _spectrum(axes: Axes, reader: ResultReader, channel: str) -> None:
    document = reader.spectrum(channel, "amplitude")
    x, y = highest(document.axis, document.values, MAX_POINTS)
    axes.plot(x, y, linewidth=0.7)
    axes.set_xlabel(f"frequency, {document.axis_unit}")
    axes.set_ylabel(f"amplitude, {document.unit}")


_DRAW: dict[str, Callable[[Axes, ResultReader, str], None]] = {"signal": _signal, "spectrum": _spectrum}
NAMES = tuple(_DRAW)
