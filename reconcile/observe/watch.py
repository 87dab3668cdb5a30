"""Which lines are watched: what a machine with this geometry could show under any effect, from its kinematics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from reconcile.observe.mean_turn import Turning
from reconcile.observe.statistics import Bands, bands_beside
from signals.series import FloatArray
from sim.assembly.assemble import predicted_lines
from sim.core.spec import MachineSpec, OperatingSpec

SHAFT_ORDERS = 6
MESH_ORDERS = 6
MESH_SIDEBANDS = 3
OUTER_ORDERS = 8
ROLLING_ORDERS = 4
ROLLING_SIDEBANDS = 2
DOUBLED_MESH = 3
"""Mesh harmonics up to which second sidebands count one by one: an angle between the shafts at a coupling (0.12 rad,
w003 of the proof) raised those of the first three by up to 20 dB, and none beyond by more than 5."""
SAME_HZ_SHARE = 1e-3
"""Lines closer than this share of the drive shaft's speed are one line (equal bearings on one shaft)."""
SLIPPING = ("f_o", "f_i", "f_b", "f_c")
"""Bases whose true value lies within a slip window of the geometric one."""


@dataclass(frozen=True, kw_only=True)
class Watched:
    """A line of the watch list. `orders` maps bases to multiples (halves allowed); `family` groups it."""

    label: str
    orders: Mapping[str, float]
    family: str
    slips: bool

    @property
    def first_sideband(self) -> bool:
        """Of a mesh harmonic, one turn of a shaft away."""
        return self._sideband(1)

    @property
    def second_sideband(self) -> bool:
        """Of a lower mesh harmonic, two turns of a shaft away."""
        mesh = max((n for b, n in self.orders.items() if b.startswith("f_m")), default=0.0)
        return self._sideband(2) and mesh <= DOUBLED_MESH

    def _sideband(self, order: int) -> bool:
        return self.family == "sideband" and any(abs(n) == order for b, n in self.orders.items() if b.startswith("f_r"))

    def frequency_hz(self, bases_hz: Mapping[str, float]) -> float:
        """Frequency for these base frequencies, Hz."""
        return abs(sum(n * bases_hz[base] for base, n in self.orders.items()))


@dataclass(frozen=True, kw_only=True)
class WatchList:
    """Lines watched in the spectrum, and modulations watched in the squared envelope of each band."""

    lines: tuple[Watched, ...]
    modulations: tuple[Watched, ...]
    gears: tuple[tuple[str, tuple[int, ...]], ...] = ()
    """Shafts (base of their speed) with gears in mesh, and the numbers of teeth."""

    @cached_property
    def slips(self) -> np.ndarray:
        """Mask over `lines`, shape (lines,): the true frequency may differ from the geometric one by slip."""
        return np.array([w.slips for w in self.lines], dtype=bool)

    @cached_property
    def own(self) -> np.ndarray:
        """Mask over `lines`, shape (lines,): what a sound machine makes and each of which counts for itself; the mesh's
        harmonics, or where there are no teeth the shafts' and those of balls that pass."""
        if self.gears:
            return np.array([w.family == "mesh" for w in self.lines], dtype=bool)
        return np.array([w.family in ("shaft", "outer") for w in self.lines], dtype=bool)

    @cached_property
    def beside(self) -> np.ndarray:
        """Mask over `lines`, shape (lines,): what modulates these; the first sidebands of the mesh, or the lines of
        inner rings and balls."""
        if self.gears:
            return np.array([w.first_sideband for w in self.lines], dtype=bool)
        return np.array([w.family in ("inner", "ball") for w in self.lines], dtype=bool)

    @cached_property
    def twice(self) -> np.ndarray:
        """Mask over `lines`, shape (lines,): what modulates the mesh twice a turn, its second sidebands."""
        return np.array([w.second_sideband for w in self.lines], dtype=bool)

    @cached_property
    def phased(self) -> tuple[int, ...]:
        """Numbers of the lines whose phases are compared between sensors: the mesh's and their first sidebands."""
        return tuple(i for i, line in enumerate(self.lines) if line.family == "mesh" or line.first_sideband)

    def line_hz(self, bases_hz: Mapping[str, float]) -> FloatArray:
        """Frequencies of the lines, shape (lines,), Hz."""
        return np.array([w.frequency_hz(bases_hz) for w in self.lines])

    def modulation_hz(self, bases_hz: Mapping[str, float]) -> FloatArray:
        """Frequencies of the modulations, shape (modulations,), Hz."""
        return np.array([w.frequency_hz(bases_hz) for w in self.modulations])

    def bands(self, bases_hz: Mapping[str, float]) -> Bands:
        """The bands, clear of the teeth's lines."""
        return bands_beside([w.frequency_hz(bases_hz) for w in self.lines if w.family == "mesh"])

    def turning(self, bases_hz: Mapping[str, float]) -> tuple[Turning, ...]:
        """The shafts whose mean turns are watched."""
        return tuple(Turning(hz=bases_hz[base], teeth=teeth) for base, teeth in self.gears)


