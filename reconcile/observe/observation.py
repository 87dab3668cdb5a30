"""Recordings of one machine, sorted by operating point and measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.plan import Point
from reconcile.observe.extract import extract
from reconcile.observe.mirrored import Sides, mirrored, sides, turned_round
from reconcile.observe.slack import slack
from reconcile.observe.statistics import Statistics, averaged
from reconcile.observe.steady import Steady, steady
from reconcile.observe.watch import WatchList, bases_at
from reconcile.speed import SpeedEstimate
from reconcile.told import about
from signals.recording import Recording
from signals.series import FloatArray
from sim.assembly.kinematics import kinematics
from sim.assembly.loads import shaft_torques_nm
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec, TorqueLoad

SAME_SPEED = 0.015
SAME_TORQUE = 0.1
LEFT_OUT = "left out"
"""How it begins what is told of tests that are not compared."""
TOOTH_ORDERS = 10
"""Harmonics of the teeth by which the angle is followed."""


@dataclass(frozen=True, kw_only=True)
class PointData:
    """One operating point: the test, its halves in time, and the baseline if there is one."""

    point: Point
    lines_hz: FloatArray
    modulations_hz: FloatArray
    test: Statistics
    halves: tuple[Statistics, Statistics]
    baseline: Statistics | None
    spectra: tuple[Steady, Steady | None]
    turned: tuple[SpeedEstimate, ...] = ()
    """Speeds of all tests of the point."""
    turned_before: tuple[SpeedEstimate, ...] = ()
    """Of all its baselines."""
    mirrored: tuple[int, ...] = ()
    """Channels of the test that are read the other way round (`reconcile.observe.mirrored`)."""


def heard_hz(one: PointData, line: int) -> float:
    """Frequency of a watched line in the test itself, at the speed it turned with; `lines_hz` are the point's."""
    return float(one.lines_hz[line]) * one.spectra[0].speed_hz / one.point.speed_hz


def _torque(machine: MachineSpec) -> float | None:
    """Of the driven shaft, by its loads or in balance with another shaft's; None where nothing loads it."""
    if machine.operating is None or not any(isinstance(x, TorqueLoad) for x in machine.loads):
        return None
    return shaft_torques_nm(machine, kinematics(machine)).get(machine.operating.shaft)


def point_of(machine: MachineSpec, recording: Recording) -> Point:
    """The operating point a recording states; the machine's own where it states none.

    A torque counts by its size: its sign is a matter of whose torque is stated, that on the shaft or that by it.
    """
    if machine.operating is None:
        raise SpecError(
            Problem(field="machine.operating", message="the machine has no speed", allowed="shaft, speed_hz")
        )
    stated = recording.operating
    speed = stated.speed_hz if stated is not None else machine.operating.speed_hz
    nominal = _torque(machine)
    given = stated.torque_nm if stated is not None else None
    ratio = abs(given / nominal) if given is not None and nominal else 1.0
    return Point(speed_hz=_rounded(speed), torque_ratio=round(ratio, 2))


def _rounded(speed_hz: float) -> float:
    """To a hundredth, and slow ones to four digits."""
    return round(speed_hz, max(2, 3 - int(np.floor(np.log10(speed_hz))))) if speed_hz > 0.0 else 0.0


def alike(a: Point, b: Point) -> bool:
    """Whether two operating points count as one."""
    close = abs(a.speed_hz - b.speed_hz) <= SAME_SPEED * b.speed_hz
    return close and abs(a.torque_ratio - b.torque_ratio) <= SAME_TORQUE * max(abs(b.torque_ratio), 0.1)


def _measured(
    one: Steady, machine: MachineSpec, watched: WatchList, stated_hz: float, part: slice = slice(None)
) -> Statistics:
    """The bands' edges go with the speed: a line of the teeth is then in one band in all recordings of a point."""
    bases = bases_at(machine, one.speed_hz)
    bands = watched.bands(bases_at(machine, stated_hz)).at(one.speed_hz / stated_hz)
    lines, modulations = watched.line_hz(bases), watched.modulation_hz(bases)
    return extract(
        one.samples[:, part],
        one.rate_hz,
        lines_hz=lines,
        line_slack=slack(watched.lines, lines),
        modulations_hz=modulations,
        modulation_slack=slack(watched.modulations, modulations),
        turning=watched.turning(bases),
        phased=watched.phased,
        bands=bands,
    )


def grouped(machine: MachineSpec, recordings: Sequence[Recording]) -> list[tuple[Point, list[Recording]]]:
    """By the operating points that they state."""
    groups: list[tuple[Point, list[Recording]]] = []
    for recording in recordings:
        point = point_of(machine, recording)
        for known, members in groups:
            if alike(point, known):
                members.append(recording)
                break
        else:
            groups.append((point, [recording]))
    return groups


