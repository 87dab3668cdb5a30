"""Stage 3, in angle: the place of each gear's turn at which the residual gathers, against the baseline."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.tooth_place import ToothPlace, placed
from reconcile.observe.watch import bases_at
from reconcile.observe.whole_turn import WholeTurn, of_as_many_turns, standing, whole_turn
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec


def tooth_places(machine: MachineSpec, data: Sequence[PointData]) -> dict[str, ToothPlace]:
    """For every gear in a mesh; none where a shaft's speed is not known."""
    found: dict[str, list[tuple[float, WholeTurn | None, float]]] = {}
    shafts: dict[str, str] = {}
    for one in data:
        now, before = one.spectra
        for gear in _known(machine, now.speed_hz):
            turn, rested = of_as_many_turns(partial(_turn, now, gear), partial(_turn, before, gear))
            shafts[gear.name] = gear.shaft
            found.setdefault(gear.name, []).append((standing(turn, rested), turn, now.start_turns * gear.ratio))
    bare = any(one.baseline is None for one in data)
    return {name: placed(shafts[name], points, bare=bare) for name, points in found.items()}


@dataclass(frozen=True, kw_only=True)
class _Gear:
    """`ratio`: turns a revolution of the drive shaft; `teeth`: its own, then those of others on its shaft."""

    name: str
    shaft: str
    ratio: float
    teeth: tuple[int, ...]


def _known(machine: MachineSpec, speed_hz: float) -> tuple[_Gear, ...]:
    try:
        return tuple(_gears(machine, speed_hz))
    except SpecError:  # a shaft that nothing ties to the driven one
        return ()


def _gears(machine: MachineSpec, speed_hz: float) -> Iterator[_Gear]:
    """Every gear in a mesh."""
    bases = bases_at(machine, speed_hz)
    ratios = {s.name: bases[f"f_r{i}"] / speed_hz for i, s in enumerate(machine.shafts, start=1)}
    gears = {gear.name: gear for gear in machine.gears}
    meshing = [gears[name] for mesh in machine.meshes for name in (mesh.pinion, mesh.gear)]
    for gear in {g.name: g for g in meshing}.values():
        ratio = ratios[gear.shaft]
        here = tuple(g.teeth for g in meshing if g.shaft == gear.shaft and g.name != gear.name)
        yield _Gear(name=gear.name, shaft=gear.shaft, ratio=ratio, teeth=(gear.teeth, *here))


def _turn(one: Steady | None, gear: _Gear, most: int) -> WholeTurn | None:
    if one is None:
        return None
    angle = np.arange(one.samples.shape[1]) * (one.speed_hz * gear.ratio / one.rate_hz)
    turns = np.asarray(angle, dtype=np.float64)
    return whole_turn(one.samples, turns, teeth=gear.teeth, most_turns=most)
