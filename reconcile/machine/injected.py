"""Which of several bearings with the same lines is struck: a defect at each, simulated, added to the baseline.

Impacts say at which rate, and bearings of one geometry on one shaft share it. What tells them apart is which sensor
hears the impacts in which band: a pit at the sensor's own bearing excites it far above what comes through the shaft
from the next one. The features of the atlas are levels of all that a machine does, of which a young pit is a small
part; here the motion that the pit alone adds on machines that agree with the baseline, through the sensors' gains, is
added to the recorded baseline, sized anew, and measured as the test is (docs/decisions/reconcile-injected.md).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from scipy import fft
from scipy.signal import resample

from reconcile.atlas.plan import AtlasPlan, Draw, Point, simulated_at
from reconcile.atlas.run import RATE_HZ, SETTLE_S, SPAN_S, run_members
from reconcile.calibrate.chain import Chain, band_centres_hz
from reconcile.judge.screen import Screen
from reconcile.kinematics.families import ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.direct import HEARD
from reconcile.machine.meter import Meter
from reconcile.machine.refine import best_draws, near_draws
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import LEAST_EVIDENCE
from reconcile.observe.impact_bands import ComplexArray, Rate, Standing, density, envelope_power, standing
from signals.series import FloatArray
from sim.core.errors import SidebandError
from sim.core.response import Response
from sim.core.spec import MachineSpec, TermSpec
from sim.terms import REGISTRY

LEADERS, DRAWS = 3, 8
"""Best draws of an effect, and draws about them, that are added to the baseline."""
SIZES_DB = np.arange(-25.0, 26.0, 5.0)
"""By which the added motion is made larger or smaller: the size is free."""
SIZE_DB = 15.0
"""Of one standard deviation of that."""
MODEL_DB, FLOOR_DB = 3.0, 1.0
"""Errors of the path and of the pit's form, where impacts stand out, and of any level."""
MOST_OFF = 9.0
"""Of a squared deviation: one resonance that the model has elsewhere must not decide."""
AUDIBLE_DB = 8.0
"""Over control rates, that a draw must reach in one band at the largest size."""
PER = 1.5
"""Log evidence a unit of half the squared distance. Draws of one place, taken for what was observed, lead the other
place by 2.5 to 14, 6.5 on the mean; concealed pits lie a third to a half as far ahead, as their form is another."""
MOST = 8.0
"""Log evidence that hearing is worth at most."""


@dataclass(frozen=True, kw_only=True)
class _Base:
    """A baseline to which is added, at one point: whitened transforms (C, n // 2 + 1), factors (C, n // 2 + 1) from the
    machine's motion to them, and the test as it stands out."""

    white: ComplexArray
    factor: FloatArray
    count: int
    rate_hz: float
    test: Standing


@dataclass(frozen=True, kw_only=True)
class _Task:
    """Effects simulated at one point, and the machines without them."""

    plan: AtlasPlan
    point: Point
    channels: tuple[str, ...]
    terms: tuple[TermSpec, ...]


def placed_by_hearing(setting: Setting, found: Found, meter: Meter) -> Screen:
    """The screen, in which places of the firmest impacts that share their lines count by how each would be heard."""
    rivals = twins(found)
    if len(rivals) < 2 or any(d.baseline is None or d.spectra[1] is None for d in setting.data):
        return found.screen
    off = distances(setting, found, rivals, meter)
    if len(off) < 2:
        return found.screen
    return counted(found.screen, off)


def counted(screen: Screen, off: Mapping[str, float]) -> Screen:
    """The screen with evidence against places that are farther `off` than the nearest."""
    against = worth(off)
    less = np.array([against.get(n, 0.0) for n in screen.names])
    evidence = screen.evidence - less
    log = evidence - evidence.max()
    weights = np.exp(log) / np.exp(log).sum()
    return replace(screen, evidence=evidence, direct=screen.direct - less, weights=weights, heard=against)


def worth(off: Mapping[str, float]) -> dict[str, float]:
    """Log evidence against each place."""
    return {name: min(MOST, PER * (value - min(off.values()))) for name, value in off.items()}


def twins(found: Found) -> tuple[str, ...]:
    """Places of the effect with the firmest impacts that strike at the same lines, likeliest first."""
    screen = found.screen
    direct = dict(zip(screen.names, map(float, screen.direct), strict=True))
    evidence = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    rolling = [n for n, value in direct.items() if value >= HEARD and _kind(n) not in ("", "tooth")]
    if not rolling:
        return ()
    first = max(rolling, key=lambda n: (round(direct[n], 6), evidence[n]))
    term = first.split("@")[0]
    alike = [n for n in rolling if n.split("@")[0] == term and direct[n] > direct[first] - LEAST_EVIDENCE]
    return tuple(sorted(alike, key=lambda n: -evidence[n]))


def distances(setting: Setting, found: Found, names: Sequence[str], meter: Meter) -> dict[str, float]:
    """Half the squared distance of each effect's nearest draw from what is heard; without those that cannot run."""
    rates = [_rates(setting.machine, n) for n in names]
    bases = [_base(setting, p, rates[0]) for p in range(len(setting.data))]
    rng = np.random.default_rng([setting.seed, 31])
    leaders = [best_draws(found.fitted, found.known, n, setting.changes.observed, LEADERS) for n in names]
    drawn = [tuple(near_draws(own, DRAWS, rng)) for own in leaders]
    points = [simulated_at(setting.machine, one.point) for one in setting.data]
    distinct = tuple(sorted(set(setting.simulated)))
    tasks = [
        _Task(plan=setting.plan, point=point, channels=distinct, terms=terms) for point, terms in product(points, drawn)
    ]
    rows = [distinct.index(c) for c in setting.simulated]
    off: list[list[FloatArray]] = [[] for _ in names]
    for k, motions in enumerate(meter(_motions, tasks)):  # type: ignore[arg-type]
        p, which = divmod(k, len(names))
        rate = rates[which](points[p].speed_hz)
        moved = [None if m is None else m[rows] for m in motions]  # type: ignore[index]
        off[which].append(np.array([_off(bases[p], m, rate) for m in moved]))
    nearest = {name: float(np.min(_over_points(own))) for name, own in zip(names, off, strict=True)}
    return {name: value for name, value in nearest.items() if np.isfinite(value)}