def bases_at(machine: MachineSpec, speed_hz: float) -> dict[str, float]:
    """Base frequencies with the drive shaft at `speed_hz`, Hz; slip of the machine's own terms is not applied."""
    bare = machine.model_copy(update={"terms": [], "operating": _at(machine, speed_hz)})
    return predicted_lines(bare)[1]


def _at(machine: MachineSpec, speed_hz: float) -> OperatingSpec:
    if machine.operating is None:
        raise ValueError("the machine has no operating point")
    return machine.operating.model_copy(update={"speed_hz": speed_hz, "profile": None})


def _watched(orders: Mapping[str, float], family: str) -> Watched:
    kept = {base: n for base, n in orders.items() if n}
    label = "".join(f"{n:+g}*{base}" for base, n in kept.items()).removeprefix("+")
    return Watched(label=label, orders=kept, family=family, slips=any(b.startswith(SLIPPING) for b in kept))


def _shaft_lines(shafts: Sequence[str]) -> list[Watched]:
    halves = [_watched({s: 0.5 * k}, "subharmonic") for s in shafts for k in (1, 3)]
    return [_watched({s: k}, "shaft") for s in shafts for k in range(1, SHAFT_ORDERS + 1)] + halves


def _mesh_lines(meshes: Sequence[str], shafts: Sequence[str]) -> list[Watched]:
    found = [_watched({m: k}, "mesh") for m in meshes for k in range(1, MESH_ORDERS + 1)]
    for mesh in meshes:
        for k in range(1, MESH_ORDERS + 1):
            for shaft in shafts:
                for j in range(1, MESH_SIDEBANDS + 1):
                    found += [_watched({mesh: k, shaft: sign * j}, "sideband") for sign in (-1, 1)]
    return found


def _bearing_lines(number: str, shaft: str) -> list[Watched]:
    found = [_watched({f"f_o{number}": k}, "outer") for k in range(1, OUTER_ORDERS + 1)]
    for k in range(1, ROLLING_ORDERS + 1):
        for j in range(-ROLLING_SIDEBANDS, ROLLING_SIDEBANDS + 1):
            found.append(_watched({f"f_i{number}": k, shaft: j}, "inner"))
            found.append(_watched({f"f_b{number}": 2 * k, f"f_c{number}": j}, "ball"))
    return found + [_watched({f"f_c{number}": k}, "cage") for k in (1, 2)]


def _modulates(line: Watched) -> bool:
    """Two harmonics of each rolling frequency, and the shaft's sidebands of the inner ring's first one."""
    if len(line.orders) == 1:
        return max(line.orders.values()) <= (4 if line.family == "ball" else 2)
    return line.family == "inner" and line.label.startswith("1*")


def _distinct(lines: Sequence[Watched], bases: Mapping[str, float], unit_hz: float) -> tuple[Watched, ...]:
    seen: dict[int, Watched] = {}
    for line in lines:
        hz = line.frequency_hz(bases)
        key = round(hz / (SAME_HZ_SHARE * unit_hz))
        if hz > 0 and not {key - 1, key, key + 1} & seen.keys():
            seen[key] = line
    return tuple(seen.values())


def _bearing_shafts(machine: MachineSpec) -> dict[str, str]:
    """Number of each bearing -> base of its shaft's speed."""
    names = {b.name: str(i + 1) for i, b in enumerate(machine.bearings)}
    bodies = {g.name: g.shaft for g in machine.gears} | {b.name: b.shaft for b in machine.bodies}
    order = {s.name: f"f_r{i + 1}" for i, s in enumerate(machine.shafts)}
    return {names[b.name]: order.get(bodies.get(b.body) or "", "") for b in machine.bearings}


def _geared(machine: MachineSpec) -> tuple[tuple[str, tuple[int, ...]], ...]:
    """Shafts with gears in mesh, and the numbers of teeth."""
    meshing = {name for m in machine.meshes for name in (m.pinion, m.gear)}
    found = []
    for i, shaft in enumerate(machine.shafts, 1):
        teeth = tuple(sorted({g.teeth for g in machine.gears if g.shaft == shaft.name and g.name in meshing}))
        if teeth:
            found.append((f"f_r{i}", teeth))
    return tuple(found)


def watch_list(machine: MachineSpec) -> WatchList:
    """Everything watched on this machine; the same list at every speed."""
    if machine.operating is None:
        return WatchList(lines=(), modulations=())
    speed = machine.operating.speed_hz
    bases = bases_at(machine, speed)
    shafts = [b for b in bases if b.startswith("f_r")]
    meshes = [b for b in bases if b.startswith("f_m")]
    lines = _shaft_lines(shafts) + _mesh_lines(meshes, shafts)
    rolling: list[Watched] = []
    for number, shaft in _bearing_shafts(machine).items():
        if f"f_o{number}" in bases and shaft in bases:
            rolling += _bearing_lines(number, shaft)
    modulations = [_watched({s: k}, "shaft") for s in shafts for k in (1, 2, 3)]
    modulations += [w for w in rolling if _modulates(w)]
    return WatchList(
        lines=_distinct(lines + rolling, bases, speed),
        modulations=_distinct(modulations, bases, speed),
        gears=_geared(machine),
    )
