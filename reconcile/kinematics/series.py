"""Many multiples of a shaft that grew together: what strikes or rubs once a turn, or lifts off, makes them all.

Looseness brings the shaft's multiples and halves (ISO 13373-3:2015, annexes; R. B. Randall, Vibration-based Condition
Monitoring, 2nd ed., 2021, section 2.2). Each may be weak beside the first, and a weak line alone wanders with load; of
measured gearboxes under four loads no more than two of thirty wandered upwards together.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.families import Ties
from reconcile.kinematics.lines import OrderLines, at_half_of_speeds, line_growth, matched, spectra_of
from reconcile.kinematics.observe import Observation
from reconcile.speed.excess import MAINS_HZ
from reconcile.verdict import NextExperiment, Report
from signals.series import FloatArray

MULTIPLES = np.arange(1, 25) / 2
"""From one half to twelve."""
GROWTH_DB = 10.0
"""In the middle of the channels."""
MIDDLE_DB = 15.0
"""Middle of those that grew: lines that a load moves by 6 dB, each as it happens, pass the other limits."""
WITHIN_DB = 30.0
"""Below the channel's strongest line up to order 10, at most."""
LEAST = 4
HALVES = 2
"""Halves among them from which something lifts off at every other turn."""
LEAST_PERIODS = 8.0
LEAST_TURNS = 20.0
"""Of a shaft in test and baseline, for its multiples and halves to be judged: in four turns the skirts of the teeth's
lines stand at all of them, more so than in a longer baseline. Cuts of a sound gearbox of 4 turns of its slow shaft were
told as loose, those of 6 and more were not."""
TEETH = 5.5
"""Multiples to either side of the teeth's that are theirs."""
SAME = 0.02
"""Of a multiple, by which another shaft's may differ to coincide with it."""


@dataclass(frozen=True, kw_only=True)
class ShaftSeries:
    """Multiples of a shaft that grew, their growth (dB, middle of the channels), and the channel that grew most."""

    shaft: str
    ratio: float
    multiples: tuple[float, ...]
    growth_db: tuple[float, ...]
    channel: str
    label: str

    @property
    def halves(self) -> bool:
        """Whether halves of the speed are among them."""
        return sum(m % 1.0 != 0.0 for m in self.multiples) >= HALVES

    @property
    def middle_db(self) -> float:
        """Middle of the growths."""
        return float(np.median(self.growth_db))


def shaft_series(tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties) -> tuple[ShaftSeries, ...]:
    """The shafts of which `LEAST` multiples grew, at half of the speeds or more, that with most first; empty without a
    baseline at the same speed. Multiples of two shafts that coincide count for both."""
    found: list[ShaftSeries] = []
    speeds: dict[str, list[tuple[float, bool]]] = {}
    for test in tests:
        base = matched(test, baselines)
        if base is None:
            continue
        spectra = spectra_of(test, base)
        turns = min(_turns(o) for o in (test, base))
        for shaft, ratio in ties.shafts.items():
            if turns * ratio < LEAST_TURNS:
                continue
            multiples = _own(test, ratio, ties, turns)
            one = _series(spectra, shaft, ratio, multiples, test.label)
            speeds.setdefault(shaft, []).append((test.speed.speed_hz, one is not None))
            if one is not None:
                found.append(one)
    best: dict[str, ShaftSeries] = {}
    for one in sorted(found, key=lambda one: (len(one.multiples), one.middle_db), reverse=True):
        if at_half_of_speeds(speeds[one.shaft]):
            best.setdefault(one.shaft, one)
    return tuple(best.values())


def with_short(report: Report, tests: Sequence[Observation], baselines: Sequence[Observation], ties: Ties) -> Report:
    """The report with the shafts of which no recording of the tests holds turns enough for their multiples; where it
    leaves one of them open, a longer recording comes first."""
    pairs = [(t, base) for t in tests if (base := matched(t, baselines)) is not None]
    if not pairs or any(c.named for c in report.causes):
        return report
    both = [min(pair, key=_turns) for pair in pairs]
    most = max(both, key=_turns)
    short = {shaft: ratio for shaft, ratio in ties.shafts.items() if _turns(most) * ratio < LEAST_TURNS}
    if not short:
        return report
    slowest = min(short.values())
    seconds = math.ceil(10 * LEAST_TURNS / slowest / most.speed.speed_hz) / 10
    held = ", ".join(f"{_turns(most) * ratio:.3g} turns of {shaft}" for shaft, ratio in short.items())
    need = f"{LEAST_TURNS:g} are needed, {seconds:g} s of each recording"
    limit = f"multiples and halves of a speed are not compared: {most.label} holds {held}; {need}"
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, limit)))
    if report.verdict not in ("ambiguous", "not_decidable") or not short.keys() & {w.site for w in report.where.sites}:
        return report
    then = "" if report.next_experiment is None else f" {report.next_experiment.sentence}"
    first = (
        f"Record test and baseline for {seconds:g} s or longer first ({LEAST_TURNS:g} turns of {' and '.join(short)})."
    )
    return replace(report, next_experiment=NextExperiment(sentence=f"{first}{then}"))


def _turns(one: Observation) -> float:
    """Of the reference shaft."""
    return one.speed.speed_hz * one.recording.duration_s


def _own(test: Observation, ratio: float, ties: Ties, turns: float) -> FloatArray:
    """Multiples that are resolved, no lines about the teeth's, no halves that are another shaft's whole ones, and none
    of the supply's."""
    kept = MULTIPLES[MULTIPLES * ratio * turns >= LEAST_PERIODS]
    for mesh in ties.mesh_orders:
        kept = kept[np.abs(kept - mesh / ratio) > TEETH]
    for other in ties.shafts.values():
        near = kept * ratio / other
        whole = np.abs(near - np.rint(near)) < SAME
        kept = kept[~whole | (kept % 1.0 == 0.0)]
    bin_hz = 1.0 / test.recording.duration_s
    for supply in MAINS_HZ:
        hz = kept * ratio * test.speed.speed_hz
        kept = kept[np.abs(hz - np.rint(hz / supply) * supply) > bin_hz]
    return np.asarray(kept)


def _series(
    spectra: Sequence[tuple[str, OrderLines, OrderLines]], shaft: str, ratio: float, multiples: FloatArray, label: str
) -> ShaftSeries | None:
    if not spectra or multiples.size < LEAST:
        return None
    rows = np.stack([line_growth(now, before, multiples * ratio, WITHIN_DB) for _, now, before in spectra])
    middle = np.median(np.where(np.isfinite(rows), rows, 0.0), axis=0)
    grown = middle > GROWTH_DB
    if np.sum(grown) < LEAST or np.median(middle[grown]) < MIDDLE_DB:
        return None
    loudest = int(np.argmax(np.nansum(rows[:, grown], axis=1)))
    return ShaftSeries(
        shaft=shaft,
        ratio=ratio,
        multiples=tuple(float(m) for m in multiples[grown]),
        growth_db=tuple(float(g) for g in middle[grown]),
        channel=spectra[loudest][0],
        label=label,
    )
