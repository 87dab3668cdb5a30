"""Figures 7, 8 and 13: centre distance, offset angle, mesh stiffness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper.cases import PRESETS, SPEEDS_HZ, Setting
from paper.figures.draw import COLOURS, TITLES, Results, grid, label, legend, name_of, per_mesh, pick, trace

GAPS: tuple[float | None, ...] = (None, 10.0, 30.0, 50.0)
SPAN_S = 0.04


def _motion(axes: Axes, results: Results, setting: Setting, name: str, unit: str) -> None:
    for gap in GAPS:
        t, values = trace(pick(results, setting, gap), name, SPAN_S)
        axes.plot(t, values * 1e6, color=COLOURS[gap], linewidth=0.8, label=name_of(gap))
    label(axes, "time, ms", unit)


def figure_7(results: Results) -> Figure:
    """Centre-distance error in both forms, and offset angle."""
    figure, axes = grid(2, 3)
    for row, preset in zip(axes, PRESETS, strict=True):
        printed = Setting(preset=preset)
        _motion(row[0], results, printed, "a", "centre-distance error, um")
        _motion(row[1], results, replace(printed, form="true"), "a", "centre-distance error, um")
        _motion(row[2], results, printed, "theta", "offset angle, urad")
        for axis, what in zip(row, ("eq. (17) as printed", "true geometry", "offset angle"), strict=True):
            axis.set_title(f"{TITLES[preset]}: {what}", fontsize=9)
        legend(row[0])
    return figure


def figure_8(results: Results) -> Figure:
    """Stiffness over two mesh periods, the single-tooth part, and its minimum in every mesh period."""
    figure, axes = grid(2, 3)
    for row, preset in zip(axes, PRESETS, strict=True):
        for gap in (None, 10.0, 20.0, 30.0):
            result = pick(results, Setting(preset=preset), gap)
            colour, text = COLOURS[gap], name_of(gap)
            t, k = trace(result, "k", 2 / 690.0)
            row[0].plot(t, k * 1e-8, color=colour, linewidth=0.8, label=text)
            single = np.where(k < 2.75e8, k, np.nan)
            row[1].plot(t, single * 1e-8, color=colour, linewidth=0.8, label=text)
            lowest = per_mesh(result, "k").min(axis=1)
            row[2].plot(
                np.arange(lowest.size) / 0.69,
                (lowest / lowest.mean() - 1) * 1e6,
                color=colour,
                linewidth=0.8,
                label=text,
            )
        label(row[0], "time, ms", "mesh stiffness, 1e8 N/m", TITLES[preset])
        label(row[1], "time, ms", "single-tooth part, 1e8 N/m")
        label(row[2], "time, ms", "single-tooth minimum, ppm of its mean")
        legend(row[0])
    return figure


def figure_13(results: Results) -> Figure:
    """Single-tooth minimum at every speed, true and printed centre distance."""
    figure, axes = grid(2, 2)
    for row, preset in zip(axes, PRESETS, strict=True):
        for axis, form in zip(row, ("printed", "true"), strict=True):
            for i, hz in enumerate(SPEEDS_HZ):
                setting = Setting(preset=preset, form="true" if form == "true" else "printed")
                lowest = per_mesh(pick(results, setting, 20.0, hz), "k").min(axis=1)
                turns = np.arange(lowest.size) / 23
                axis.plot(turns, (lowest / lowest.mean() - 1) * 1e6, color=f"C{i}", linewidth=0.8, label=f"{hz:g} Hz")
            label(axis, "pinion revolutions", "single-tooth minimum, ppm", f"{TITLES[preset]}, {form} form, 20 um")
        legend(row[1])
    return figure
