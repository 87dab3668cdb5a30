"""A torque that comes many times a turn: named where the teeth are modulated so and nothing else is found, and sized.

How strong sidebands are beside their harmonic of the teeth hardly depends on the sensor's path, which is smooth. So
torques of that order are simulated on machines that agree with the baseline, and the size is the one at which
they show the observed ratios; a small torque shows twice as much where it is twice as large. What the others' operating
points say of it forecasts each.
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
"""That agree with the baseline: a full set of vector lanes."""
FIRST_SHARE = 0.05
"""Of the shaft's torque, with which the search begins."""
PASSES = 2
OVER_FLOOR, NEW_DB = 10.0, 6.0
"""Of a sideband that counts: over the local floor (power), and over the baseline, dB."""
FEWEST = 4
"""Sidebands, at two operating points at least, from which a size is told."""
FORM_DB = 1.5
"""Deviation that another form of the law may bring: a torque with harmonics, a coupling that is soft."""
QUANTILE = 1.645
"""Of a Gaussian, of 5 % at either side."""
BIN_SLACK = 1e-3
COPIES = 400


@dataclass(frozen=True, kw_only=True)
class Seen:
    """Sidebands that count: `point`, `ratio_db` beside their harmonic, `risen_db` over the baseline, (n,); `places`
    (mesh's order, harmonic, side, channel) of each."""

    point: np.ndarray
    ratio_db: FloatArray
    risen_db: FloatArray
    places: tuple[tuple[float, int, int, int], ...]


@dataclass(frozen=True, kw_only=True)
class Ripple:
    """What a torque would be: its term, size, what it forecasts, and the machine with it."""

    term: TermSpec
    severity: Severity
    held: HeldOut
    machine: MachineSpec
    score: float


def ripple(setting: Setting, seen: ManyTurns) -> Ripple | None:
    """None where too few sidebands tell its size, or no such machine runs."""
    tie = ties(of_machine(setting.machine), seen_by(setting.machine))
    told = sidebands(setting.data, tie, seen.order)
    if told.point.size < FEWEST or np.unique(told.point).size < 2:
        return None
    amplitude = FIRST_SHARE * _torque_nm(setting.machine, seen.shaft)
    off = None
    for _ in range(PASSES):
        off = _off(setting, told, seen, tie, amplitude)
        if off is None:
            return None
        amplitude *= 10.0 ** (float(np.mean(np.median(off, axis=1))) / 20.0)
    assert off is not None
    left = off - np.mean(np.median(off, axis=1))
    term = _term(seen, amplitude, 0.0)
    base = setting.fitted_machine or setting.plan.machine
    return Ripple(
        term=term,
        severity=_severity(amplitude, left),
        held=_held(told, np.mean(left, axis=0), setting.seed),
        machine=with_effects(base, (term,)),
        score=_score(told, np.mean(left, axis=0)),
    )


def seen_by(machine: MachineSpec) -> str | None:
    """The shaft whose turns count."""
    return machine.operating.shaft if machine.operating is not None else None


def sidebands(data: Sequence[PointData], tie: Ties, order: float) -> Seen:
    """Those `order` turns of the drive shaft beside the teeth's harmonics that stand out and are new."""
    found: list[tuple[int, float, float, tuple[float, int, int, int]]] = []
    for k, one in enumerate(data):
        test, baseline = one.spectra
        if baseline is None:
            continue
        places, levels, over = _levels(test.samples, test.rate_hz, test.speed_hz, tie, order)
        _, before, _ = _levels(baseline.samples, baseline.rate_hz, baseline.speed_hz, tie, order)
        if levels.shape != before.shape:  # of recordings whose bands end elsewhere
            continue
        risen = 10.0 * np.log10(levels[:, 1] / before[:, 1])
        ratio = 10.0 * np.log10(levels[:, 1] / levels[:, 0])
        counted = np.flatnonzero((over > OVER_FLOOR) & (risen > NEW_DB))
        found += [(k, float(ratio[i]), float(risen[i]), places[i]) for i in counted]
    return Seen(
        point=np.array([row[0] for row in found], dtype=int),
        ratio_db=np.array([row[1] for row in found]),
        risen_db=np.array([row[2] for row in found]),
        places=tuple(row[3] for row in found),
    )


