"""A torque that comes many times a turn: named where the teeth are modulated so and nothing else is found, and sized.

How strong sidebands are beside their harmonic of the teeth hardly depends on the sensor's path, which is smooth. So
torques of that order are simulated on machines of the kind, or on those that agree with the baseline where there are
such, and the size is the one at which they show the observed ratios; a small torque shows twice as much where it is
twice as large. What the others' operating points say of it forecasts each, at all sidebands that could be heard: one
that has not risen is a bound, which a forecast may exceed and not fall short of.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.candidates import with_effects
from reconcile.atlas.plan import at_point, simulated_at
from reconcile.atlas.run import RATE_HZ, SETTLE_S, run_members
from reconcile.calibrate.uncertain import moved
from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.many_turns import ManyTurns
from reconcile.machine.setting import Setting
from reconcile.observe.extract import USABLE, hann_spectrum, line_powers
from reconcile.observe.observation import PointData
from reconcile.observe.watch import MESH_ORDERS
from reconcile.speed.excess import power_over_floor
from reconcile.verdict import HeldOut, Severity
from signals.series import FloatArray
from sim.assembly.kinematics import kinematics
from sim.assembly.loads import shaft_torques_nm
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.solve.ensemble import Member

TERM, SIZE, UNIT = "torque_ripple", "amplitude", "N*m"
MACHINES = 8
"""A full set of vector lanes."""
FIRST_SHARE = 0.05
"""Of the shaft's torque, with which the search begins;"""
MOST_SHARE = 1.0
"""and with which it ends: a torque that turns round is no ripple."""
PASSES, SETTLED_DB = 4, 1.0
"""Until the size moves by less."""
OVER_FLOOR, NEW_DB = 10.0, 6.0
"""Of a sideband that counts: over the local floor (power), and over the baseline, dB."""
FEWEST = 4
"""Sidebands, at two operating points at least and about two harmonics, from which a size is told."""
FORM_DB = 1.5
"""Deviation that another form of the law may bring: a torque with harmonics, a coupling that is soft."""
QUANTILE = 1.645
"""Of a Gaussian, of 5 % at either side."""
BIN_SLACK = 1e-3
COPIES = 400


Place = tuple[float, int, int, int]


@dataclass(frozen=True, kw_only=True)
class Seen:
    """All sidebands that could be heard: `point`, `ratio_db` beside their harmonic, `risen_db` over the baseline,
    (n,), and whether each has risen (`told`: else the ratio is a bound); `places` (mesh's order, harmonic, side,
    channel) of each."""

    point: np.ndarray
    ratio_db: FloatArray
    risen_db: FloatArray
    told: np.ndarray
    places: tuple[Place, ...]

    @property
    def enough(self) -> bool:
        """Whether a size can be told."""
        risen = np.flatnonzero(self.told)
        harmonics = {self.places[i][:2] for i in risen}
        return risen.size >= FEWEST and np.unique(self.point[risen]).size >= 2 and len(harmonics) >= 2

    def at(self, chosen: np.ndarray) -> Seen:
        """Some of them."""
        return Seen(
            point=self.point[chosen], ratio_db=self.ratio_db[chosen], risen_db=self.risen_db[chosen],
            told=self.told[chosen], places=tuple(self.places[i] for i in chosen),
        )  # fmt: skip


@dataclass(frozen=True, kw_only=True)
class Ripple:
    """What a torque would be: its term, size, what it forecasts, and the machine with it."""

    term: TermSpec
    severity: Severity
    held: HeldOut
    machine: MachineSpec
    score: float


def ripple(setting: Setting, seen: ManyTurns, told: Seen) -> Ripple | None:
    """None where no such machine runs, and where the torque would be larger than the shaft's own."""
    most = MOST_SHARE * _torque_nm(setting.machine, seen.shaft)
    amplitude = FIRST_SHARE * most
    for _ in range(PASSES):
        off = _off(setting, told, seen, amplitude)
        if off is None:
            return None
        heard = np.flatnonzero(np.all(np.isfinite(off), axis=0))  # of a rounded speed one may be beyond the band
        told, left = told.at(heard), off[:, heard]
        if not told.enough:
            return None
        shift_db = float(np.mean(np.median(left[:, told.told], axis=1)))
        amplitude *= 10.0 ** (shift_db / 20.0)
        if not amplitude <= most:
            return None
        if abs(shift_db) < SETTLED_DB:
            break
    left = left - shift_db
    term = _term(seen, amplitude, 0.0)
    base = setting.fitted_machine or setting.plan.machine
    return Ripple(
        term=term,
        severity=_severity(amplitude, left[:, told.told]),
        held=_held(told, np.mean(left, axis=0), setting.seed),
        machine=with_effects(base, (term,)),
        score=_score(told, np.mean(left, axis=0)),
    )