def tooth_orders(machine: MachineSpec) -> list[float]:
    """Of the teeth on the drive shaft, and their multiples."""
    teeth = sorted({float(g.teeth) for g in machine.gears if _drives(machine, g.shaft)})
    return [n * z for n in range(1, TOOTH_ORDERS + 1) for z in teeth]


def observe(
    machine: MachineSpec,
    watched: WatchList,
    tests: Sequence[Recording],
    baselines: Sequence[Recording],
    *,
    seed: int = 0,
) -> tuple[PointData, ...]:
    """Every operating point of the tests; where baselines exist, only points that have one."""
    orders = tooth_orders(machine)
    slowest = _slowest(machine)
    known = grouped(machine, baselines)
    which = sides(machine, tests[0].channels)
    found = []
    for point, members in grouped(machine, tests):
        resting = next((b for p, b in known if alike(p, point)), None)
        if known and resting is None:
            continue
        now, before = ([_steady(r, orders, slowest, seed) for r in several] for several in (members, resting or ()))
        stated = point.speed_hz
        bases = bases_at(machine, stated)
        one = PointData(
            point=point,
            lines_hz=watched.line_hz(bases),
            modulations_hz=watched.modulation_hz(bases),
            test=averaged([_measured(s, machine, watched, stated) for s in now]),
            halves=(
                averaged([_measured(s, machine, watched, stated, slice(0, _middle(s))) for s in now]),
                averaged([_measured(s, machine, watched, stated, slice(_middle(s), None)) for s in now]),
            ),
            baseline=averaged([_measured(s, machine, watched, stated) for s in before]) if before else None,
            spectra=(now[0], before[0] if before else None),
            turned=tuple(s.estimate for s in now),
            turned_before=tuple(s.estimate for s in before),
        )
        found.append(_on_one_side(one, watched, which))
    if not found:
        message = "no baseline was recorded at the speed and load of any test"
        given, allowed = _points(grouped(machine, tests)), f"the points of the baselines: {_points(known)}"
        raise SpecError(Problem(field="baseline", message=message, given=given, allowed=allowed))
    return tuple(found)


def _on_one_side(one: PointData, watched: WatchList, which: Sides) -> PointData:
    """With the test's motion across the load in the baseline's image."""
    channels = mirrored(one.test, one.baseline, watched, which) if one.baseline is not None else ()
    if not channels:
        return one
    halves = (turned_round(one.halves[0], channels), turned_round(one.halves[1], channels))
    return replace(one, test=turned_round(one.test, channels), halves=halves, mirrored=channels)


def _middle(one: Steady) -> int:
    return int(one.samples.shape[1]) // 2


def unpaired(machine: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording]) -> tuple[str, ...]:
    """What is told of tests that no baseline was recorded beside, where there are any baselines: they are left out."""
    known = grouped(machine, baselines)
    alone = [one for one in grouped(machine, tests) if not any(alike(p, one[0]) for p, _ in known)] if known else []
    if not alone:
        return ()
    return (f"{LEFT_OUT}: tests at {_points(alone)}; baselines were recorded at {_points(known)} only",)


def _points(groups: Sequence[tuple[Point, Sequence[Recording]]]) -> str:
    """`30 Hz, torque ratio 1 (t1.json, t2.json)` of each."""
    said = []
    for point, members in groups:
        labels = ", ".join(one.label for one in members if one.label)
        said.append(f"{point.speed_hz:g} Hz, torque ratio {point.torque_ratio:g}" + (f" ({labels})" if labels else ""))
    return "; ".join(said)


def _steady(recording: Recording, orders: Sequence[float], slowest: float, seed: int) -> Steady:
    with about(recording.label):
        return steady(recording, orders=orders, slowest=slowest, seed=seed)


def _drives(machine: MachineSpec, shaft: str) -> bool:
    return machine.operating is not None and shaft == machine.operating.shaft


def least_turns(found: Sequence[PointData]) -> float:
    """Revolutions of the drive shaft in the shortest test."""
    return float(min(d.test.duration_s * d.point.speed_hz for d in found))


def finite_channels(found: Sequence[PointData]) -> np.ndarray:
    """Mask of channels with a signal at every point, shape (C,)."""
    return np.asarray(np.all([np.nanmax(d.test.band, axis=1) > 0 for d in found], axis=0))


def _slowest(machine: MachineSpec) -> float:
    """Turns of the slowest shaft a revolution of the drive shaft."""
    turning = [hz for base, hz in bases_at(machine, 1.0).items() if base.startswith("f_r") and hz > 0.0]
    return min(turning, default=1.0)
