"""Levels that a unit or a gain may have moved beside a defect that hides it from the sensor gate.

A defect adds power, in some bands more than in others, and so evenly in none; but what one channel did against the
others is its own, and no defect takes anything away.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.gate.findings import Gate
from reconcile.gate.levels import SAME_SPEED, channel_levels
from reconcile.gate.spoiled import HEARD
from reconcile.gate.units import GRAVITY, UNIT_RATIOS, possible, unit_of
from reconcile.kinematics.observe import Observation
from reconcile.report.action import UNIT_OR_GAIN
from reconcile.verdict import Report
from signals.series import FloatArray

APART_DB, WITHIN_DB = 2.0, 6.0
"""By which the median of a channel's change against the others may miss a unit's ratio, and half of its bands lie about
it. Of nine measured pairs of recordings with two to eight channels none changed so by more than 1.2 dB in the median
band, a unit that is wrong on one of them by 19.8 with half of the bands within 3.1."""
LARGE_DB = 12.0
"""Change of the median band from which a channel's level is told."""
FALLEN_DB = 10.0
"""By which a quarter of a channel's bands must have fallen to be told: a defect takes nothing away. Of the same pairs,
and of eight of one channel, the deepest such quarter is 5.9 dB down (a damaged ball), beside a race in g described as
m/s^2 11.2."""
NEAR_DB = 1.5
"""Of the ratio of g against m/s^2, within which such a change may be a unit's."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Shift:
    """Changes of the bands of a channel, dB: of its own level, and against the median of the others' of its quantity
    (empty where it is alone): what races do to an acceleration they do to no displacement or current."""

    channel: str
    quantity: str
    own_db: FloatArray
    apart_db: FloatArray


def with_shifted(report: Report, gate: Gate, tests: Sequence[Observation], baselines: Sequence[Observation]) -> Report:
    """The report with what units or gains may have done to levels: a channel apart from the others in the sentence too,
    all large changes among the limits. Not asked where the measurement is surely at fault."""
    faulty = report.verdict == "measurement_fault" or any(f.fault and f.kind not in HEARD for f in gate.findings)
    if faulty:
        return report
    shifts = _shifts(tests, baselines)
    apart = _apart(shifts)
    sentence = f"{report.sentence} But {apart}." if apart else report.sentence
    limits = (*report.where.limits, *([apart] if apart else ()), *_large(shifts))
    return replace(report, sentence=sentence, where=replace(report.where, limits=limits))


def _shifts(tests: Sequence[Observation], baselines: Sequence[Observation]) -> list[Shift]:
    """Of each channel over all tests that have a baseline; empty without any."""
    rows: dict[str, list[tuple[FloatArray, FloatArray]]] = {}
    quantities = {c.name: c.quantity for t in tests for c in t.recording.channels}
    for test in tests:
        base = _nearest(test, baselines)
        if base is None:
            continue
        change = _changes(test, base)
        for name, own in change.items():
            others = [d for other, d in change.items() if other != name and quantities[other] == quantities[name]]
            apart = own - np.median(np.stack(others), axis=0) if others else np.zeros(0)
            rows.setdefault(name, []).append((own, apart))
    return [
        Shift(
            channel=name,
            quantity=quantities[name],
            own_db=np.concatenate([own for own, _ in found]),
            apart_db=np.concatenate([apart for _, apart in found]),
        )
        for name, found in rows.items()
    ]


def _nearest(test: Observation, baselines: Sequence[Observation]) -> Observation | None:
    """In speed, of those at the test's speed and rate: levels go with both."""
    rate = test.recording.sampling_rate_hz
    off = [(abs(b.speed.speed_hz / test.speed.speed_hz - 1.0), b) for b in baselines]
    near = [one for one in off if one[0] <= SAME_SPEED and one[1].recording.sampling_rate_hz == rate]
    return min(near, key=lambda one: one[0])[1] if near else None


