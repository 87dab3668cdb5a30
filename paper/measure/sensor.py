"""Measures of the resonator of bearing 1 and of the shaft orbit."""

from __future__ import annotations

import numpy as np

from paper.measure.envelopes import turning_points
from paper.measure.lines import levels, line, without_periodic
from paper.measure.mesh import slow_numbers, slow_of
from paper.measure.window import Window

MESH_ORDERS = tuple(range(1, 8))
OUTER_ORDERS = tuple(range(1, 21))
LEAST_RIPPLE = 0.05
"""Share of the radius' range below which a ripple of the polar orbit is not a peak."""


def displacement_numbers(window: Window) -> dict[str, float]:
    """Peak, range and median line of the resonator's displacement."""
    y = window.signals["y"]
    blocks = window.by_mesh("y")
    median = 0.5 * (blocks.max(axis=1) + blocks.min(axis=1))
    numbers = slow_numbers("y_median", slow_of(window, median), float(np.ptp(y)))
    fluctuation = float(y.std())
    return numbers | {
        "y_max": float(y.max()),
        "y_range": float(np.ptp(y)),
        "y_rms": float(np.sqrt(np.mean(y**2))),
        "y_std": fluctuation,
        "y_median_range": float(np.ptp(median)),
    }


def acceleration_numbers(window: Window) -> dict[str, float]:
    """Statistics and lines of the resonator's acceleration; `..._on` is 1 where the line is present."""
    acc = window.signals["acc"]
    blocks = window.by_mesh("acc")
    numbers = slow_numbers("acc_env", slow_of(window, np.ptp(blocks, axis=1)), float(np.ptp(acc)))
    deviation = float(acc.std())
    half = acc.size // 2
    numbers |= {
        "acc_rms": deviation,
        "acc_range": float(np.ptp(acc)),
        "acc_kurtosis": float(np.mean((acc - acc.mean()) ** 4)) / deviation**4,
        "acc_halves": float(acc[:half].std() / acc[half:].std()),
        "acc_irregular": float(without_periodic(acc, window.per_mesh).std()) / deviation,
    }
    return numbers | line_numbers(window)


def line_numbers(window: Window) -> dict[str, float]:
    """Amplitudes of j f_m, k f_o1 and j f_m +- f_r1, m/s^2."""
    acc, rate = window.signals["acc"], window.rate_hz
    spectrum = levels(acc, rate)
    rest = without_periodic(acc, window.per_revolution)
    numbers = {"largest_line": spectrum.largest}

    def put(name: str, frequency_hz: float, *, from_rest: bool) -> None:
        amplitude = abs(line(rest if from_rest else acc, rate, frequency_hz))
        numbers[name] = amplitude
        numbers[f"{name}_on"] = float(spectrum.present(amplitude, frequency_hz))

    for k in OUTER_ORDERS:
        put(f"fo{k}", k * window.f_o1_hz, from_rest=True)
    for j in MESH_ORDERS:
        put(f"fm{j}", j * window.f_m_hz, from_rest=False)
        put(f"fm{j}-r", j * window.f_m_hz - window.f_r1_hz, from_rest=False)
        put(f"fm{j}+r", j * window.f_m_hz + window.f_r1_hz, from_rest=False)
    return numbers


def orbit_numbers(window: Window) -> dict[str, float]:
    """Width of the shaft's orbit at bearing 1 and peaks of its radius in a revolution."""
    x, y = window.signals["ring_x"], window.signals["ring_y"]
    radius = np.hypot(x, y)
    points = turning_points(radius, LEAST_RIPPLE * float(np.ptp(radius)))
    revolutions = x.size / window.per_revolution
    return {
        "orbit_x": float(np.ptp(x)),
        "orbit_y": float(np.ptp(y)),
        "orbit_peaks": points.size / 2 / revolutions,
    }
