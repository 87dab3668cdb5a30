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
from reconcile.observe.observation import SAME_SPEED, PointData
from reconcile.verdict import EstimatedForce, LineChange, PointForce, Report
from sim.core.response import Channel

ACCELERATION = "acceleration"
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
NOT_ACCELERATION = (
    "Of sensors of velocity and displacement the gain is known to within 20 dB of its mean alone, which is not how it "
    "goes with frequency: they are not asked for the force."
)
NO_RISE = (
    "No line changed by more than a sound machine's may: the sizes are upper ends only. What takes motion away, or "
    "adds to lines that were strong already, can be so large unseen."
)
HIDDEN = (
    "Lines changed by more than a sound machine's may, but all of them may be products of what acts unseen at stronger "
    "ones, as contacts and a stiffness that varies over the turn mix lines: the sizes are upper ends only."
)
MIXED_LINES = (
    "Single lines may be products of others, as contacts and a stiffness that varies over the turn mix them: of made "
    "machines a quarter of the lines told had none of the force."
)
ASSUMED = (
    "That it acts there is assumed, not found: of all supports {site} is the one whose known effects come nearest to "
    "what was heard."
)


@dataclass(frozen=True, kw_only=True)
class ForceLine:
    """One told line; forces in N rms."""

    frequency_hz: float
    point: int
    speed_hz: float
    force_n: float
    low_n: float
    high_n: float


def with_force(report: Report, setting: Setting, supports: Sequence[str], channels: Sequence[Channel]) -> Report:
    """The report with the force by lines at the likeliest support, where the answer is unknown physics and no law
    stands; nothing else changes. `supports`: the likeliest first."""
    known = report.force
    if report.verdict != "unknown_physics" or not supports or (known is not None and known.law is not None):
        return report
    site = known.site if known is not None else supports[0]
    told_by = [one.quantity == ACCELERATION for one in channels]
    found = estimated_force(setting, site, report.where.lines, told_by=told_by)
    if site not in report.where.likeliest:
        found = replace(found, remarks=(ASSUMED.format(site=site), *found.remarks))
    return replace(report, force=found)


def estimated_force(
    setting: Setting, site: str, risen: Sequence[LineChange] = (), *, told_by: Sequence[bool] = ()
) -> EstimatedForce:
    """By the watched lines and those told as `risen` beside them. `told_by`: channels that are asked, all where it is
    empty."""
    nothing = EstimatedForce(site=site, samples={}, law=None, remarks=(NO_WORK,))
    if any(one.baseline is None for one in setting.data):
        return replace(nothing, remarks=(NO_BASELINE, NO_WORK))
    left_out = () if all(told_by) else (NOT_ACCELERATION,)
    machines = machines_like(setting)
    healthy = [healthy_of(bank, setting.plan) for bank in setting.banks]
    lines: list[ForceLine] = []
    heard: list[str] = []
    rose = False
    for k, one in enumerate(setting.data):
        at = beside(setting.data, k, risen)
        seen = reached(setting, k, site, machines, healthy, beside_hz=at, told_by=told_by or None)
        if seen is None:
            return replace(nothing, remarks=(UNHEARD, *left_out, NO_WORK))
        heard += seen.axes
        squares = force_squares(seen.heard)
        rose = rose or bool(squares.rose.any())
        lines += lines_told(one, k, seen, squares)
    axes = tuple(axis for axis in ("x", "y") if axis in heard)
    if not axes or not lines:
        return replace(nothing, remarks=(UNHEARD, *left_out, NO_WORK))
    unsure = HIDDEN if rose else NO_RISE
    standing = sorted((line for line in lines if line.low_n > 0.0), key=lambda line: -line.force_n)
    kept = [*standing, *_open(lines, len(setting.data))][:MOST_LINES]
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
        remarks=(_meant(site, axes), MIXED_LINES if standing else unsure, *left_out, NO_WORK),
    )


def _open(lines: Sequence[ForceLine], points: int) -> list[ForceLine]:
    """Lines at which the force may be nothing."""
    found: list[ForceLine] = []
    for k in range(points):
        own = [line for line in lines if line.point == k and line.low_n == 0.0]
        found += sorted(own, key=lambda line: -line.high_n)[:MOST_OPEN]
    return found


def beside(data: Sequence[PointData], number: int, risen: Sequence[LineChange]) -> list[float]:
    """Frequencies of lines told as risen at this operating point, at its own speed, of which no watched line's lobe has
    the middle: a line is told where the test had it, at the speed it turned with."""
    one = data[number]
    near = LOBE_BINS * one.test.resolution_hz / HANN_NOISE_BINS
    turned = one.point.speed_hz / one.spectra[0].speed_hz
    found: list[float] = []
    for line in risen:
        hz = line.frequency_hz * turned
        known = np.concatenate([one.lines_hz, found])
        apart = float(np.abs(known - hz).min(initial=np.inf)) > near
        if line.change_db > 0.0 and _place(data, line) == number and apart:
            found.append(hz)
    return found


def _place(data: Sequence[PointData], line: LineChange) -> int | None:
    """Number of the operating point that a line was told at: by the speed stated for it or the one measured there, the
    nearest; None where none is near."""
    told_hz = line.speed_hz
    if told_hz is None:
        return None

    def off(one: PointData) -> tuple[float, float]:
        speeds = (one.point.speed_hz, one.spectra[0].speed_hz)
        return min(abs(told_hz / hz - 1.0) for hz in speeds), abs(line.torque_ratio - one.point.torque_ratio)

    nearest = min(range(len(data)), key=lambda k: off(data[k]))
    return nearest if off(data[nearest])[0] <= SAME_SPEED else None


def lines_told(one: PointData, point: int, seen: Reached, squares: Squares) -> list[ForceLine]:
    """Lines that any channel tells, the surest of those that share a lobe of the spectrum."""
    near = (2 * LOBE_BINS + 1) * one.test.resolution_hz / HANN_NOISE_BINS
    known = np.flatnonzero(np.nan_to_num(squares.high) > 0.0)
    order = sorted(known, key=lambda k: (squares.low[k] == 0.0, -squares.best[k], -squares.high[k]))
    kept: list[int] = []
    for k in map(int, order):
        if all(abs(seen.hz[k] - seen.hz[j]) > near for j in kept):
            kept.append(k)
    best, low, high = (np.sqrt(np.maximum(values, 0.0)) for values in (squares.best, squares.low, squares.high))
    return [
        ForceLine(
            frequency_hz=float(seen.hz[k]),
            point=point,
            speed_hz=one.point.speed_hz,
            force_n=float(best[k]),
            low_n=float(low[k]),
            high_n=float(high[k]),
        )
        for k in kept
    ]


def _points(data: Sequence[PointData], lines: Sequence[ForceLine]) -> tuple[PointForce, ...]:
    """Sums of squares: of the lines that tell a force, and as the upper end of all lines, since the force may be at the
    others too; the ends of all at once, as the errors of gains and machine are shared among them."""

    def total(several: Sequence[ForceLine], name: str) -> float:
        return float(np.sqrt(sum(getattr(line, name) ** 2 for line in several)))

    found = []
    for k, one in enumerate(data):
        every = [line for line in lines if line.point == k]
        own = [line for line in every if line.low_n > 0.0]
        if every:
            found.append(
                PointForce(
                    speed_hz=one.point.speed_hz,
                    torque_ratio=one.point.torque_ratio,
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
        "knocks and a noise that rose are not in it."
    )
