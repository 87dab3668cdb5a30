"""Figures 11 and 14: line amplitudes against clearance, response against speed."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from paper.cases import GAPS_UM, PRESETS, RUNOUT_M, SPEEDS_HZ, VARIANTS, Setting
from paper.figures.draw import TITLES, Results, grid, label, legend, pick, trace

WORDS = {"fit_clearance": "rigid wall", "fit_clearance_series": "elastic housing"}


def _lines(axes: Axes, results: Results, setting: Setting, names: tuple[tuple[str, str], ...]) -> None:
    for i, (name, text) in enumerate(names):
        values = [pick(results, setting, g).numbers[name] for g in (None, *GAPS_UM)]
        axes.semilogy([0.0, *GAPS_UM], values, marker=".", linewidth=0.8, color=f"C{i}", label=text)
        if setting.variant == "fit_clearance":
            axes.semilogy([0.0], [pick(results, setting, 0.0).numbers[name]], "x", color=f"C{i}")


def figure_11(results: Results) -> Figure:
    """Amplitudes of f_m and f_o1 families; the cross is zero gap with the rigid wall."""
    figure, axes = grid(4, 2, height=2.7)
    rows = [(p, v) for p in PRESETS for v in VARIANTS]
    mesh = tuple((f"fm{j}", f"{j} f_m") for j in range(1, 6))
    outer = tuple((f"fo{k}", f"{k} f_o1") for k in range(1, 6))
    for row, (preset, variant) in zip(axes, rows, strict=True):
        setting = Setting(preset=preset, variant=variant)
        for axis, names in zip(row, (mesh, outer), strict=True):
            _lines(axis, results, setting, names)
            label(axis, "clearance, um", "amplitude, m/s^2", f"{TITLES[preset]}, {WORDS[variant]}")
            axis.yaxis.set_minor_formatter(NullFormatter())
            legend(axis, outside=True)
    return figure


def _against_speed(axes: Axes, results: Results, setting: Setting, names: tuple[tuple[str, str], ...]) -> None:
    for name, text in names:
        values = [pick(results, setting, 20.0, hz).numbers[name] for hz in SPEEDS_HZ]
        axes.semilogy(SPEEDS_HZ, values, marker=".", linewidth=0.8, label=text)
    label(axes, "input speed, Hz", "m/s^2")
    legend(axes, outside=True)


def figure_14(results: Results) -> Figure:
    """Time signals at 10, 30 and 60 Hz, RMS and peak-to-peak, and line amplitudes against speed; 20 um, run-out."""
    figure, axes = grid(2, 3)
    for row, preset in zip(axes, PRESETS, strict=True):
        setting = Setting(preset=preset, runout_m=RUNOUT_M)
        for hz in (60.0, 30.0, 10.0):
            t, acc = trace(pick(results, setting, 20.0, hz), "acc", 0.02)
            row[0].plot(t, acc, linewidth=0.6, label=f"{hz:g} Hz")
        label(row[0], "time, ms", "acceleration, m/s^2", TITLES[preset])
        legend(row[0])
        _against_speed(row[1], results, setting, (("acc_rms", "RMS"), ("acc_range", "peak to peak")))
        lines = (*((f"fm{j}", f"{j} f_m") for j in range(1, 6)), ("fo1", "f_o1"), ("fm1+r", "f_m + f_r1"))
        _against_speed(row[2], results, setting, lines)
    return figure
