"""Can the recordings be of this machine at the stated speed? Lines of teeth stand where file and label say, or not.

The orders of all meshes follow from the machine file. Where a comb of lines stands at another order in test and
baseline alike, and none at the file's, either the numbers of teeth are not this machine's or the speed was not the
stated one: no effect is looked for in what the model predicts at the wrong places.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import maximum_filter1d

from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import doubts
from reconcile.machine.stages import gate_stage
from reconcile.machine.turned import points_text
from reconcile.observe.observation import PointData
from reconcile.observe.steady import Steady
from reconcile.observe.watch import bases_at
from reconcile.speed import line_logs
from reconcile.speed.elsewhere import lines_elsewhere
from reconcile.speed.estimate import comb_score
from reconcile.verdict import NextExperiment, Report, SensorFault, Where
from signals.series import FloatArray
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
SILENT = 0.5
"""Share of that of the best comb that the file's teeth must not reach: where both file and label are right they are the
best comb (1.0), where one is wrong they had 0.1 at most, 0.5 where the wrong order is a multiple of the right one."""
SLOWER = tuple(range(2, 13))
BETWEEN = 0.4
"""Parts of an order, and the share of a comb's mean that lines at the multiples of a part must not have: these are a
race's or a shaft's, whose multiples the comb picks."""
FOLLOWED = 0.1
"""Share by which a speed may be off its label and is found and followed."""
DOUBTFUL = 0.05
"""Share from which that may as well be another number of teeth."""


@dataclass(frozen=True, kw_only=True)
class Elsewhere:
    """Lines of teeth (of the shaft: no `mesh`) at `order` times the stated speed at one operating point, where the
    file has them at `own`."""

    stated_hz: float
    order: float
    own: float
    mesh: str
    by_pulses: bool

    @property
    def factor(self) -> float:
        """The speed at which the file's teeth would be there, over the stated one."""
        return self.order / self.own


def teeth_elsewhere(
    machine: MachineSpec, data: Sequence[PointData], channels: Sequence[Channel]
) -> tuple[tuple[PointData, ...], tuple[Elsewhere, ...]]:
    """The points whose lines of teeth (without any, of the shaft) stand where file and label say, or are not clear;
    and where those of the others stand. A speed that is within `FOLLOWED` of its label stays, unless another number of
    teeth is as likely."""
    orders = _orders(machine)
    kept, elsewhere = [], []
    for point in data:
        found = _of_point(point, orders, channels) if orders else _of_shaft(point, channels)
        if found is None or _follows(found, machine):
            kept.append(point)
        else:
            elsewhere.append(found)
    return tuple(kept), tuple(elsewhere)


def _orders(machine: MachineSpec) -> dict[str, float]:
    """Of all meshes, cycles a turn of the operating shaft."""
    at_one = bases_at(machine, 1.0)
    return {name: order for name, order in at_one.items() if name.startswith("f_m") and order > 0.0}


def _follows(found: Elsewhere, machine: MachineSpec) -> bool:
    off = abs(found.factor - 1.0)
    return off <= (FOLLOWED if teeth_of(found, machine) is None else DOUBTFUL)


def teeth_of(found: Elsewhere, machine: MachineSpec) -> tuple[str, int, int] | None:
    """The gear on the operating shaft, its teeth in the file, and how many others would stand where the lines are."""
    shaft = machine.operating.shaft if machine.operating is not None else ""
    for gear in machine.gears:
        count = round(found.order)
        if gear.shaft == shaft and gear.teeth == round(found.own) and abs(found.order / count - 1.0) < ALIKE / 2:
            return gear.name, gear.teeth, count
    return None


def _of_point(point: PointData, orders: Mapping[str, float], channels: Sequence[Channel]) -> Elsewhere | None:
    heard = [s for s in point.spectra if s is not None]
    pulses = all(s.estimate.method == "tacho" for s in heard)
    grid = np.exp(np.arange(np.log(LOWEST), np.log(HIGHEST), STEP))
    raw = np.array([_scores(s, _label_hz(s, point), channels, grid) for s in heard])
    wide = maximum_filter1d(raw, 2 * round(ALIKE / STEP) + 1, axis=1)
    together = np.min(wide, axis=0)
    top = float(np.max(together))
    near = {name: np.abs(np.log(grid / order)) <= NEAR for name, order in orders.items()}
    heard_at = {name: float(np.max(together[at])) for name, at in near.items() if at.any()}
    if top < CLEAR or not heard_at or max(heard_at.values()) > SILENT * top:
        return None
    middle = float(np.mean(grid[together >= top - 1e-9]))
    finest = [_finest(grid, one, middle) for one in raw]
    if any(_of_slower(s, _label_hz(s, point) * order, channels) for s, order in zip(heard, finest, strict=True)):
        return None
    order = float(np.mean(finest))
    mesh = min(heard_at, key=lambda name: abs(np.log(order / orders[name])))
    return Elsewhere(stated_hz=point.point.speed_hz, order=order, own=orders[mesh], mesh=mesh, by_pulses=pulses)


def _of_shaft(point: PointData, channels: Sequence[Channel]) -> Elsewhere | None:
    """Without teeth the shaft's own harmonics, three of them at least, where nothing near the label confirms it."""
    heard = [s for s in point.spectra if s is not None]
    if any(s.estimate.method != "stated" for s in heard):
        return None
    far = [lines_elsewhere(s.recording(channels), _label_hz(s, point)) for s in heard]
    speeds = [one.speed_hz / _label_hz(s, point) for one, s in zip(far, heard, strict=True) if one and not one.own]
    if len(speeds) < len(heard) or max(speeds) > (1.0 + ALIKE) * min(speeds):
        return None
    return Elsewhere(stated_hz=point.point.speed_hz, order=float(np.mean(speeds)), own=1.0, mesh="", by_pulses=False)


