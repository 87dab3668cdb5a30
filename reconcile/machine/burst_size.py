"""How large a fault of a tooth is: as large as one whose burst, simulated, stands as far out of the mean turn.

A crack moves no line of the teeth by more than drift does, and the draws near the observation are then of any size. Its
burst is heard, and how strong it is depends on the size far more than on the machine: the motion that faults of known
sizes add on machines that agree with the baseline goes through the sensors' gains, is divided by the error of the
recorded mean turn, order by order, and measured as the test's is (docs/decisions/reconcile-burst-size.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.candidates import Candidate, draw_term
from reconcile.atlas.run import RATE_HZ
from reconcile.machine.added import Place, place_at
from reconcile.machine.meter import Meter
from reconcile.machine.motion import path_gain
from reconcile.machine.setting import Setting
from reconcile.machine.severity import LEAST_SPREAD, parameter_of, severity_of
from reconcile.machine.window import TurningGear, burst_at, gears_in_mesh, turned_at
from reconcile.observe.whole_turn import Burst
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.core.spec import TermSpec
from sim.terms import REGISTRY

DRAWS, LEAST = 8, 0.1
"""Of an effect, sizes evenly over the logarithm of what is sought, but for the smallest; they fill vector lanes."""
LEAST_DRAWS = 4
TOP = 0.8
"""Of half the simulations' sampling rate: what of the burst is beyond is not in them."""
LEAST_SHARE = 1.5
"""Power of a burst over the fullest window of the baseline's mean turn, from which it says a size."""
GRID = 400
LEAST_SLOPE = 0.3
"""Of the logarithm of a burst's amplitude over that of the size, below which it says nothing of sizes."""


@dataclass(frozen=True, kw_only=True)
class _Task:
    """Effects, several draws of each, at one point."""

    place: Place
    terms: tuple[tuple[TermSpec, ...], ...]
    burst: Burst
    factor: FloatArray
    turn_hz: float


@dataclass(frozen=True, kw_only=True)
class Heard:
    """At one point: logarithms of an effect's sizes (n,) and of the amplitudes of their bursts (n,), and that of the
    recorded one with its error by noise."""

    sizes: FloatArray
    bursts: FloatArray
    told: float
    error: float


def burst_sizes(setting: Setting, names: Sequence[str], meter: Meter) -> dict[str, Severity]:
    """Sizes of those of the effects that are faults of a tooth whose place is told, where it is at a point or more."""
    places = setting.direct.places
    faults: dict[str, list[str]] = {}
    for name in names:
        term, site = name.split("@")
        known = REGISTRY.get(term)
        if known is not None and known.strikes == "tooth" and site in places and places[site].told:
            faults.setdefault(site, []).append(name)
    return {k: v for gear, several in faults.items() for k, v in _of_gear(setting, gear, several, meter).items()}


def _of_gear(setting: Setting, gear: str, names: Sequence[str], meter: Meter) -> dict[str, Severity]:
    drawn = tuple(_draws(setting, name) for name in names)
    tasks = [t for p in range(len(setting.data)) if (t := _task(setting, p, gear, drawn)) is not None]
    heard: list[list[FloatArray]] = list(meter(_amplitudes, tasks))  # type: ignore[arg-type]
    found: dict[str, Severity] = {}
    for k, (name, terms) in enumerate(zip(names, drawn, strict=True)):
        size = parameter_of(name)
        logs = np.log([abs(t.parameters[size.name]) for t in terms])
        points = [one for t, of in zip(tasks, heard, strict=True) if (one := _heard(t.burst, logs, of[k])) is not None]
        told = sized(points, (float(logs.min()), float(logs.max())))
        if told is not None:
            found[name] = severity_of(size, *told)
    return found


def _draws(setting: Setting, name: str) -> tuple[TermSpec, ...]:
    term, site = name.split("@")
    rng = np.random.default_rng([setting.seed, 37, *name.encode()])
    candidate = Candidate(term=term, site=site)
    return tuple(draw_term(candidate, float(s), rng, setting.plan.machine) for s in np.linspace(LEAST, 1.0, DRAWS))


def _task(setting: Setting, point: int, gear: str, drawn: tuple[tuple[TermSpec, ...], ...]) -> _Task | None:
    one = setting.data[point]
    speed_hz = one.spectra[0].speed_hz
    turning: TurningGear | None = next((g for g in gears_in_mesh(setting.machine, speed_hz) if g.name == gear), None)
    burst = None if turning is None else burst_at(one, turning, top_hz=TOP * RATE_HZ / 2)
    if turning is None or burst is None or burst.power < LEAST_SHARE * burst.usual:
        return None
    place = place_at(setting, point)
    orders = np.arange(burst.kept.size, dtype=np.float64)
    return _Task(
        place=place,
        terms=drawn,
        burst=burst,
        factor=path_gain(setting.seen_through[point].chain, orders * speed_hz * turning.ratio)[burst.alive],
        turn_hz=place.point.speed_hz * turning.ratio,
    )


def _amplitudes(task: _Task) -> list[FloatArray]:
    """Of each effect, the logarithm of each draw's burst (n,); NaN where it does not run."""
    found = task.place.added_by(task.terms)
    return [np.array([np.nan if a is None else _amplitude(a, task) for a in added]) for added in found]


def _amplitude(motion: FloatArray, task: _Task) -> float:
    power = task.burst.power_of(turned_at(motion, RATE_HZ, task.turn_hz), task.factor)
    return 0.5 * float(np.log(power)) if power > 0.0 else float("nan")


def _heard(burst: Burst, sizes: FloatArray, bursts: FloatArray) -> Heard | None:
    known = np.isfinite(bursts)
    if np.count_nonzero(known) < LEAST_DRAWS:
        return None
    noise = 0.5 * burst.usual / burst.power
    return Heard(sizes=sizes[known], bursts=bursts[known], told=0.5 * float(np.log(burst.power)), error=noise)


def sized(points: Sequence[Heard], ends: tuple[float, float]) -> tuple[float, float] | None:
    """Mean and standard deviation of the logarithm of a size between `ends`; None where no point says it."""
    told = [one for p in points if (one := _read(p, ends)) is not None]
    if not told:
        return None
    logs, errors = np.array([t[0] for t in told]), np.array([t[1] for t in told])
    weights = errors**-2.0 / np.sum(errors**-2.0)
    mean = float(weights @ logs)
    return mean, float(np.sqrt(LEAST_SPREAD**2 + weights @ (logs - mean) ** 2 + 1.0 / np.sum(errors**-2.0)))


def _read(one: Heard, ends: tuple[float, float]) -> tuple[float, float] | None:
    """The logarithm of the size whose burst is as strong, on a parabola through those of the draws, and its error."""
    curve = np.polynomial.Polynomial.fit(one.sizes, one.bursts, 2)
    grid = np.linspace(*ends, GRID)
    rising = np.maximum.accumulate(curve(grid))
    at = int(np.argmin(np.abs(rising - one.told)))
    near = slice(max(0, at - GRID // 8), at + GRID // 8)
    slope = float(np.ptp(rising[near]) / np.ptp(grid[near]))
    if slope < LEAST_SLOPE:
        return None
    scatter = float(np.sqrt(np.sum((one.bursts - curve(one.sizes)) ** 2) / max(1, one.sizes.size - 3)))
    return float(grid[at]), float(np.hypot(scatter, one.error)) / slope
