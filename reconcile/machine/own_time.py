"""Does something keep its own time? Lines of the teeth modulated at a frequency that stays in Hz at every speed.

Torque or pull of an electric drive at twice the supply's frequency, a pump or another machine that shakes the housing:
what acts inside the machine so makes sidebands of the teeth's lines at a distance in Hz, which no order finds and which
hum picked up by a cable does not have. Where speeds differ the same distance at all of them is none of the machine's.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.gate.findings import Kind
from reconcile.kinematics.families import Family, ties
from reconcile.kinematics.spec import of_machine
from reconcile.observe.extract import USABLE, hann_spectrum
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import watch_list
from reconcile.speed.excess import power_over_floor
from reconcile.verdict import LineChange, NextExperiment, PlaceWeight, Report
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

APART = 1.03
"""Ratio of two speeds from which on an order has moved."""
HARMONICS = 3
"""Of the teeth."""
LOWEST_HZ, HIGHEST_HZ, STEP_HZ = 12.0, 260.0, 0.4
"""Nearer to the teeth's lines there is what is left of the speed's wander."""
HIGHEST_SHARE = 0.45
"""Of the teeth's frequency: beyond, it is nearer to the next harmonic."""
LEAST_LEVEL_DB, MOST_LEVEL_DB = 5.0, 35.0
"""Above the local floor: what chance reaches, and more proves no more."""
OWN_HZ = 1.0
"""Distance from an order of a shaft below which a frequency may be that order's."""
MULTIPLES = 4
"""Of what a bearing's part modulates with: at two speeds its third and its second may meet, at 2:3."""
LEAST_DB, AHEAD = 1.2, 2.0
"""Mean rise at the speed where it is least, and over that at any frequency elsewhere. Sound machines of the proof's
third split come to 0.3 dB; a pit's forest of lines to 3.5 dB, but at many frequencies."""
SEPARATE_HZ = 3.0
TOLD_DB = 3.0
"""Of a line that is listed."""
SUPPLIES_HZ = (50.0, 60.0)
SUPPLY_HZ = 1.0
TELLS_LITTLE = 10.0
"""Evidence of the best effect below which a set of effects says less than this does."""
ELECTRIC: tuple[Kind, ...] = ("mains_hum", "fixed_tones")
OFF = NextExperiment(
    sentence="Switch the drive off and record the run-down: what a drive brings is gone at once, what another machine "
    "brings stays."
)


@dataclass(frozen=True, kw_only=True)
class OwnTime:
    """`hz`: distance of the sidebands at every speed; `rise_db` over the baseline, mean of channels, teeth's harmonics
    and sides at the speed where it is least; `elsewhere_db`: the largest such rise at any other frequency."""

    hz: float
    rise_db: float
    elsewhere_db: float
    lines: tuple[LineChange, ...] = ()

    @property
    def supply_hz(self) -> float | None:
        """The supply of which it is once or twice the frequency."""
        return next((s for s in SUPPLIES_HZ for k in (1, 2) if abs(self.hz - k * s) < SUPPLY_HZ), None)


