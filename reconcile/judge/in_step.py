"""Whether phases between sensors may be compared: against a baseline, of several sensors that share their clock."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.observe.clocks import delay_s, shared_delay_s
from reconcile.observe.observation import PointData
from reconcile.observe.phases import DB_PER_RAD, between_sensors, phase_deviations, wrapped
from reconcile.observe.statistics import Statistics
from reconcile.observe.watch import WatchList
from signals.series import FloatArray

KNOWN_DB = 0.5 * DB_PER_RAD
"""Lines whose phases are known to this, half a radian, tell of clocks."""
APART, FEWEST_KNOWN = 1.1, 6
"""Ratio of two speeds at which strong lines alone tell of one delay, and so many of them that are known at each: at one
speed, under two loads, the same six lines are no twelve (false delays in 1 to 2 % of tries at 0.1 to 0.2 rad)."""


@dataclass(frozen=True, kw_only=True)
class Delay:
    """Channel `channel` is `seconds` later against the next one than it was in the baseline, at point `point`."""

    point: int
    channel: int
    seconds: float


def compared(data: Sequence[PointData], delays: Sequence[Delay]) -> bool:
    """Whether the phases count."""
    return all(d.baseline is not None for d in data) and data[0].test.line.shape[0] > 1 and not delays


def clock_delays(data: Sequence[PointData], noise: Sequence[FloatArray], watched: WatchList) -> tuple[Delay, ...]:
    """Every delay found; `noise`: of the lines' lobes at each point, (C, L)."""
    kept, found = list(watched.phased), []
    strong = np.asarray(watched.own)[kept]
    seen: list[Seen] = []
    for p, (one, lobe) in enumerate(zip(data, noise, strict=True)):
        if one.baseline is None or one.test.line.shape[0] < 2 or not kept:
            continue
        change = wrapped(between_sensors(one.test.phase) - between_sensors(one.baseline.phase))
        spread = np.hypot(_spread(one.test, lobe, kept), _spread(one.baseline, lobe, kept))
        phases = np.where(spread < KNOWN_DB, change, np.nan) / DB_PER_RAD
        told = [(c, delay_s(row, one.lines_hz[kept])) for c, row in enumerate(phases)]
        found += [Delay(point=p, channel=c, seconds=s) for c, s in told if s is not None]
        seen.append(Seen(speed_hz=one.point.speed_hz, phases=phases[:, strong], hz=one.lines_hz[kept][strong]))
    return tuple(found) or _shared(seen)


@dataclass(frozen=True, kw_only=True)
class Seen:
    """Of one operating point: `phases` (C, Q) of the strong lines between sensors, rad, NaN where not known, and their
    frequencies (Q,), Hz."""

    speed_hz: float
    phases: FloatArray
    hz: FloatArray


def _shared(seen: Sequence[Seen]) -> tuple[Delay, ...]:
    """One delay at all points, told of the first, of channels whose lines are known at speeds that lie apart."""
    found = []
    for c in range(seen[0].phases.shape[0] if seen else 0):
        told = [one for one in seen if np.sum(np.isfinite(one.phases[c])) >= FEWEST_KNOWN]
        speeds = [one.speed_hz for one in told]
        if not told or max(speeds) < APART * min(speeds):
            continue
        seconds = shared_delay_s(
            np.concatenate([one.phases[c] for one in told]), np.concatenate([one.hz for one in told])
        )
        found += [Delay(point=0, channel=c, seconds=seconds)] if seconds is not None else []
    return tuple(found)


def _spread(seen: Statistics, lobe: FloatArray, kept: Sequence[int]) -> FloatArray:
    rows = list(kept)
    return phase_deviations(np.maximum(seen.line[:, rows] - lobe[:, rows], 0.0), lobe[:, rows])