def _changes(test: Observation, base: Observation) -> dict[str, FloatArray]:
    """Mean and floor of the bands that both recordings have, as one row, dB, by channel."""
    found = {}
    for name in (n for n in test.recording.names if n in base.recording.names):
        now, then = channel_levels(test.recording, name), channel_levels(base.recording, name)
        _, a, b = np.intersect1d(now.band, then.band, assume_unique=True, return_indices=True)
        found[name] = np.concatenate([now.mean_db[a] - then.mean_db[b], now.floor_db[a] - then.floor_db[b]])
    return {name: row for name, row in found.items() if row.size}


def _apart(shifts: Sequence[Shift]) -> str:
    """What moved by a unit's ratio against its likes, and whose unit may be wrong."""
    moved = [s for s in shifts if _of_a_unit(s)]
    if not moved:
        return ""
    first = max(moved, key=lambda s: (_fell(s), float(np.median(s.apart_db)) > 0.0, abs(float(np.median(s.apart_db)))))
    middle = float(np.median(first.apart_db))
    unit = str(unit_of(middle, APART_DB, possible(first.quantity)))
    likes = [s for s in shifts if s.quantity == first.quantity]
    against = "the other channels" if len(likes) > 2 else next(s.channel for s in likes if s is not first)
    ratio = 20.0 * float(np.log10(UNIT_RATIOS[unit]))
    return (
        f"the level of {first.channel} against {against} changed by {middle:+.0f} dB in the median band, and "
        f"{ratio:.1f} dB is the ratio of {unit}: {UNIT_OR_GAIN} of {_whose(first, likes, moved)} may be wrong"
    )


def _whose(first: Shift, likes: Sequence[Shift], moved: Sequence[Shift]) -> str:
    """Of `likes`, `first` among them, those that fell; else, if they are fewer than the rest, those that rose more. A
    channel that rose less may be wrong, or all others are."""
    fallen = [s for s in likes if _fell(s)]
    if fallen:
        return _and(fallen)
    up = float(np.median(first.apart_db)) > 0.0
    own = [s for s in likes if s in moved and (float(np.median(s.apart_db)) > 0.0) == up]
    rest = [s for s in likes if s not in own]
    if up and len(own) < len(rest):
        return _and(own)
    return f"{_and(own)} or {_and(rest)}" if len(likes) == 2 else f"{_and(own)}, or of {_and(rest)},"


def _and(several: Sequence[Shift]) -> str:
    *many, last = (s.channel for s in several)
    return f"{', '.join(many)} and {last}" if many else last


def _fell(shift: Shift) -> bool:
    return float(np.percentile(shift.own_db, 25)) <= -FALLEN_DB


def _of_a_unit(shift: Shift) -> bool:
    if not shift.apart_db.size:
        return False
    low, middle, high = np.percentile(shift.apart_db, [25, 50, 75])
    near = unit_of(float(middle), APART_DB, possible(shift.quantity)) is not None
    return near and bool(max(high - middle, middle - low) <= WITHIN_DB)


def _large(shifts: Sequence[Shift]) -> list[str]:
    """One limit on the levels of all channels that changed far, with what may have done it."""
    far = [s for s in shifts if _far(s)]
    if not far:
        return []
    told = ", ".join(
        f"{s.channel} {np.median(s.own_db):+.0f} dB in the median band ({np.percentile(s.own_db, 25):+.0f} to "
        f"{np.percentile(s.own_db, 75):+.0f} in half of them)"
        for s in far
    )
    exact = 20.0 * float(np.log10(UNIT_RATIOS[GRAVITY]))
    fallen = [s for s in far if _fell(s)]
    near = [s for s in far if GRAVITY in possible(s.quantity) and abs(abs(np.median(s.own_db)) - exact) <= NEAR_DB]
    text = f"levels against the baseline: {told}"
    if near or fallen:
        doubted = [s for s in far if s in fallen or s in near]
        load = "unless the load was smaller, "
        why = f"a defect takes nothing away: {load}" if fallen else f"{exact:.1f} dB is the ratio of {GRAVITY}: "
        text += f"; {why}{UNIT_OR_GAIN} of {_and(doubted)} may be wrong"
    return [text]


def _far(shift: Shift) -> bool:
    return _fell(shift) or abs(float(np.median(shift.own_db))) >= LARGE_DB
