"""Figures 7, 8 and 13: centre distance, offset angle, mesh stiffness."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from paper.cases import PRESETS, SPEEDS_HZ, Setting
from paper.figures.draw import COLOURS, TITLES, Results, grid, label, legend, name_of, per_mesh, pick, trace
from paper.measure.mesh import SINGLE_PHASES
from paper.measure.window import FloatArray
from paper.run import Result

GAPS: tuple[float | None, ...] = (None, 10.0, 30.0, 50.0)
SPAN_S = 0.04


def single_tooth(result: Result) -> FloatArray:
    """Mean stiffness of every single-tooth interval, N/m, shape (periods,)."""
    blocks = per_mesh(result, "k")
    first, last = (round(p * blocks.shape[1]) for p in SINGLE_PHASES)
    return np.asarray(blocks[:, first:last].mean(axis=1))


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


def _single(axes: Axes, results: Results, setting: Setting) -> None:
    for gap in (None, 10.0, 20.0, 30.0, 50.0):
        low = single_tooth(pick(results, setting, gap))
        axes.plot(np.arange(low.size) / 0.69, low * 1e-8, color=COLOURS[gap], linewidth=0.8, label=name_of(gap))
    label(axes, "time, ms", "single-tooth mean, 1e8 N/m", f"{setting.form} centre distance")


def figure_8(results: Results) -> Figure:
    """Stiffness over two mesh periods and its mean over every single-tooth interval, in both forms."""
    figure, axes = grid(2, 3)
    for row, preset in zip(axes, PRESETS, strict=True):
        setting = Setting(preset=preset, form="true")
        for gap in (None, 10.0, 30.0, 50.0):
            t, k = trace(pick(results, setting, gap), "k", 2 / 690.0)
            row[0].plot(t, k * 1e-8, color=COLOURS[gap], linewidth=0.8, label=name_of(gap))
        label(row[0], "time, ms", "mesh stiffness, 1e8 N/m", f"{TITLES[preset]}: true centre distance")
        _single(row[1], results, replace(setting, form="printed"))
        _single(row[2], results, setting)
        legend(row[0])
        legend(row[2], outside=True)
    return figure


def figure_13(results: Results) -> Figure:
    """Single-tooth stiffness at every speed, true and printed centre distance."""
    figure, axes = grid(2, 2)
    for row, preset in zip(axes, PRESETS, strict=True):
        for axis, form in zip(row, ("printed", "true"), strict=True):
            for i, hz in enumerate(SPEEDS_HZ):
                setting = Setting(preset=preset, form="true" if form == "true" else "printed")
                low = single_tooth(pick(results, setting, 20.0, hz))
                turns = np.arange(low.size) / 23
                axis.plot(turns, (low / low.mean() - 1) * 1e6, color=f"C{i}", linewidth=0.8, label=f"{hz:g} Hz")
            label(axis, "pinion revolutions", "single-tooth mean, ppm", f"{TITLES[preset]}, {form} form, 20 um")
        legend(row[1], outside=True)
    return figure