def _levels(
    samples: FloatArray, rate_hz: float, speed_hz: float, tie: Ties, order: float
) -> tuple[list[tuple[float, int, int, int]], FloatArray, FloatArray]:
    """Places, powers (n, 2) of the harmonic and its sideband, and the sideband's peak over the floor (n,)."""
    _, power, bin_hz = hann_spectrum(samples, rate_hz)
    top = USABLE * rate_hz
    floor = np.stack([power_over_floor(row) for row in power])
    places, levels, over = [], [], []
    for mesh in tie.mesh_orders:
        for harmonic in range(1, MESH_ORDERS + 1):
            for side in (-1, 1):
                middle, beside = harmonic * mesh * speed_hz, (harmonic * mesh + side * order) * speed_hz
                if not 4.0 * bin_hz < beside < top or middle >= top:
                    continue
                both = line_powers(power, bin_hz, np.array([middle, beside]), np.full(2, BIN_SLACK), top)
                near = round(beside / bin_hz)
                for channel in range(power.shape[0]):
                    places.append((mesh, harmonic, side, channel))
                    levels.append(np.maximum(both[channel], 1e-300))
                    over.append(float(floor[channel, near - 1 : near + 2].max()))
    return places, np.array(levels).reshape(-1, 2), np.array(over)


def _off(setting: Setting, told: Seen, seen: ManyTurns, tie: Ties, amplitude: float) -> FloatArray | None:
    """(machines, n): observed ratios less those of machines with such a torque, dB; None where none runs."""
    plan = setting.plan
    pairs = [d.pair for d in plan.draws if d.candidate is None and not d.twin][:MACHINES]
    rng = np.random.default_rng([setting.seed, 53])
    phases = rng.uniform(-np.pi, np.pi, len(pairs))
    distinct = tuple(sorted(set(setting.simulated)))
    rows = [distinct.index(name) for name in setting.simulated]
    shown = np.full((len(pairs), told.point.size), np.nan)
    for k, one in enumerate(setting.data):
        point = simulated_at(setting.machine, one.point)
        members = []
        for pair, phase in zip(pairs, phases, strict=True):
            sound = at_point(moved(plan.machine, plan.numbers, plan.offsets[pair]), point)
            members.append(Member(machine=with_effects(sound, (_term(seen, amplitude, float(phase)),)), seed=pair))
        own = np.flatnonzero(told.point == k)
        for m, run in enumerate(run_members(members, distinct)):
            if isinstance(run, Response):
                samples = run.signals[:, round(SETTLE_S * RATE_HZ) :][rows]
                places, levels, _ = _levels(samples, RATE_HZ, point.speed_hz, tie, seen.order)
                ratio = dict(zip(places, 10.0 * np.log10(levels[:, 1] / levels[:, 0]), strict=True))
                shown[m, own] = [ratio.get(told.places[i], np.nan) for i in own]
    off = told.ratio_db - shown
    alive = np.all(np.isfinite(off), axis=1)
    return off[alive] if np.any(alive) else None


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
    number by which all sidebands rise. `left` (n,): what they are off the mean of all, dB."""
    after, box = np.empty(left.size), np.empty(left.size)
    for k in np.unique(told.point):
        own = told.point == k
        after[own] = left[own] - np.median(left[~own])
        box[own] = told.risen_db[own] - np.median(told.risen_db[~own])
    before = told.risen_db
    rng = np.random.default_rng([seed, 59])
    picks = rng.integers(0, left.size, (COPIES, left.size))
    gains = [_gain(before[p], after[p]) for p in picks]
    low, high = np.quantile(gains, [0.05, 0.95])
    return HeldOut(
        metric="sideband_level_distance", unit="dB", before=_rms(before), after=_rms(after), gain=_gain(before, after),
        gain_low=float(low), gain_high=float(high), retuned=None, black_box=_gain(before, box), placebo=None,
        held="each operating point by the others", numbers=1,
    )  # fmt: skip


def _score(told: Seen, left: FloatArray) -> float:
    """Log evidence over no change, as if a quarter of the sidebands told something of their own."""
    scatter = max(_rms(left), 3.0)
    return float(np.sum(told.risen_db**2 - left**2) / (8.0 * scatter**2))


def _gain(before: FloatArray, after: FloatArray) -> float:
    return 1.0 - _rms(after) / max(_rms(before), 1e-9)


def _rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(values**2)))
