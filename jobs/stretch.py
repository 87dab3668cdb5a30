"""What the speed does in the stretch that is analysed: frequencies at its mean, and whether lines stand still in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from signals.series import FloatArray, Series
from sim.core.response import Response
from sim.core.spec import MachineSpec
from sim.core.speed import mean_ratio, speed_table, warped_times

STEADY = 0.01
"""Range of the speed in a stretch, relative to nominal, above which a line has no one frequency in it."""


def at_stretch(response: Response, start_s: float) -> Response:
    """The response with its base frequencies at the mean speed from `start_s` to the end."""
    if response.speed[0] == 0:
        return response
    end_s = response.signals.shape[1] / response.sampling_rate_hz
    ratio = mean_ratio(response.speed, start_s, end_s) / max(mean_ratio(response.speed, 0.0, end_s), 1e-12)
    return replace(response, bases_hz={name: hz * ratio for name, hz in response.bases_hz.items()})


def _ratios(series: Series, table: FloatArray) -> tuple[FloatArray, FloatArray]:
    t = series.start_s + np.arange(series.samples.size) / series.sampling_rate_hz
    return warped_times(table, t)


def unsteady(series: Series, machine: MachineSpec, seed: int) -> str:
    """Why lines of this series have no one frequency; empty at a steady speed."""
    table = speed_table(machine.operating.profile if machine.operating else None, seed)
    if table[0] == 0 or series.samples.size == 0:
        return ""
    _, ratio = _ratios(series, table)
    span = float(ratio.max() - ratio.min())
    if span <= STEADY:
        return ""
    return (
        f"the speed varies by {100 * span:.3g} % of the nominal one in the analysed stretch, so a line has no one "
        "frequency there: the order spectrum shows it, or a stretch of steady speed"
    )


def turned_angle_rad(series: Series, table: FloatArray, nominal_hz: float) -> FloatArray:
    """Angle of a shaft of nominal speed `nominal_hz` at the samples, from 0 on, shape (n,), rad."""
    gone, _ = _ratios(series, table)
    angle: FloatArray = 2.0 * np.pi * nominal_hz * (gone - gone[0])
    return angle
