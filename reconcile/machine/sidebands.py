"""Sidebands of the teeth's lines at any distance: how far they have risen above the floor since the baseline.

What modulates the meshing, whatever it is, stands at the same distance on both sides of every harmonic of the teeth and
on every sensor; the mean over all of these shows what no single line does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.observe.extract import USABLE, hann_spectrum
from reconcile.observe.observation import PointData, heard_hz
from reconcile.observe.steady import Steady
from reconcile.observe.watch import watch_list
from reconcile.speed.excess import power_over_floor
from reconcile.verdict import LineChange
from signals.series import FloatArray
from sim.core.spec import MachineSpec

APART = 1.03
"""Ratio of two speeds from which on an order has moved."""
HARMONICS = 3
"""Of the teeth."""
HIGHEST_SHARE = 0.45
"""Of the teeth's frequency: beyond, it is nearer to the next harmonic."""
LEAST_LEVEL_DB, MOST_LEVEL_DB = 5.0, 35.0
"""Above the local floor: what chance reaches, and more proves no more."""
TOLD_DB = 3.0
"""Of a line that is listed."""


@dataclass(frozen=True, kw_only=True)
class Teeth:
    """Lines of the watch list: first harmonics of the teeth, and of the shafts."""

    meshes: tuple[int, ...]
    shafts: tuple[int, ...]


def teeth_of(machine: MachineSpec) -> Teeth:
    """Numbers of the first harmonics in the machine's watch list."""
    watched = watch_list(machine).lines
    first = [(k, line.family) for k, line in enumerate(watched) if set(line.orders.values()) == {1.0}]
    return Teeth(
        meshes=tuple(k for k, family in first if family == "mesh"),
        shafts=tuple(k for k, family in first if family == "shaft"),
    )


def apart(speeds: Sequence[float]) -> list[list[int]]:
    """Numbers of the operating points, those of about one speed together: at one an order cannot be told from Hz."""
    groups: list[list[int]] = []
    for k in sorted(range(len(speeds)), key=lambda k: speeds[k]):
        if groups and speeds[k] < APART * speeds[groups[-1][0]]:
            groups[-1].append(k)
        else:
            groups.append([k])
    return groups


def second(mean: FloatArray, groups: Sequence[Sequence[int]]) -> FloatArray:
    """(distances,): the largest rise but one of speeds apart, dB, of `mean` (operating points, distances)."""
    each = np.stack([mean[list(group)].max(axis=0) for group in groups])
    return np.asarray(np.sort(each, axis=0)[-2])


def in_reach(data: Sequence[PointData], first: Sequence[int], widest_hz: Sequence[float]) -> list[tuple[int, int]]:
    """Harmonics of the teeth (line, order) whose sidebands, up to `widest_hz` of each operating point, are below the
    band's end in all its recordings."""

    def reached(mesh: int, order: int) -> bool:
        return all(
            one is not None
            and order * one.speed_hz / d.point.speed_hz * float(d.lines_hz[mesh]) + widest <= USABLE * one.rate_hz
            for d, widest in zip(data, widest_hz, strict=True)
            for one in d.spectra
        )

    return [(mesh, order) for mesh in first for order in range(1, HARMONICS + 1) if reached(mesh, order)]


def rise(one: PointData, reached: Sequence[tuple[int, int]], distances_hz: FloatArray) -> FloatArray:
    """(sidebands, C, distances): level of each sideband above the floor in the test less that in the baseline, dB."""
    test, baseline = one.spectra
    assert baseline is not None
    now, before = _both(one, reached, (test, distances_hz), (baseline, distances_hz))
    return now - before


def levels_by_order(
    one: PointData, reached: Sequence[tuple[int, int]], orders: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """(sidebands, C, orders) of the test and of the baseline: level above the floor, dB, at distances that are
    multiples of the drive shaft's speed, in each recording its own."""
    test, baseline = one.spectra
    assert baseline is not None
    return _both(one, reached, (test, orders * test.speed_hz), (baseline, orders * baseline.speed_hz))


def _both(
    point: PointData,
    reached: Sequence[tuple[int, int]],
    now: tuple[Steady, FloatArray],
    before: tuple[Steady, FloatArray],
) -> tuple[FloatArray, FloatArray]:
    """Levels of a test and of its baseline, each a recording with distances, Hz. What has risen over the floors has
    risen over the higher of the two as well: over a lower one what was there before would look new."""
    test, rested = _levels(point, reached, *now), _levels(point, reached, *before)
    over = _levels(point, reached, *now, before[0]) - _levels(point, reached, *before, now[0])
    return rested + np.minimum(test - rested, over), rested


def _levels(
    point: PointData,
    reached: Sequence[tuple[int, int]],
    one: Steady,
    distances_hz: FloatArray,
    other: Steady | None = None,
) -> FloatArray:
    """Over the floor, or over that of another recording where it is higher."""
    power, floor, bin_hz = _floors(one)
    if other is not None:
        _, beside, beside_hz = _floors(other)
        hz, there = bin_hz * np.arange(power.shape[1]), beside_hz * np.arange(beside.shape[1])
        floor = np.maximum(floor, np.stack([np.interp(hz, there, row) for row in beside]))
    above = 10.0 * np.log10(np.maximum(power / floor, 1e-3))
    above = np.clip(above, LEAST_LEVEL_DB, MOST_LEVEL_DB)
    half_step_hz = 0.5 * float(np.diff(distances_hz).min(initial=np.inf))
    reach = max(1, int(np.ceil(half_step_hz / bin_hz))) if np.isfinite(half_step_hz) else 1  # no line is between two
    above = maximum_filter1d(above, 2 * reach + 1, axis=1, mode="wrap")
    scale = one.speed_hz / point.point.speed_hz
    found = []
    for mesh, order in reached:
        middle = order * scale * float(point.lines_hz[mesh])
        found += [above[:, np.rint((middle + side * distances_hz) / bin_hz).astype(int)] for side in (-1.0, 1.0)]
    return np.stack(found)


def _floors(one: Steady) -> tuple[FloatArray, FloatArray, float]:
    """Power and local floor, (C, bins) each in one unit of power a bin width, and the bin's width, Hz."""
    _, power, bin_hz = hann_spectrum(one.samples, one.rate_hz)
    power = power / bin_hz
    return power, power / np.maximum(np.stack([power_over_floor(row) for row in power]), 1e-12), bin_hz


def risen_lines(
    one: PointData, mesh: int, rises: FloatArray, hz: float, told: str, locked: str, channels: Sequence[str]
) -> list[LineChange]:
    """The sidebands of the teeth's first harmonic at one operating point (`rises` (sidebands, C)) that rose, each on
    the channel where it did most; `told` is the distance in words."""
    found = []
    for row, sign in ((0, -1.0), (1, 1.0)):
        channel = int(np.argmax(rises[row]))
        if rises[row, channel] < TOLD_DB:
            continue
        found.append(
            LineChange(
                label=f"teeth {'+' if sign > 0 else '-'} {told}",
                frequency_hz=heard_hz(one, mesh) + sign * hz,
                change_db=float(rises[row, channel]),
                channel=channels[channel],
                locked_to=locked,
                speed_hz=one.point.speed_hz,
                torque_ratio=one.point.torque_ratio,
            )
        )
    return found
