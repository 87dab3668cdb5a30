"""The force of an unknown physics by lines: no law stands, but how large it is can be told."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.changes import healthy_of
from reconcile.machine.added_power import Reached, machines_like, reached
from reconcile.machine.force import Squares, force_squares
from reconcile.machine.setting import Setting
from reconcile.observe.extract import HANN_NOISE_BINS, LOBE_BINS
from reconcile.observe.observation import PointData
from reconcile.verdict import EstimatedForce, LineChange, PointForce, Report

MOST_LINES = 60
"""Lines that are told, of all operating points together."""
MOST_OPEN = 6
"""Of these at one operating point, lines at which the force may be nothing: those with the largest upper ends."""
NO_WORK = (
    "The work per cycle cannot be told: the recordings bring no phases through the sensors' paths, so neither the "
    "waveform of the force nor its phase against the motion is known, only its power at each line."
)
NO_BASELINE = (
    "Without a baseline at every operating point no force is estimated: the sensors' gains are then read from the "
    "tests themselves, with the force in them."
)
UNHEARD = "No force is estimated: no channel whose gain the baseline tells is reached by a force at this support."
NO_RISE = (
    "No line changed by more than a sound machine's may: the sizes are upper ends only. What takes motion away, or "
    "adds to lines that were strong already, can be so large unseen."
)


@dataclass(frozen=True, kw_only=True)
class _Line:
    """One told line; forces in N rms."""

    frequency_hz: float
    point: int
    speed_hz: float
    force_n: float
    low_n: float
    high_n: float


def with_force(report: Report, setting: Setting, supports: Sequence[str]) -> Report:
    """The report with the force by lines at the likeliest support, where the answer is unknown physics and no law
    stands; nothing else changes. `supports`: the likeliest first."""
    known = report.force
    if report.verdict != "unknown_physics" or not supports or (known is not None and known.law is not None):
        return report
    if known is None and any(one.baseline is None for one in setting.data):
        return report
    site = known.site if known is not None else supports[0]
    return replace(report, force=estimated_force(setting, site, report.where.lines))


def estimated_force(setting: Setting, site: str, risen: Sequence[LineChange] = ()) -> EstimatedForce:
    """By the watched lines and those told as `risen` beside them."""
    nothing = EstimatedForce(site=site, samples={}, law=None, remarks=(NO_WORK,))
    if any(one.baseline is None for one in setting.data):
        return replace(nothing, remarks=(NO_BASELINE, NO_WORK))
    machines = machines_like(setting)
    healthy = [healthy_of(bank, setting.plan) for bank in setting.banks]
    found: list[Reached] = []
    lines: list[_Line] = []
    for k, one in enumerate(setting.data):
        seen = reached(setting, k, site, machines, healthy, beside(one, risen))
        if seen is None:
            return replace(nothing, remarks=(UNHEARD, NO_WORK))
        found.append(seen)
        lines += _told(one, k, seen, force_squares(seen.heard))
    standing = sorted((line for line in lines if line.low_n > 0.0), key=lambda line: -line.force_n)
    axes = tuple(axis for axis in ("x", "y") if any(axis in seen.axes for seen in found))
    if not axes:
        return replace(nothing, remarks=(UNHEARD, NO_WORK))
    kept = [*standing, *_open(lines, len(found))][:MOST_LINES]
    kept.sort(key=lambda line: (line.point, line.frequency_hz))
    return replace(
        nothing,
        samples={
            "frequency_hz": tuple(line.frequency_hz for line in kept),
            "order": tuple(line.frequency_hz / line.speed_hz for line in kept),
            "speed_hz": tuple(line.speed_hz for line in kept),
            "torque_ratio": tuple(setting.data[line.point].point.torque_ratio for line in kept),
            "force_n": tuple(line.force_n for line in kept),
            "low_n": tuple(line.low_n for line in kept),
            "high_n": tuple(line.high_n for line in kept),
        },
        axes=axes,
        points=_points(setting.data, lines),
        remarks=(_meant(site, axes), *(() if standing else (NO_RISE,)), NO_WORK),
    )


def _open(lines: Sequence[_Line], points: int) -> list[_Line]:
    """Lines at which the force may be nothing."""
    found: list[_Line] = []
    for k in range(points):
        own = [line for line in lines if line.point == k and line.low_n == 0.0]
        found += sorted(own, key=lambda line: -line.high_n)[:MOST_OPEN]
    return found


def beside(one: PointData, risen: Sequence[LineChange]) -> list[float]:
    """Frequencies of lines told as risen at this operating point of which no watched line's lobe has the middle."""
    near = LOBE_BINS * one.test.resolution_hz / HANN_NOISE_BINS
    found: list[float] = []
    for line in risen:
        here = line.speed_hz == one.point.speed_hz and line.torque_ratio == one.point.torque_ratio
        known = np.concatenate([one.lines_hz, found])
        if here and line.change_db > 0.0 and float(np.abs(known - line.frequency_hz).min(initial=np.inf)) > near:
            found.append(line.frequency_hz)
    return found


def _told(one: PointData, point: int, seen: Reached, squares: Squares) -> list[_Line]:
    """Lines that rose, the surest of those that share a lobe of the spectrum."""
    near = (2 * LOBE_BINS + 1) * one.test.resolution_hz / HANN_NOISE_BINS
    rose = np.flatnonzero(np.nan_to_num(squares.best) > 0.0)
    order = sorted(rose, key=lambda k: (squares.low[k] == 0.0, -squares.best[k]))
    kept: list[int] = []
    for k in map(int, order):
        if all(abs(seen.hz[k] - seen.hz[j]) > near for j in kept):
            kept.append(k)
    best, low, high = (np.sqrt(np.maximum(values, 0.0)) for values in (squares.best, squares.low, squares.high))
    return [
        _Line(
            frequency_hz=float(seen.hz[k]),
            point=point,
            speed_hz=one.point.speed_hz,
            force_n=float(best[k]),
            low_n=float(low[k]),
            high_n=float(high[k]),
        )
        for k in kept
    ]


def _points(data: Sequence[PointData], lines: Sequence[_Line]) -> tuple[PointForce, ...]:
    """Sums of squares: of the lines that tell a force, and as the upper end of all lines, since the force may be at the
    others too; the ends of all at once, as the errors of gains and machine are shared among them."""

    def total(several: Sequence[_Line], name: str) -> float:
        return float(np.sqrt(sum(getattr(line, name) ** 2 for line in several)))

    found = []
    for k, one in enumerate(data):
        every = [line for line in lines if line.point == k]
        own = [line for line in every if line.low_n > 0.0]
        if own:
            point = one.point
            found.append(
                PointForce(
                    speed_hz=point.speed_hz,
                    torque_ratio=point.torque_ratio,
                    lines=len(own),
                    force_n=total(own, "force_n"),
                    low_n=total(own, "low_n"),
                    high_n=total(every, "high_n"),
                )
            )
    return tuple(found)


def _meant(site: str, axes: Sequence[str]) -> str:
    """How the samples are meant."""
    along = " and ".join(axes)
    unheard = "" if len(axes) > 1 else f"; no sensor hears a force along {'y' if axes[0] == 'x' else 'x'}"
    return (
        f"It stands for what acts, wherever that is: a force on the outer ring of {site} along {along} that would "
        f"change these lines as much{unheard}. Only lines at which the baseline tells the sensors' gain are counted; "
        "knocks and noise, which have none, are not in it."
    )