def own_time(machine: MachineSpec, data: Sequence[PointData], channels: Sequence[str]) -> OwnTime | None:
    """None where nothing of the kind stands out, at one speed, and without baselines."""
    speeds = [d.point.speed_hz for d in data]
    if max(speeds) < APART * min(speeds) or any(d.spectra[1] is None for d in data):
        return None
    watched = watch_list(machine).lines
    first = [k for k, line in enumerate(watched) if line.family == "mesh" and set(line.orders.values()) == {1.0}]
    shafts = [k for k, line in enumerate(watched) if line.family == "shaft" and set(line.orders.values()) == {1.0}]
    slowest = min((float(d.lines_hz[k]) for d in data for k in first), default=0.0)
    grid = np.arange(LOWEST_HZ, min(HIGHEST_HZ, HIGHEST_SHARE * slowest), STEP_HZ)
    reached = _in_reach(data, first, float(grid[-1])) if grid.size > 1 else []
    if not reached:
        return None
    bearings = _parts(machine)
    rises = np.stack([_rise(d, reached, grid) for d in data])
    least = rises.mean(axis=(1, 2)).min(axis=0)
    while least.max() >= LEAST_DB:
        best = int(np.argmax(least))
        hz = _middle(grid, least, best)
        if _free(data, shafts, hz) and not _of_a_part(data, bearings, hz):
            break
        least[np.abs(grid - hz) <= SEPARATE_HZ] = 0.0  # an order, with what its line leaks
    else:
        return None
    away = np.ones(grid.size, dtype=bool)
    for multiple in (1 / 3, 0.5, 1.0, 2.0, 3.0):
        away &= np.abs(grid - multiple * hz) > SEPARATE_HZ
    elsewhere = float(least[away].max(initial=0.0))
    if least[best] < max(LEAST_DB, AHEAD * elsewhere):
        return None
    lines = _lines(data, reached[0][0], rises[..., best], hz, channels)
    return OwnTime(hz=hz, rise_db=float(least[best]), elsewhere_db=elsewhere, lines=lines)


def _middle(grid: FloatArray, least: FloatArray, best: int) -> float:
    """Centre of what stands out around the best, Hz: a line may be split by the speed's wander."""
    near = (np.abs(grid - grid[best]) <= SEPARATE_HZ) & (least > 0.5 * least[best])
    return float(np.average(grid[near], weights=least[near]))


def _free(data: Sequence[PointData], shafts: Sequence[int], hz: float) -> bool:
    """Whether a frequency is at two speeds at least no order of a shaft: those of two speeds may meet."""
    clear = [
        d.point.speed_hz
        for d in data
        if all(abs(hz - round(hz / turn) * turn) > min(OWN_HZ, 0.25 * turn) for turn in (d.lines_hz[k] for k in shafts))
    ]
    return bool(clear) and max(clear) > APART * min(clear)


def _parts(machine: MachineSpec) -> tuple[Family, ...]:
    """What bearings modulate with; none where shafts are not tied."""
    try:
        return ties(of_machine(machine), machine.operating.shaft if machine.operating else None).families
    except SpecError:
        return ()


def _of_a_part(data: Sequence[PointData], families: Sequence[Family], hz: float) -> bool:
    """Whether one part's low multiples, within its slip, meet the frequency at every speed."""

    def met(family: Family, speed_hz: float) -> bool:
        own = [k * family.order * speed_hz for k in range(1, MULTIPLES + 1)]
        return any(abs(hz - at) <= OWN_HZ + family.slip * at for at in own)

    turning = [f for f in families if f.slip > 0.0]
    return any(all(met(f, d.spectra[0].speed_hz) for d in data) for f in turning)


def _in_reach(data: Sequence[PointData], first: Sequence[int], widest_hz: float) -> list[tuple[int, int]]:
    """Harmonics of the teeth (line, order) whose sidebands are below the band's end in all recordings."""

    def reached(mesh: int, order: int) -> bool:
        return all(
            one is not None
            and order * one.speed_hz / d.point.speed_hz * float(d.lines_hz[mesh]) + widest_hz <= USABLE * one.rate_hz
            for d in data
            for one in d.spectra
        )

    return [(mesh, order) for mesh in first for order in range(1, HARMONICS + 1) if reached(mesh, order)]


def _rise(one: PointData, reached: Sequence[tuple[int, int]], grid: FloatArray) -> FloatArray:
    """(sidebands, C, grid): level of each sideband above the floor in the test less that in the baseline, dB."""
    test, baseline = one.spectra
    assert baseline is not None
    return _levels(test, one, reached, grid) - _levels(baseline, one, reached, grid)