def _label_hz(one: Steady, point: PointData) -> float:
    return one.speed_hz if one.estimate.method == "tacho" else (one.estimate.stated_hz or point.point.speed_hz)


def _finest(grid: FloatArray, score: FloatArray, near: float) -> float:
    """Middle of where one recording's comb is best near an order."""
    at = np.flatnonzero(np.abs(np.log(grid / near)) <= ALIKE)
    best = score[at]
    return float(np.mean(grid[at[best >= np.max(best) - 1e-9]]))


def _scores(one: Steady, label_hz: float, channels: Sequence[Channel], grid: FloatArray) -> FloatArray:
    """Of a comb at each order of the label's speed, shape (orders,), mean over channels."""
    logs = _line_logs(one, channels)
    return np.asarray(np.mean([comb_score(log, width, grid * label_hz, HARMONICS) for log, width in logs], axis=0))


def _line_logs(one: Steady, channels: Sequence[Channel]) -> list[tuple[FloatArray, float]]:
    """Log power of lines, of three bins the largest, and the width of a bin, of each channel."""
    logs = line_logs(one.recording(channels))
    return [(maximum_filter1d(log[: int(TRUSTED * one.rate_hz / width)], 3), width) for log, width in logs]


def _of_slower(one: Steady, comb_hz: float, channels: Sequence[Channel]) -> bool:
    """Whether lines stand between those of the comb as well, at the multiples of a part of it."""
    logs = _line_logs(one, channels)

    def mean(multiples: Sequence[float]) -> float:
        places = [[round(m * comb_hz / width) for m in multiples] for _, width in logs]
        heard = [log[p] for (log, _), row in zip(logs, places, strict=True) for p in row if p < log.size]
        return float(np.mean(heard)) if heard else 0.0

    own = mean(HARMONICS[:3])
    return any(mean([j / k for j in range(1, 2 * k) if j % k]) >= BETWEEN * own for k in SLOWER)


def told_of(found: Elsewhere, machine: MachineSpec) -> str:
    """Which line shows it, and what would explain it."""
    at = found.order * found.stated_hz
    part = "teeth" if found.mesh else "a shaft"
    places = f"{at:.4g}, {2 * at:.4g} and {3 * at:.4g} Hz ({found.order:.3g} times the speed)"
    lines = f"lines as of {part} stand at {places}"
    own = f"where the file's teeth would be at {found.own * found.stated_hz:.4g} Hz" if found.mesh else "none near it"
    return f"at {found.stated_hz:g} Hz {lines}, {own}; {_why(found, machine)}"


def _why(found: Elsewhere, machine: MachineSpec) -> str:
    speed = f"the shaft turned at {found.factor * found.stated_hz:.3g} Hz, not at {found.stated_hz:g} Hz"
    teeth = teeth_of(found, machine)
    if teeth is None:
        return "the file's teeth are not this machine's" if found.by_pulses else speed
    gear, file, count = teeth
    other = f"{gear} has {count} teeth, not {file}"
    return other if found.by_pulses else f"either {other}, or {speed}"


def told_of_all(found: Sequence[Elsewhere], machine: MachineSpec) -> str:
    """That of the first operating point, and of the others where they say another thing."""
    first, *others = found
    alike = [one for one in others if abs(one.factor / first.factor - 1.0) <= ALIKE]
    likewise = f"; likewise at {' and '.join(f'{one.stated_hz:g}' for one in alike)} Hz" if alike else ""
    apart = "".join(f"; {told_of(one, machine)}" for one in others if one not in alike)
    return f"{told_of(first, machine)}{likewise}{apart}"


def misfit_report(
    found: Sequence[Elsewhere], machine: MachineSpec, data: Sequence[PointData], gate: Gate, told: Mapping[str, object]
) -> Report:
    """The report where no point's lines stand where file and label say; `told` is its provenance."""
    detail = told_of_all(found, machine)
    by_label = all(teeth_of(one, machine) is None and not one.by_pulses for one in found)
    return Report(
        verdict="measurement_fault" if by_label else "not_decidable",
        sentence=f"Recordings, machine file and stated speed do not belong together: {detail}. Nothing else is "
        "looked for: all that the model predicts hangs on these lines.",
        level="machine",
        where=Where(limits=doubts(gate)),
        fault=SensorFault(kind="speed_mismatch", channel="", detail=detail) if by_label else None,
        undecidable=("whether anything is missing: the machine file's lines are not there",),
        next_experiment=NextExperiment(sentence=_advice(found, machine)),
        stages=(gate_stage(gate), {"name": "observe", "speeds": [points_text(d) for d in data]}),
        provenance=told,
    )


def _advice(found: Sequence[Elsewhere], machine: MachineSpec) -> str:
    if any(one.by_pulses for one in found):
        return "Check the numbers of teeth in the machine file, and the pulses a revolution of the tacho."
    if any(teeth_of(one, machine) is not None for one in found):
        return "Check the numbers of teeth in the machine file and the stated speeds, or record with a tacho."
    return "Correct the speed that the descriptions state, or record with a tacho."
