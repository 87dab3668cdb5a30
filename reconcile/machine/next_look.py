"""What further recordings would add between the first two effects of an answer, by the draws that are at hand.

Were the first effect there, the recordings would look like its draws near to what was observed. How much farther such a
draw lies from the nearest of the second effect than from another of the first is what tells the two apart: draws of one
effect lie apart too, as its other parameters and the machine differ. Halved and over the overdispersion it is a log
evidence. It is laid out over operating points and channels, and a further recording adds what its point adds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from reconcile.atlas.places import sensor_sites
from reconcile.judge.changes import Changes
from reconcile.judge.pooled import seen
from reconcile.judge.space import Fitted, Library
from reconcile.machine.setting import Found, Setting
from reconcile.verdict import operating_point
from signals.series import FloatArray
from sim.core.spec import MachineSpec

NEAREST = 6
"""Draws of the first effect that stand for it."""
SURE = 2.0
"""Standard errors over these draws, below which what a point tells is chance."""
NOISES = 64
EVEN = 1.25
"""Times their mean up to which no point stands out, and a further speed tells as much as one of those at hand."""
ADDS = 0.5
"""Log evidence (1.6 times as likely) below which a recording is expected to add nothing."""


@dataclass(frozen=True, kw_only=True)
class Apart:
    """What each operating point and channel tells between two effects, were the first there: `told` (P, C) in log
    evidence (natural), `points` and `channels` by name; `longer`: what records twice as long would add, at most;
    `unheard`: of places of gears and shafts the bearings on their shafts that no sensor is at."""

    told: FloatArray
    points: tuple[str, ...]
    channels: tuple[str, ...]
    longer: float = 0.0
    unheard: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def by_point(self) -> FloatArray:
        """(P,): what a further recording like that of each operating point is expected to add."""
        return np.asarray(np.maximum(self.told.sum(axis=1), 0.0))

    @property
    def loudest(self) -> str:
        """The channel that tells the two apart best."""
        return self.channels[int(np.argmax(self.told.sum(axis=0)))]


@dataclass(frozen=True, kw_only=True)
class Look:
    """A further recording and what it is expected to add, log evidence: of `kind` `point` (like that at `place`),
    `speed` (at one more) or `longer` (all of them), or `nothing`, where none adds any."""

    kind: str
    adds: float
    place: str = ""


def best_look(apart: Apart) -> Look:
    """The recording that is expected to add most: at the operating point that tells most, at one more, where all tell
    about the same (the mean of those at hand), or twice as long at all."""
    told = apart.by_point
    best, mean = int(np.argmax(told)), float(told.mean())
    again = Look(kind="point", adds=float(told[best]), place=apart.points[best])
    further = Look(kind="speed", adds=mean)
    look = further if told[best] <= EVEN * mean else again
    if apart.longer > look.adds:
        look = Look(kind="longer", adds=apart.longer)
    return look if look.adds >= ADDS else Look(kind="nothing", adds=look.adds)


def apart_of(setting: Setting, found: Found, chosen: Sequence[str]) -> Apart | None:
    """What tells the first two effects apart, in the view that speaks for the first; None where one of them has no
    draws."""
    library = found.known.library
    if len(chosen) < 2 or any(not library.groups.get(name) for name in chosen[:2]):
        return None
    view, changes = found.view(chosen[0]), setting.changes
    points, channels = len(setting.data), len(setting.channels)
    told, noise = _told(view, library, changes, chosen, (points, channels), setting.seed)
    whole = float(np.maximum(told.sum(axis=1), 0.0).sum())
    return Apart(
        told=told,
        points=tuple(operating_point(d.point.speed_hz, d.point.torque_ratio) for d in setting.data),
        channels=setting.channels,
        longer=whole * noise / (2.0 - noise),
        unheard=unheard(setting.machine, sensor_sites(setting.machine, setting.simulated)),
    )


def unheard(machine: MachineSpec, heard: Sequence[str]) -> dict[str, tuple[str, ...]]:
    """Of each gear, mesh and shaft that runs in bearings, those of them that are not `heard`."""
    on = {g.name: g.shaft for g in machine.gears} | {b.name: b.shaft for b in machine.bodies if b.shaft}
    shafts = {s.name: {s.name} for s in machine.shafts} | {name: {shaft} for name, shaft in on.items()}
    shafts |= {m.name: {on[m.pinion], on[m.gear]} for m in machine.meshes}
    carried = {site: [b.name for b in machine.bearings if on.get(b.body) in of] for site, of in shafts.items()}
    return {site: tuple(b for b in several if b not in heard) for site, several in carried.items() if several}


def _told(
    view: Fitted, library: Library, changes: Changes, chosen: Sequence[str], shape: tuple[int, int], seed: int
) -> tuple[FloatArray, float]:
    """`Apart.told` (P, C), mean over the first effect's nearest draws, and the share of noise in what scatters between
    the two, 0..1."""
    first, second = (library.changes[list(library.groups[name])] for name in chosen[:2])
    own, other = _placed(view, first), _placed(view, second)
    near = np.argsort(np.sum((own - view.place(changes.observed)) ** 2, axis=1))[:NEAREST]
    tables, shares = [], []
    for k in near:
        rival = int(np.argmin(np.sum((other - own[k]) ** 2, axis=1)))
        table = laid_out(view, first[k], second[rival], shape)
        away = np.sum((own - own[k]) ** 2, axis=1)
        away[k] = np.inf
        if len(own) > 1:
            table = table - laid_out(view, first[k], first[int(np.argmin(away))], shape)
        tables.append(table)
        shares.append(_noise(view, first[k], own[k] - other[rival], changes.measured, seed))
    return _sure(np.array(tables)) / (2.0 * view.overdispersion), float(np.mean(shares))


def _sure(tables: FloatArray) -> FloatArray:
    """Mean (P, C) of what each draw tells, (n, P, C); zero at points where the draws differ so much that it may be
    chance."""
    by_point = tables.sum(axis=2)
    error = by_point.std(axis=0, ddof=1) / np.sqrt(len(tables)) if len(tables) > 1 else np.zeros(by_point.shape[1])
    sure = by_point.mean(axis=0) > SURE * error
    return np.asarray(tables.mean(axis=0) * sure[:, None])


def _placed(view: Fitted, changes: FloatArray) -> FloatArray:
    """(n, F) -> (n, D)."""
    return view.metric(seen(view.view, view.whiten, changes))


def laid_out(view: Fitted, one: FloatArray, other: FloatArray, shape: tuple[int, int]) -> FloatArray:
    """Squared distance of two changes (F,) over operating points and channels, `shape` (P, C), of which it is the sum:
    in proportion to how far the second moves when it has the first's features of one point and channel."""
    count = shape[0] * shape[1]
    mixed = np.tile(other.reshape(count, -1), (count, 1, 1))
    mixed[np.arange(count), np.arange(count)] = one.reshape(count, -1)
    places = _placed(view, np.stack([one, other, *mixed.reshape(count, -1)]))
    moved = np.sum((places[2:] - places[1]) ** 2, axis=1)
    whole = float(np.sum((places[0] - places[1]) ** 2))
    return np.asarray(whole * moved / max(float(moved.sum()), 1e-300)).reshape(shape)


def _noise(view: Fitted, change: FloatArray, way: FloatArray, measured: FloatArray, seed: int) -> float:
    """Share of what the recordings' own deviations `measured` (F,) scatter along a `way` (D,) in all that counts as
    scatter there: only that falls with their length."""
    length = float(np.linalg.norm(way))
    if length == 0.0:
        return 0.0
    drawn = np.random.default_rng([seed, 11]).normal(size=(NOISES, change.size)) * np.nan_to_num(measured)
    along = _placed(view, change + drawn) @ way / length
    return min(float(np.var(along)) / view.overdispersion, 1.0)
