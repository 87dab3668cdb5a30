"""Stage 3, in angle: where in a gear's turn the residual gathers, against the baseline."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import bases_at
from reconcile.observe.whole_turn import WholeTurn, standing, whole_turn
from reconcile.verdict import AngleWindow
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

USUAL, SHARE, SCALE = 0.28, 0.05, 0.2
"""Of the sum over operating points of how far a window stands out: a twentieth of the looks at gears whose teeth are
sound, whatever else is wrong, is above the first and falls off by a factor e every 0.2. Of 110 such looks of the
proof's split `entire` the highest reached 0.62; seven cracked teeth of 6 to 10 % heard by three sensors 2.7 to 6.1."""
PLACED, PLACED_BARE = 1.0, 2.0
"""The same from which a place is told; the second where a point has no baseline. Without their baselines the 110 reach
1.66 (a sensor's fault), the seven 2.4 and more."""


@dataclass(frozen=True, kw_only=True)
class ToothPlace:
    """How far the fullest windows of a gear's mean turns stand out, over all operating points; the turns of the
    strongest of these and its angle at the first sample, in turns. `bare`: not all of them have a baseline."""

    shaft: str
    standing: float
    strongest: WholeTurn | None
    start_turns: float
    bare: bool = False

    @property
    def evidence(self) -> float:
        """Log evidence of a faulty tooth: minus the log of how rare it is elsewhere."""
        return max(0.0, (self.standing - USUAL) / SCALE + float(np.log(1 / SHARE)) - 1.0) if self.told else 0.0

    @property
    def told(self) -> bool:
        """Whether there is a place at all."""
        return self.standing >= (PLACED_BARE if self.bare else PLACED)

    @property
    def chance(self) -> float:
        """Of so much on a gear whose teeth are sound."""
        return min(1.0, SHARE * float(np.exp(-(self.standing - USUAL) / SCALE))) if self.told else 1.0


def tooth_places(machine: MachineSpec, data: Sequence[PointData]) -> dict[str, ToothPlace]:
    """For every gear in a mesh; none where a shaft's speed is not known."""
    found: dict[str, list[tuple[float, WholeTurn | None, float]]] = {}
    shafts: dict[str, str] = {}
    for one in data:
        now, before = one.spectra
        for gear in _known(machine, now.speed_hz):
            turn, rested = _turn(now, gear), _turn(before, gear) if before is not None else None
            shafts[gear.name] = gear.shaft
            found.setdefault(gear.name, []).append((standing(turn, rested), turn, now.start_turns * gear.ratio))
    bare = any(one.baseline is None for one in data)
    return {name: _summed(shafts[name], points, bare) for name, points in found.items()}


def _summed(shaft: str, points: Sequence[tuple[float, WholeTurn | None, float]], bare: bool) -> ToothPlace:
    _, strongest, start = max(points, key=lambda p: p[0])
    total = sum(p[0] for p in points)
    return ToothPlace(shaft=shaft, standing=total, strongest=strongest, start_turns=start, bare=bare)


def angle_window(places: Mapping[str, ToothPlace]) -> AngleWindow | None:
    """The window that stands out most among all gears; None where none is told.

    Angles are those of the gear's shaft from the tacho's pulse on, without one from the first sample on.
    """
    best = max(places.values(), key=lambda p: p.standing, default=None)
    if best is None or not best.told or best.strongest is None:
        return None
    return window_of(best.strongest, shaft=best.shaft, start_turns=best.start_turns)


def window_of(turn: WholeTurn, *, shaft: str, start_turns: float = 0.0) -> AngleWindow:
    """The fullest window to half its height; `start_turns`: angle of the shaft at the first sample."""
    steps, at = turn.windows.size, turn.at
    middle = steps // 2
    below = np.flatnonzero(np.roll(turn.windows, middle - at) <= turn.height / 2)
    low = int(np.max(below[below < middle], initial=-1)) + 1
    high = int(np.min(below[below > middle], initial=steps)) - 1
    centre, step = (360.0 * (at / steps + start_turns)) % 360.0, 360.0 / steps
    return AngleWindow(
        shaft=shaft,
        centre_deg=centre,
        low_deg=centre - step * (middle - low),
        high_deg=centre + step * (high - middle),
    )


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


def _turn(one: Steady, gear: _Gear) -> WholeTurn | None:
    angle = np.arange(one.samples.shape[1]) * (one.speed_hz * gear.ratio / one.rate_hz)
    turns = np.asarray(angle, dtype=np.float64)
    return whole_turn(one.samples, turns, teeth=gear.teeth)