def seen_by(machine: MachineSpec) -> str | None:
    """The shaft whose turns count."""
    return machine.operating.shaft if machine.operating is not None else None


def sidebands(machine: MachineSpec, data: Sequence[PointData], order: float) -> Seen:
    """Those `order` turns of the drive shaft beside harmonics of the teeth that stand out of the floor."""
    tie = ties(of_machine(machine), seen_by(machine))
    found: list[tuple[int, float, float, bool, Place]] = []
    for k, one in enumerate(data):
        test, baseline = one.spectra
        if baseline is None:
            continue
        top = USABLE * min(test.rate_hz, baseline.rate_hz, RATE_HZ)
        now = _levels(test.samples, test.rate_hz, test.speed_hz, tie, order, top)
        before = _levels(baseline.samples, baseline.rate_hz, baseline.speed_hz, tie, order, top)
        for place in sorted(now.keys() & before.keys()):
            (middle, beside, over, middle_over), (_, rested, _, _) = now[place], before[place]
            risen = 10.0 * np.log10(beside / rested)
            told = bool(over > OVER_FLOOR and risen > NEW_DB)
            if told or middle_over > OVER_FLOOR:
                found.append((k, float(10.0 * np.log10(beside / middle)), float(risen), told, place))
    return Seen(
        point=np.array([row[0] for row in found], dtype=int),
        ratio_db=np.array([row[1] for row in found]),
        risen_db=np.array([row[2] for row in found]),
        told=np.array([row[3] for row in found], dtype=bool),
        places=tuple(row[4] for row in found),
    )


def _levels(
    samples: FloatArray, rate_hz: float, speed_hz: float, tie: Ties, order: float, top: float
) -> dict[Place, tuple[float, float, float, float]]:
    """By place: powers of the harmonic and of its sideband, and the peaks of the sideband and of the harmonic over
    the floor."""
    _, power, bin_hz = hann_spectrum(samples, rate_hz)
    floor = np.stack([power_over_floor(row) for row in power])
    found = {}
    sides = [(mesh, k, side) for mesh in tie.mesh_orders for k in range(1, MESH_ORDERS + 1) for side in (-1, 1)]
    for mesh, harmonic, side in sides:
        middle, beside = harmonic * mesh * speed_hz, (harmonic * mesh + side * order) * speed_hz
        if not 4.0 * bin_hz < beside < top or middle >= top:
            continue
        both = np.maximum(line_powers(power, bin_hz, np.array([middle, beside]), np.full(2, BIN_SLACK), top), 1e-300)
        near, own = (round(hz / bin_hz) for hz in (beside, middle))
        for c in range(power.shape[0]):
            over, middle_over = (float(floor[c, at - 1 : at + 2].max()) for at in (near, own))
            found[(mesh, harmonic, side, c)] = (float(both[c, 0]), float(both[c, 1]), over, middle_over)
    return found