def _over_points(off: Sequence[FloatArray]) -> FloatArray:
    """(draws, sizes): the mean over points, as what errs in the model errs at all of them, and what a size costs."""
    return np.asarray(0.5 * (np.mean(off, axis=0) + (SIZES_DB / SIZE_DB) ** 2))


def _kind(name: str) -> str:
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    return (term.strikes or "") if term is not None else ""


def _rates(machine: MachineSpec, name: str) -> Callable[[float], Rate]:
    """At a speed of the drive shaft, Hz, how often the part is struck."""
    tie = ties(of_machine(machine), machine.operating.shaft if machine.operating else None)
    kind, site = _kind(name), name.split("@")[1]
    family = next(f for f in tie.families if f.kind == kind and f.site == site)

    def at(speed_hz: float) -> Rate:
        return Rate(hz=family.order * speed_hz, spacing_hz=family.spacing * speed_hz, sidebands=family.sidebands)

    return at


def _base(setting: Setting, point: int, rate: Callable[[float], Rate]) -> _Base:
    test, baseline = setting.data[point].spectra
    if baseline is None:
        raise ValueError("nothing to add to without a baseline")
    rate_hz = baseline.rate_hz
    count = min(round(SPAN_S * rate_hz), baseline.samples.shape[1], test.samples.shape[1])
    hz = np.arange(count // 2 + 1) * rate_hz / count
    floors = [np.interp(hz, *density(row, rate_hz)) for row in baseline.samples]
    gain = _gain(setting.seen_through[point].chain, hz)
    over = 1.0 / np.sqrt(np.array(floors))
    now = [envelope_power(fft.rfft(x[:count]) * o, count, rate_hz) for x, o in zip(test.samples, over, strict=True)]
    return _Base(
        white=np.array([fft.rfft(x[:count]) * o for x, o in zip(baseline.samples, over, strict=True)]),
        factor=np.asarray(gain * over),
        count=count,
        rate_hz=rate_hz,
        test=standing(now, count / rate_hz, rate(test.speed_hz)),
    )


def _gain(chain: Chain, hz: FloatArray) -> FloatArray:
    """Amplitude gains (C, n) at frequencies."""
    at = np.log(np.maximum(hz, 1.0))
    return np.array([10.0 ** (np.interp(at, np.log(band_centres_hz()), row) / 20.0) for row in chain.gain_db])


def _motions(task: _Task) -> list[FloatArray | None]:
    """What each effect adds to the channels (C, n) of its machine; None where one does not run or nothing is added."""
    numbers = range(len(task.terms))
    machines = len(task.plan.offsets)
    with_it = [Draw(pair=k % machines, term=t) for k, t in zip(numbers, task.terms, strict=True)]
    members = [task.plan.member(d, task.point) for d in with_it]
    without = [task.plan.member(Draw(pair=d.pair), task.point) for d in with_it]
    responses = run_members(members, task.channels), run_members(without, task.channels)
    return [_difference(a, b) for a, b in zip(*responses, strict=True)]


def _difference(one: Response | SidebandError, other: Response | SidebandError) -> FloatArray | None:
    if not isinstance(one, Response) or not isinstance(other, Response):
        return None
    first = round(SETTLE_S * one.sampling_rate_hz)
    added = np.asarray(one.signals[:, first:]) - np.asarray(other.signals[:, first:])
    return added if bool(np.all(np.isfinite(added))) and float(np.abs(added).max()) > 0.0 else None


def _off(base: _Base, motion: FloatArray | None, rate: Rate) -> FloatArray:
    """Squared distance of what would be heard from the test, (sizes,); infinite where nothing is heard at any size: a
    pit of the outer race that no loaded ball meets says nothing of its bearing."""
    silent = np.full(SIZES_DB.size, np.inf)
    if motion is None:
        return silent
    added = base.factor * np.array([_on_grid(row, base) for row in motion])
    off, loudest = [], 0.0
    for size_db in SIZES_DB:
        sum_of = base.white + 10.0 ** (size_db / 20.0) * added
        bands = [envelope_power(row, base.count, base.rate_hz) for row in sum_of]
        level = standing(bands, base.count / base.rate_hz, rate).level
        loudest = max(loudest, float(level.max()))
        off.append(apart(base.test, level))
    return np.array(off) if loudest >= AUDIBLE_DB else silent


def apart(test: Standing, level: FloatArray) -> float:
    """Squared distance of levels (C, bands) from the test's."""
    out = 1.0 - 10.0 ** (-np.maximum(np.maximum(level, test.level), 0.0) / 10.0)
    squared = (test.level - level) ** 2 / (test.error**2 + FLOOR_DB**2 + (MODEL_DB * out) ** 2)
    return float(np.minimum(squared, MOST_OFF).sum())


def _on_grid(motion: FloatArray, base: _Base) -> ComplexArray:
    """Transform (n // 2 + 1,) of a simulated channel as that of the baseline's samples."""
    again = np.asarray(resample(motion, max(round(motion.size * base.rate_hz / RATE_HZ), base.count)))
    return np.asarray(fft.rfft(again[: base.count]))
