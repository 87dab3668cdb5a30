"""What all pictures share: backend, size, saving, choice of cases."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from PIL import Image

from paper.cases import Case, Setting, healthy_of
from paper.run import Result

mpl.use("Agg")
Results = Mapping[Case, Result]
DPI = 80
COLOUR_COUNT = 120
TITLES = {"paper": "paper (tables as written)", "paper-lightly-damped": "paper-lightly-damped"}
COLOURS = {None: "0.25", 0.0: "0.6", 10.0: "tab:blue", 20.0: "tab:green", 30.0: "tab:orange", 50.0: "tab:red"}


def grid(rows: int, columns: int, *, width: float = 12.0, height: float = 3.0) -> tuple[Figure, list[list[Axes]]]:
    """A figure of rows x columns axes with room for labels."""
    figure = Figure(figsize=(width, height * rows), layout="constrained")
    axes = figure.subplots(rows, columns, squeeze=False)
    return figure, [list(row) for row in axes]


def save(figure: Figure, folder: Path, name: str) -> Path:
    """Write a small picture: a palette is enough for lines, and half the bytes."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}.png"
    buffer = BytesIO()
    figure.savefig(buffer, dpi=DPI, format="png")
    Image.open(buffer).convert("RGB").quantize(COLOUR_COUNT).save(path, optimize=True)
    return path


def label(axes: Axes, x: str, y: str, title: str = "") -> None:
    """Axis labels and title."""
    axes.set_xlabel(x, fontsize=8)
    axes.set_ylabel(y, fontsize=8)
    axes.set_title(title, fontsize=9)
    axes.tick_params(labelsize=7)
    axes.grid(visible=True, linewidth=0.3)


def legend(axes: Axes, *, outside: bool = False) -> None:
    """Small legend, beside the axes where it would hide points."""
    if outside:
        axes.legend(fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        axes.legend(fontsize=7, loc="best")


def pick(results: Results, setting: Setting, gap_um: float | None, speed_hz: float = 30.0) -> Result:
    """The result of one case of a setting; None is the healthy machine."""
    used = healthy_of(setting) if gap_um is None else setting
    return results[Case(setting=used, gap_um=gap_um, speed_hz=speed_hz)]


def name_of(gap_um: float | None) -> str:
    """Legend text of a clearance."""
    return "healthy" if gap_um is None else f"{gap_um:g} um"


def trace(result: Result, name: str, span_s: float) -> tuple[np.ndarray, np.ndarray]:
    """Time in ms and the first `span_s` of a stored signal."""
    count = int(span_s * result.trace_rate_hz)
    values = result.trace[name][:count]
    return np.arange(values.size) / result.trace_rate_hz * 1e3, values


def per_mesh(result: Result, name: str) -> np.ndarray:
    """A stored signal cut into mesh periods, shape (periods, samples)."""
    mesh_hz = 23 * result.case.speed_hz
    return result.trace[name].reshape(-1, round(result.trace_rate_hz / mesh_hz))
