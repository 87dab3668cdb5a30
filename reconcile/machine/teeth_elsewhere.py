"""Can the recordings be of this machine at the stated speed? Lines of teeth stand where file and label say, or not.

The orders of all meshes follow from the machine file. Where a comb of lines stands at another order in test and
baseline alike, and none at the file's, either the numbers of teeth are not this machine's, or the speed was not the
stated one, or another machine is all that is heard: no effect is looked for in what the model predicts at places where
nothing stands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import bases_at
from reconcile.speed import estimate_speed, line_logs
from reconcile.speed.elsewhere import lines_elsewhere
from reconcile.speed.estimate import ENOUGH, comb_score
from signals.series import FloatArray
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec

LOWEST, HIGHEST, STEP = 7.0, 260.0, 5e-4
"""Orders of the operating shaft between which teeth are looked for, and how finely, as a share: balls pass at up to
six or so, and seven is a pinion of 21 that was said to turn three times too fast."""
HARMONICS = tuple(float(k) for k in range(1, 7))
TRUSTED = 0.42
"""Share of the sampling rate up to which lines are heard."""
ALIKE = 0.01
"""Share by which one order may differ between recordings: what a label is off the speed."""
NEAR = 0.03
"""Share of their order within which the file's teeth are looked for."""
CLEAR = 7.0
"""Score from which a comb stands, in every recording: teeth of the proof's sound and faulty machines have 8 to 26."""
FAINT = 4.0
"""The same at a point beside another where other teeth than the file's are clear."""
LINE = 1.0
"""Log power over what noise reaches from which a line is one."""
LEAST = 3
"""Harmonics of a comb that must be lines in one recording at least, the first and the second in all."""
WANDER = 0.002
"""Share of its frequency by which a line may be away from its place."""
SILENT = 0.5
"""Share of that of the best comb that the file's teeth must not reach: where both file and label are right they are the
best comb (1.0), where one is wrong they had 0.1 at most, 0.5 where the wrong order is a multiple of the right one."""
SLOWER = tuple(range(2, 13))
BETWEEN = 0.4
"""Parts of an order, and the share of a comb's mean that lines at the multiples of a part must not have: these are a
race's or a shaft's, whose multiples the comb picks."""
KNOWN = 2
"""Multiple of a line of the file up to which a comb may be that line's, were its others not heard."""
FOLLOWED = 0.1
"""Share by which a speed may be off its label and is found and followed."""
DOUBTFUL = 0.05
"""Share from which that may as well be another number of teeth."""


@dataclass(frozen=True, kw_only=True)
class Elsewhere:
    """Lines of teeth (of the shaft: no `mesh`) at `order` times the stated speed at one operating point, its multiples
    `harmonics` in all recordings, where the file has them at `own`. `sure`: pulses or the shaft's own lines confirm the
    stated speed."""

    stated_hz: float
    order: float
    own: float
    mesh: str
    sure: bool
    harmonics: tuple[int, ...] = (1, 2, 3)

    @property
    def factor(self) -> float:
        """The speed at which the file's teeth would be there, over the stated one."""
        return self.order / self.own

    @property
    def hz(self) -> float:
        """The first line's frequency."""
        return self.order * self.stated_hz


def teeth_elsewhere(
    machine: MachineSpec, data: Sequence[PointData], channels: Sequence[Channel]
) -> tuple[tuple[PointData, ...], tuple[Elsewhere, ...]]:
    """The points whose lines of teeth (without any, of the shaft) stand where file and label say, or are not clear;
    and where those of the others stand. A speed that is within `FOLLOWED` of its label stays, unless another number of
    teeth is as likely; lines that stay at one frequency whatever the label are another machine's."""
    bases = bases_at(machine, 1.0)
    meshes = {name: order for name, order in bases.items() if name.startswith("f_m") and order > 0.0}
    found: list[Elsewhere | None] = []
    for point in data:
        one = _of_point(point, meshes, bases, channels) if meshes else _of_shaft(point, channels)
        found.append(None if one is None or _follows(one, machine, point, channels) else one)
    found = [None if one is None or _fixed(one, found) else one for one in found]
    miscounted = [one for one in found if one is not None and teeth_of(one, machine) is not None]
    if miscounted and None in found:  # no machine has other teeth at one speed than at another
        found = [
            one or _as_there(point, miscounted[0], meshes, channels) for point, one in zip(data, found, strict=True)
        ]
    kept = tuple(point for point, one in zip(data, found, strict=True) if one is None)
    return kept, tuple(one for one in found if one is not None)


