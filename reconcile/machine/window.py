"""Stage 3, in angle: the place of each gear's turn at which the residual gathers, against the baseline."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.tooth_place import Look, ToothPlace, placed
from reconcile.observe.watch import bases_at
from reconcile.observe.whole_turn import Burst, Turned, burst_of, standing, whole_turns
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

ALIKE = 1e-6
"""Relative difference of the turns of two gears below which they turn alike: on one shaft, or in a mesh of 1 to 1."""


def tooth_places(machine: MachineSpec, data: Sequence[PointData]) -> dict[str, ToothPlace]:
    """For every gear in a mesh; none where a shaft's speed is not known."""
    found: dict[str, list[Look]] = {}
    shafts: dict[str, str] = {}
    ratios: dict[str, float] = {}
    for one in data:
        now, before = one.spectra
        for gear in gears_in_mesh(machine, now.speed_hz):
            rest = _turned(before, gear) if before is not None else None
            turn, rested = whole_turns(_turned(now, gear), rest, teeth=gear.teeth)
            shafts[gear.name] = gear.shaft
            look = Look(
                standing=standing(turn, rested),
                turn=turn,
                start_turns=now.start_turns * gear.ratio,
                speed_hz=now.speed_hz,
            )
            found.setdefault(gear.name, []).append(look)
            ratios[gear.name] = gear.ratio
    bare = any(one.baseline is None for one in data)
    places = {name: placed(shafts[name], looks, bare=bare) for name, looks in found.items()}
    return {name: _of_its_turn(name, places, ratios) for name in places}


def _of_its_turn(name: str, places: Mapping[str, ToothPlace], ratios: Mapping[str, float]) -> ToothPlace:
    """The place that stands out most of all gears that turn alike: nothing tells whose tooth it is."""
    alike = [p for other, p in places.items() if abs(ratios[other] / ratios[name] - 1.0) < ALIKE]
    return max(alike, key=lambda p: p.standing)


@dataclass(frozen=True, kw_only=True)
class TurningGear:
    """`ratio`: turns a revolution of the drive shaft; `teeth`: its own, then those of others on its shaft."""

    name: str
    shaft: str
    ratio: float
    teeth: tuple[int, ...]


def gears_in_mesh(machine: MachineSpec, speed_hz: float) -> tuple[TurningGear, ...]:
    """All that mesh; none where a shaft's speed is not known."""
    try:
        return tuple(_gears(machine, speed_hz))
    except SpecError:  # a shaft that nothing ties to the driven one
        return ()


def _gears(machine: MachineSpec, speed_hz: float) -> Iterator[TurningGear]:
    """Every gear in a mesh."""
    bases = bases_at(machine, speed_hz)
    ratios = {s.name: bases[f"f_r{i}"] / speed_hz for i, s in enumerate(machine.shafts, start=1)}
    gears = {gear.name: gear for gear in machine.gears}
    meshing = [gears[name] for mesh in machine.meshes for name in (mesh.pinion, mesh.gear)]
    for gear in {g.name: g for g in meshing}.values():
        ratio = ratios[gear.shaft]
        here = tuple(g.teeth for g in meshing if g.shaft == gear.shaft and g.name != gear.name)
        yield TurningGear(name=gear.name, shaft=gear.shaft, ratio=ratio, teeth=(gear.teeth, *here))


def turned_at(samples: FloatArray, rate_hz: float, turn_hz: float) -> Turned:
    """Samples (C, n) of a gear that turns evenly."""
    angle = np.arange(samples.shape[1]) * (turn_hz / rate_hz)
    return Turned(samples=samples, turns=np.asarray(angle, dtype=np.float64))


def _turned(one: Steady, gear: TurningGear) -> Turned:
    return turned_at(one.samples, one.rate_hz, one.speed_hz * gear.ratio)


def burst_at(one: PointData, gear: TurningGear, *, top_hz: float) -> Burst | None:
    """How far the burst of a tooth stands out of a gear's mean turn below a frequency; None without a baseline."""
    now, before = one.spectra
    if before is None:
        return None
    orders = int(top_hz / (now.speed_hz * gear.ratio))
    return burst_of(_turned(now, gear), _turned(before, gear), teeth=gear.teeth, orders=orders)
