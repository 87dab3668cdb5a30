"""Figures 9, 10, 12 and 16: displacement, spectrum, orbit, the sensor's acceleration."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import resample_poly

from paper.cases import PRESETS, RUNOUT_M, Setting
from paper.figures.draw import COLOURS, TITLES, Results, grid, label, legend, name_of, per_mesh, pick, trace
from paper.run import Result

GAPS: tuple[float | None, ...] = (None, 10.0, 30.0, 50.0)
SENSOR_RATE_HZ = 30_000
F_M, F_O1 = 690.0, 77.2065


def figure_9(results: Results) -> Figure:
    """Displacement of the resonator of bearing 1 and its median line."""
    figure, axes = grid(2, 2)
    for row, preset in zip(axes, PRESETS, strict=True):
        for gap in GAPS:
            result = pick(results, Setting(preset=preset), gap)
            t, y = trace(result, "y", 0.03)
            row[0].plot(t, y * 1e6, color=COLOURS[gap], linewidth=0.7, label=name_of(gap))
            blocks = per_mesh(result, "y")
            median = 0.5 * (blocks.max(axis=1) + blocks.min(axis=1))
            time_ms = np.arange(median.size) / 0.69
            row[1].plot(time_ms, (median - median.mean()) * 1e9, color=COLOURS[gap], linewidth=0.8, label=name_of(gap))
        label(row[0], "time, ms", "displacement, um", f"{TITLES[preset]}: resonator 1, y")
        label(row[1], "time, ms", "median line less its mean, nm", f"1/f_o1 = {1e3 / F_O1:.2f} ms")
        legend(row[0])
    return figure


def _spectrum(axes: Axes, result: Result, colour: str, text: str, low: float, high: float) -> None:
    first, last = (int(f / result.spectrum_resolution_hz) for f in (max(low, 10.0), high))
    frequency = np.arange(first, last) * result.spectrum_resolution_hz
    axes.semilogy(frequency, result.spectrum[first:last], color=colour, linewidth=0.5, label=text)


def _marks(axes: Axes, orders: tuple[tuple[str, float], ...]) -> None:
    for text, frequency in orders:
        axes.axvline(frequency, color="0.7", linewidth=0.4, zorder=0)
        axes.text(
            frequency, 1.0, text, fontsize=6, rotation=90, va="top", ha="right", transform=axes.get_xaxis_transform()
        )


def figure_10(results: Results) -> Figure:
    """Acceleration spectra with run-out, low and high band."""
    figure, axes = grid(2, 2)
    low = tuple((f"{k}fo", k * F_O1) for k in (1, 2, 10, 11, 12, 18)) + tuple((f"{j}fm", j * F_M) for j in (1, 2, 3))
    high = tuple((f"{j}fm", j * F_M) for j in (4, 5, 6, 7))
    for row, preset in zip(axes, PRESETS, strict=True):
        setting = Setting(preset=preset, runout_m=RUNOUT_M)
        for axis, (start, stop), marks in zip(row, ((0.0, 2500.0), (2500.0, 5000.0)), (low, high), strict=True):
            for gap in (50.0, 30.0, 10.0):
                _spectrum(axis, pick(results, setting, gap), COLOURS[gap], name_of(gap), start, stop)
            _marks(axis, marks)
            title = f"{TITLES[preset]}, run-out 20 um"
            label(axis, "frequency, Hz", "amplitude, m/s^2", title)
        legend(row[1])
    return figure


def figure_12(results: Results) -> Figure:
    """Orbit of the shaft at bearing 1 about its mean, and its radius over the angle of the pinion."""
    figure = Figure(figsize=(11, 7), layout="constrained")
    for i, preset in enumerate(PRESETS):
        plane = figure.add_subplot(2, 2, 2 * i + 1)
        polar = figure.add_subplot(2, 2, 2 * i + 2, projection="polar")
        for gap in (50.0, 30.0, 10.0, None):
            result = pick(results, Setting(preset=preset), gap)
            n = round(result.trace_rate_hz / 30.0)
            x, y = (result.trace[name][: 2 * n] * 1e6 for name in ("ring_x", "ring_y"))
            plane.plot(x, y - y.mean(), color=COLOURS[gap], linewidth=0.5, label=name_of(gap))
            angle = np.linspace(0, 2 * np.pi, n, endpoint=False)
            polar.plot(angle, np.hypot(x[:n], y[:n]), color=COLOURS[gap], linewidth=0.5)
        label(plane, "x, um", "y less its mean, um", f"{TITLES[preset]}: inner ring of bearing 1")
        polar.set_title("radius from the bearing's centre, um, over one revolution", fontsize=9)
        polar.tick_params(labelsize=7)
        legend(plane)
    return figure


def figure_16(results: Results) -> Figure:
    """Acceleration at 20 um sampled at 30 kHz behind an anti-alias filter, and its spectrum."""
    figure, axes = grid(2, 2)
    marks = tuple((f"{k}fo", k * F_O1) for k in (4, 5, 6)) + tuple((f"{j}fm", j * F_M) for j in range(1, 8))
    for row, preset in zip(axes, PRESETS, strict=True):
        result = pick(results, Setting(preset=preset, runout_m=RUNOUT_M), 20.0)
        # 62100 -> 30000 Hz is 100/207
        sampled = resample_poly(result.trace["acc"], 100, 207)[:3000]
        row[0].plot(np.arange(sampled.size) / SENSOR_RATE_HZ * 1e3, sampled, linewidth=0.5)
        label(row[0], "time, ms", "acceleration, m/s^2", f"{TITLES[preset]}: 16(a), 20 um, run-out 20 um")
        _spectrum(row[1], result, "C0", "", 0.0, 6000.0)
        _marks(row[1], marks)
        label(row[1], "frequency, Hz", "amplitude, m/s^2", "16(b)")
    return figure