def _as_there(
    point: PointData, known: Elsewhere, meshes: Mapping[str, float], channels: Sequence[Channel]
) -> Elsewhere | None:
    """The same number of teeth at a point where their lines are not clear by themselves, if they stand there in all
    recordings and the file's do not; None else."""
    heard = [s for s in point.spectra if s is not None]
    grid = known.order * np.exp(np.arange(-ALIKE, ALIKE, STEP))
    for one in heard:
        logs, hz = _line_logs(one, channels), _label_hz(one, point)
        there = float(np.max(_scores(logs, hz, grid)))
        own = [float(np.max(_scores(logs, hz, grid * (mesh / known.order)))) for mesh in meshes.values()]
        if there < FAINT or max(own) > SILENT * there:
            return None
    return replace(known, stated_hz=point.point.speed_hz)


def _fixed(one: Elsewhere, found: Sequence[Elsewhere | None]) -> bool:
    """Whether another point with another label shows the same frequency."""
    others = [o for o in found if o is not None and abs(o.stated_hz / one.stated_hz - 1.0) > 2 * ALIKE]
    return any(abs(o.hz / one.hz - 1.0) <= ALIKE for o in others)


def teeth_of(found: Elsewhere, machine: MachineSpec) -> tuple[str, int, int] | None:
    """The gear on the operating shaft, its teeth in the file, and how many others would stand where the lines are."""
    shaft = machine.operating.shaft if machine.operating is not None else ""
    for gear in machine.gears:
        count = round(found.order)
        if gear.shaft == shaft and gear.teeth == round(found.own) and abs(found.order / count - 1.0) < ALIKE / 2:
            return gear.name, gear.teeth, count
    return None


def _follows(found: Elsewhere, machine: MachineSpec, point: PointData, channels: Sequence[Channel]) -> bool:
    """Whether the speed at which the file's teeth would be there is near the label, and as likely as other teeth."""
    off = abs(found.factor - 1.0)
    if off > FOLLOWED or found.sure:
        return False
    if off <= DOUBTFUL or teeth_of(found, machine) is None:
        return True
    return _by_shaft_alone(point.spectra[0], found.factor * found.stated_hz, channels)


def _by_shaft_alone(one: Steady, speed_hz: float, channels: Sequence[Channel]) -> bool:
    """Whether the shaft's own harmonics, teeth left out, are sure of a speed."""
    try:
        alone = estimate_speed(one.recording(channels), stated_hz=speed_hz)
    except SpecError:
        return False
    return alone.confidence >= ENOUGH and abs(alone.speed_hz / speed_hz - 1.0) <= ALIKE


def _of_point(
    point: PointData, meshes: Mapping[str, float], bases: Mapping[str, float], channels: Sequence[Channel]
) -> Elsewhere | None:
    heard = [s for s in point.spectra if s is not None]
    labels = [_label_hz(s, point) for s in heard]
    top_order = min(TRUSTED * s.rate_hz / hz for s, hz in zip(heard, labels, strict=True))
    audible = [order for order in meshes.values() if order < top_order]
    if not audible:
        return None
    logs = [_line_logs(s, channels) for s in heard]
    comb = _best_comb(logs, labels, meshes)
    if comb is None or _known(float(np.mean(comb)), bases):
        return None
    order = float(np.mean(comb))
    each = list(zip(logs, labels, comb, strict=True))
    lines = [_lines_of(one, hz * fine) for one, hz, fine in each]
    harmonics = tuple(k for k in lines[0] if all(k in other for other in lines))
    if max(len(one) for one in lines) < LEAST or not {1, 2} <= set(harmonics):
        return None
    if any(_of_slower(one, hz * fine) or _stands(one, hz, audible, order) for one, hz, fine in each):
        return None
    mesh = min(meshes, key=lambda name: abs(np.log(order / meshes[name])))
    pulses = all(s.estimate.method == "tacho" for s in heard)
    sure = pulses or _by_shaft_alone(heard[0], labels[0], channels)
    if sure and len(_others(meshes, order)) < len(meshes):
        return None  # the file's teeth are where they belong, whatever else stands between them
    return Elsewhere(
        stated_hz=point.point.speed_hz, order=order, own=meshes[mesh], mesh=mesh, sure=sure, harmonics=harmonics
    )


Logs = Sequence[tuple[FloatArray, float]]
"""Of each channel the log power of lines and the width of a bin, Hz."""


def _best_comb(logs: Sequence[Logs], labels: Sequence[float], meshes: Mapping[str, float]) -> tuple[float, ...] | None:
    """The order of the best comb in each recording; None where none stands in all, or the file's teeth do."""
    grid = np.exp(np.arange(np.log(min(LOWEST, 0.9 * min(meshes.values()))), np.log(HIGHEST), STEP))
    raw = np.array([_scores(one, hz, grid) for one, hz in zip(logs, labels, strict=True)])
    together = np.min(maximum_filter1d(raw, 2 * round(ALIKE / STEP) + 1, axis=1), axis=0)
    looked = np.where(grid >= LOWEST, together, 0.0)
    top = float(np.max(looked))
    middle = float(np.mean(grid[looked >= top - 1e-9]))
    scores = [float(np.max(together[np.abs(np.log(grid / o)) <= NEAR], initial=0.0)) for o in _others(meshes, middle)]
    if top < CLEAR or max(scores, default=0.0) > SILENT * top:
        return None
    return tuple(_finest(grid, one, middle) for one in raw)