def _levels(one: Steady, point: PointData, reached: Sequence[tuple[int, int]], grid: FloatArray) -> FloatArray:
    _, power, bin_hz = hann_spectrum(one.samples, one.rate_hz)
    above = 10.0 * np.log10(np.maximum(np.stack([power_over_floor(row) for row in power]), 1e-3))
    above = np.clip(above, LEAST_LEVEL_DB, MOST_LEVEL_DB)
    above = np.max(np.stack([np.roll(above, k, axis=1) for k in (-1, 0, 1)]), axis=0)
    scale = one.speed_hz / point.point.speed_hz
    found = []
    for mesh, order in reached:
        middle = order * scale * float(point.lines_hz[mesh])
        found += [above[:, np.rint((middle + side * grid) / bin_hz).astype(int)] for side in (-1.0, 1.0)]
    return np.stack(found)


def _lines(
    data: Sequence[PointData], mesh: int, rises: FloatArray, hz: float, channels: Sequence[str]
) -> tuple[LineChange, ...]:
    """The sidebands of the teeth's first harmonic at every speed, each on the channel where it rose most, that rose."""
    found = []
    locked = "mains" if OwnTime(hz=hz, rise_db=0.0, elsewhere_db=0.0).supply_hz else ""
    for k, d in enumerate(data):
        for row, sign in ((0, -1.0), (1, 1.0)):
            channel = int(np.argmax(rises[k, row]))
            if rises[k, row, channel] < TOLD_DB:
                continue
            found.append(
                LineChange(
                    label=f"teeth {'+' if sign > 0 else '-'} {hz:.4g} Hz",
                    frequency_hz=float(d.lines_hz[mesh] + sign * hz),
                    change_db=float(rises[k, row, channel]),
                    channel=channels[channel],
                    locked_to=locked,
                    speed_hz=d.point.speed_hz,
                    torque_ratio=d.point.torque_ratio,
                )
            )
    return tuple(found)


def explained_by(report: Report) -> tuple[Kind, ...]:
    """Kinds of faults that are the machine's own where what keeps its own time is the answer."""
    told = any(stage.get("name") == "own time" for stage in report.stages)
    return ELECTRIC if told and report.verdict == "unknown_physics" else ()


def with_own_time(report: Report, seen: OwnTime | None, machine: MachineSpec) -> Report:
    """The report, which says so: as the answer where nothing sure speaks for another one, else beside it."""
    if seen is None:
        return report
    text = f"the teeth's lines are modulated at {seen.hz:.4g} Hz at every speed, new since the baseline"
    if seen.supply_hz is not None:
        text += f"; a supply of {seen.supply_hz:g} Hz would do that through torque or pull of an electric drive"
    electric = report.fault is not None and report.fault.kind in ELECTRIC
    weak = report.verdict == "ambiguous" and max((c.score for c in report.causes), default=0.0) < TELLS_LITTLE
    lines = (*seen.lines, *report.where.lines)
    told = {"name": "own time", "hz": seen.hz, "rise_db": seen.rise_db, "elsewhere_db": seen.elsewhere_db}
    report = replace(report, stages=(*report.stages, told))
    if not (report.verdict in ("nothing_missing", "not_decidable", "unknown_physics") or electric or weak):
        limits = (*report.where.limits, f"beside this, {text}: no order of this machine")
        return replace(report, where=replace(report.where, lines=lines, limits=limits))
    sentence = f"Something is missing that no known effect explains: {text}. It follows no shaft of this machine."
    where = replace(report.where, lines=lines, sites=_sites(machine))
    causes = tuple(replace(cause, named=False) for cause in report.causes)
    return replace(
        report, verdict="unknown_physics", sentence=sentence, where=where, causes=causes, fault=None, undecidable=(),
        next_experiment=OFF, held_out=None, machine=None, force=None, faintest=(),
    )  # fmt: skip


def _sites(machine: MachineSpec) -> tuple[PlaceWeight, ...]:
    """The driven shaft, by which a drive acts, before the gears, at which something may pull."""
    shaft = machine.operating.shaft if machine.operating is not None else machine.shafts[0].name
    share = 0.5 / max(1, len(machine.gears))
    return (
        PlaceWeight(site=shaft, weight=0.5),
        *(PlaceWeight(site=gear.name, weight=share) for gear in machine.gears),
    )
