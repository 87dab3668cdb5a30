"""The lines whose level changed, by the names of the machine's file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.machine.pictures import place_of
from reconcile.observe.features import Layout
from reconcile.observe.observation import PointData, heard_hz
from reconcile.observe.slack import slack
from reconcile.observe.watch import WatchList, bases_at
from reconcile.verdict import LineChange
from sim.core.spec import MachineSpec

MOST_LINES = 15
STANDS_OUT = 3.0
ALIKE_DB = 1.0
"""Two lines looked for around one peak changed by as much; what else differs is how their noise is counted."""
OR = " or "
FOLLOWS = {
    "f_o": "outer ring of bearing",
    "f_i": "inner ring of bearing",
    "f_b": "balls of bearing",
    "f_c": "cage of bearing",
    "f_m": "mesh",
    "f_r": "shaft",
}


def line_changes(
    data: Sequence[PointData], changes: Changes, layout: Layout, watched: WatchList, channels: Sequence[str]
) -> tuple[LineChange, ...]:
    """Watched lines that changed by more than three of their deviations, the largest first."""
    known = np.isfinite(changes.null).any(axis=0)
    drift = np.full(known.size, np.nan)
    drift[known] = np.nanstd(changes.null[:, known], axis=0)
    z = changes.observed / np.sqrt(changes.measured**2 + drift**2 + 1.0)
    rows: list[_Row] = []
    for p, one in enumerate(data):
        reach = slack(watched.lines, one.lines_hz) * one.lines_hz
        for c, name in enumerate(channels):
            start = changes.starts[p] + c * layout.size
            for i, line in enumerate(watched.lines):
                value = z[start + i]
                if np.isfinite(value) and abs(value) > STANDS_OUT:
                    found = LineChange(
                        label=line.label,
                        frequency_hz=heard_hz(one, i),
                        change_db=float(changes.observed[start + i]),
                        channel=name,
                        locked_to=locked_to(line.orders),
                        **place_of(one),
                    )
                    at = (p, c)
                    rows.append(_Row(deviations=abs(float(value)), line=found, reach_hz=float(reach[i]), at=at))
    rows.sort(key=lambda row: -row.deviations)
    return tuple(_heard(row, data) for row in _once(rows)[:MOST_LINES])


@dataclass(frozen=True, kw_only=True)
class _Row:
    """A line, by how many deviations it changed, and how far from its geometric frequency it was looked for; `at`:
    numbers of operating point and channel; `also`: other lines that were looked for around the same peak."""

    deviations: float
    line: LineChange
    reach_hz: float
    at: tuple[int, int] = (0, 0)
    also: tuple[LineChange, ...] = ()

    def same_peak(self, other: _Row) -> bool:
        """Whether both were looked for where one and the same peak stands, which changed alike for both."""
        a, b = self.line, other.line
        place = (a.channel, a.speed_hz, a.torque_ratio) == (b.channel, b.speed_hz, b.torque_ratio)
        reach = self.reach_hz + other.reach_hz
        return (
            place and 0.0 < reach >= abs(a.frequency_hz - b.frequency_hz) and abs(a.change_db - b.change_db) < ALIKE_DB
        )


def _once(rows: Sequence[_Row]) -> list[_Row]:
    """One row a peak, the most changed first, with all lines it may be."""
    kept: list[_Row] = []
    for row in rows:
        k = next((k for k, other in enumerate(kept) if other.same_peak(row)), None)
        if k is None:
            kept.append(row)
        else:
            kept[k] = replace(kept[k], also=(*kept[k].also, row.line))
    return kept


def _heard(row: _Row, data: Sequence[PointData]) -> LineChange:
    """The line where its peak stands in the test, if it rose, by the names of all it may be, the nearest first."""
    every = [row.line, *row.also]
    hz = row.line.frequency_hz
    if row.line.change_db > 0.0 and row.reach_hz > 0.0:
        hz = data[row.at[0]].spectra[0].peak_hz(row.at[1], hz, row.reach_hz)
        every.sort(key=lambda x: abs(x.frequency_hz - hz))
    return replace(
        row.line,
        frequency_hz=hz,
        label=OR.join(x.label for x in every),
        locked_to=OR.join(dict.fromkeys(x.locked_to for x in every)),
    )


def locked_to(orders: object) -> str:
    """What a line's frequency follows: `mesh`, `bearing N`, or a shaft."""
    bases = list(orders) if isinstance(orders, dict) else []
    for prefix, word in FOLLOWS.items():
        for base in bases:
            if base.startswith(prefix):
                return f"{word} {base[3:]}".strip()
    return ""


def by_name(lines: Sequence[LineChange], machine: MachineSpec) -> tuple[LineChange, ...]:
    """The lines with parts called as the machine's file calls them: `inner ring of drive_end`, or of each of the
    bearings that have this line."""
    bearings = {f"bearing {i}": OR.join(alike) for i, alike in enumerate(_alike_bearings(machine), 1)}
    shafts = {f"shaft {i}": s.name for i, s in enumerate(machine.shafts, 1)}
    names = bearings | shafts | {f"mesh {i}": m.name for i, m in enumerate(machine.meshes, 1)}

    def told(text: str) -> str:
        kind = next((k for k in names if text.endswith(k)), None)
        return text if kind is None else text.removesuffix(kind) + names[kind]

    def each(text: str) -> str:
        return OR.join(dict.fromkeys(told(t) for t in text.split(OR)))

    return tuple(replace(x, locked_to=each(x.locked_to)) for x in lines)


def _alike_bearings(machine: MachineSpec) -> list[list[str]]:
    """Of every bearing the names of those that roll at its frequencies: only one of them is watched."""
    bases = bases_at(machine, machine.operating.speed_hz) if machine.operating is not None else {}
    count = range(1, len(machine.bearings) + 1)
    own = [[bases.get(f"{kind}{i}", np.nan) for kind in ("f_o", "f_i", "f_b")] for i in count]
    return [
        [b.name for k, b in enumerate(machine.bearings) if k == i or np.allclose(own[k], own[i], rtol=1e-9)]
        for i in range(len(own))
    ]