def _known(order: float, bases: Mapping[str, float]) -> bool:
    """Whether an order is a low multiple of a line that the file has."""
    return any(abs(order / (k * o) - 1.0) <= ALIKE for o in bases.values() if o > 0.0 for k in range(1, KNOWN + 1))


def _others(meshes: Mapping[str, float], order: float) -> list[float]:
    """The meshes whose lines are not all lines of a comb anyway: no multiples of its order from the second on."""
    return [o for o in meshes.values() if round(o / order) < 2 or abs(o / (round(o / order) * order) - 1.0) > ALIKE]


def _stands(logs: Logs, label_hz: float, meshes: Sequence[float], order: float) -> bool:
    """Whether the file's first line of some teeth is there by itself: not as a multiple of the comb's."""
    own = [mesh for mesh in meshes if abs(mesh / (max(round(mesh / order), 1) * order) - 1.0) > NEAR]
    return any(_level(logs, mesh * label_hz, ALIKE) >= LINE for mesh in own)


def _of_shaft(point: PointData, channels: Sequence[Channel]) -> Elsewhere | None:
    """Without teeth the shaft's own harmonics, three of them at least, where nothing near the label confirms it."""
    heard = [s for s in point.spectra if s is not None]
    if any(s.estimate.method != "stated" for s in heard):
        return None
    far = [lines_elsewhere(s.recording(channels), _label_hz(s, point)) for s in heard]
    found = [one for one in far if one is not None and not one.own]
    speeds = [one.speed_hz / _label_hz(s, point) for one, s in zip(found, heard, strict=False)]
    if len(found) < len(heard) or max(speeds) > (1.0 + ALIKE) * min(speeds):
        return None
    return Elsewhere(
        stated_hz=point.point.speed_hz,
        order=float(np.mean(speeds)),
        own=1.0,
        mesh="",
        sure=False,
        harmonics=tuple(k for k in found[0].harmonics if all(k in one.harmonics for one in found)),
    )


def _label_hz(one: Steady, point: PointData) -> float:
    return one.speed_hz if one.estimate.method == "tacho" else (one.estimate.stated_hz or point.point.speed_hz)


def _finest(grid: FloatArray, score: FloatArray, near: float) -> float:
    """Middle of where one recording's comb is best near an order."""
    at = np.flatnonzero(np.abs(np.log(grid / near)) <= ALIKE)
    best = score[at]
    return float(np.mean(grid[at[best >= np.max(best) - 1e-9]]))


def _scores(logs: Logs, label_hz: float, grid: FloatArray) -> FloatArray:
    """Of a comb at each order of the label's speed, shape (orders,), mean over channels."""
    return np.asarray(np.mean([comb_score(log, width, grid * label_hz, HARMONICS) for log, width in logs], axis=0))


def _line_logs(one: Steady, channels: Sequence[Channel]) -> list[tuple[FloatArray, float]]:
    """Log power of lines, of three bins the largest, and the width of a bin, of each channel."""
    logs = line_logs(one.recording(channels))
    return [(maximum_filter1d(log[: int(TRUSTED * one.rate_hz / width)], 3), width) for log, width in logs]


def _level(logs: Logs, hz: float, reach: float) -> float:
    """Log power of the clearest line of any channel within a share of a frequency; 0 beyond what is heard."""
    tops = []
    for log, width in logs:
        first, last = int((1.0 - reach) * hz / width), int(np.ceil((1.0 + reach) * hz / width)) + 1
        tops.append(float(np.max(log[first:last], initial=0.0)))
    return max(tops)


def _lines_of(logs: Logs, comb_hz: float) -> list[int]:
    """The multiples of a frequency that are lines."""
    return [int(k) for k in HARMONICS if _level(logs, k * comb_hz, WANDER) >= LINE]


def _of_slower(logs: Logs, comb_hz: float) -> bool:
    """Whether lines stand between those of the comb as well, at the multiples of a part of it."""

    def mean(multiples: Sequence[float]) -> float:
        places = [[round(m * comb_hz / width) for m in multiples] for _, width in logs]
        heard = [log[p] for (log, _), row in zip(logs, places, strict=True) for p in row if p < log.size]
        return float(np.mean(heard)) if heard else 0.0

    own = mean(HARMONICS[:3])
    return any(mean([j / k for j in range(1, 2 * k) if j % k]) >= BETWEEN * own for k in SLOWER)