def _off(setting: Setting, told: Seen, seen: ManyTurns, amplitude: float) -> FloatArray | None:
    """(machines, n): observed ratios less those of machines with such a torque, dB; None where none runs."""
    plan, tie = setting.plan, ties(of_machine(setting.machine), seen_by(setting.machine))
    pairs = [d.pair for d in plan.draws if d.candidate is None and not d.twin][:MACHINES]
    rng = np.random.default_rng([setting.seed, 53])
    phases = rng.uniform(-np.pi, np.pi, len(pairs))
    distinct = tuple(sorted(set(setting.simulated)))
    rows = [distinct.index(name) for name in setting.simulated]
    shown = np.full((len(pairs), told.point.size), np.nan)
    runs = np.ones(len(pairs), dtype=bool)
    for k, one in enumerate(setting.data):
        point = simulated_at(setting.machine, one.point)
        members = []
        for pair, phase in zip(pairs, phases, strict=True):
            sound = at_point(moved(plan.machine, plan.numbers, plan.offsets[pair]), point)
            members.append(Member(machine=with_effects(sound, (_term(seen, amplitude, float(phase)),)), seed=pair))
        own = np.flatnonzero(told.point == k)
        for m, run in enumerate(run_members(members, distinct)):
            runs[m] &= isinstance(run, Response)
            if isinstance(run, Response):
                samples = run.signals[:, round(SETTLE_S * RATE_HZ) :][rows]
                levels = _levels(samples, RATE_HZ, point.speed_hz, tie, seen.order, USABLE * RATE_HZ)
                for i in own:
                    middle, beside, _, _ = levels.get(told.places[i], (np.nan, np.nan, 0.0, 0.0))
                    shown[m, i] = 10.0 * np.log10(beside / middle)
    return (told.ratio_db - shown)[runs] if np.any(runs) else None


def _term(seen: ManyTurns, amplitude: float, phase: float) -> TermSpec:
    values = {SIZE: amplitude, "order": float(seen.turns), "phase": phase}
    return TermSpec(term=TERM, site=seen.shaft, parameters=values)


def _torque_nm(machine: MachineSpec, shaft: str) -> float:
    """Of the shaft; 1 N*m where nothing loads it."""
    return abs(shaft_torques_nm(machine, kinematics(machine)).get(shaft, 0.0)) or 1.0


def _severity(amplitude: float, left: FloatArray) -> Severity:
    """`left` (machines, n): what the ratios are off the mean, dB."""
    machines = np.median(left, axis=1)
    cells = np.mean(left, axis=0)
    spread_db = float(np.sqrt(machines.var() + cells.var() / max(1.0, 0.5 * cells.size) + FORM_DB**2))
    wide = 10.0 ** (QUANTILE * spread_db / 20.0)
    return Severity(name=SIZE, value=amplitude, unit=UNIT, low=amplitude / wide, high=amplitude * wide)


def _held(told: Seen, left: FloatArray, seed: int) -> HeldOut:
    """Each operating point's sidebands by the size that the others tell; against no torque at all, and against one
    number by which all of them rise. `left` (n,): what they are off the mean of all, dB; where one has not risen, only
    a forecast of more than there is counts. The interval is of whole operating points drawn again."""
    after, box, before = (np.zeros(left.size) for _ in range(3))
    before[told.told] = told.risen_db[told.told]
    for k in np.unique(told.point):
        own, others = told.point == k, (told.point != k) & told.told
        if not np.any(others):
            others = told.told
        after[own] = left[own] - np.median(left[others])
        box[own] = told.risen_db[own] - np.median(told.risen_db[others])
    bound = ~told.told
    after[bound], box[bound] = np.minimum(after[bound], 0.0), np.minimum(box[bound], 0.0)
    rng = np.random.default_rng([seed, 59])
    of = [np.flatnonzero(told.point == k) for k in np.unique(told.point)]
    picks = [np.concatenate([of[i] for i in rng.integers(0, len(of), len(of))]) for _ in range(COPIES)]
    low, high = np.quantile([_gain(before[p], after[p]) for p in picks], [0.05, 0.95])
    return HeldOut(
        metric="sideband_level_distance", unit="dB", before=_rms(before), after=_rms(after), gain=_gain(before, after),
        gain_low=float(low), gain_high=float(high), retuned=None, black_box=_gain(before, box), placebo=None,
        held="each operating point by the others", numbers=1,
    )  # fmt: skip


def _score(told: Seen, left: FloatArray) -> float:
    """Log evidence over no change, as if a quarter of the sidebands told something of their own."""
    scatter = max(_rms(left[told.told]), 3.0)
    missed = np.where(told.told, left, np.minimum(left, 0.0))
    return float((np.sum(told.risen_db[told.told] ** 2) - np.sum(missed**2)) / (8.0 * scatter**2))


def _gain(before: FloatArray, after: FloatArray) -> float:
    return 1.0 - _rms(after) / max(_rms(before), 1e-9)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
