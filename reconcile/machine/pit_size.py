"""How large a pit of a bearing is: as large as one whose impacts, simulated and added to the baseline, sound like it.

The features of the atlas are levels of all that a machine does, of which a pit's impacts are a part that no line shows.
Here pits of known sizes are simulated on machines that agree with the baseline; what they add goes through the sensors'
gains onto the recorded baseline, and how firmly impacts stand in each band, and how strong the multiples of their rate
are against each other, is compared with the test (docs/decisions/reconcile-pit-size.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.atlas.candidates import Candidate, already, draw_term
from reconcile.kinematics.families import Family
from reconcile.machine.added import Place, place_at
from reconcile.machine.ground import Ground
from reconcile.machine.injected import MOST_OFF, apart, base_at
from reconcile.machine.meter import Meter
from reconcile.machine.rolling import kind_of, known_family, rate_of
from reconcile.machine.setting import Setting
from reconcile.machine.severity import LEAST_SPREAD, TELLS, parameter_of, severity_of
from reconcile.observe.impact_bands import Rate, Standing, bands_of, standing
from reconcile.observe.impact_pattern import patterns
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.core.spec import TermSpec

DRAWS, LEAST, LARGEST = 20, 0.27, 0.92
"""Sizes evenly over the logarithm of what is sought, in shares of that: 0.3 to 4.3 mm."""
MOST = 2
"""Effects of an answer that are sized."""
LEAST_DRAWS = 8
"""That run, of which a size can be read."""
TURN, TURNED = 8, 0.5
"""Angles at which a pit of a ring that stands is tried, and the share of the sizes of that one;"""
ZONE = 0.5
"""and how far from the middle of the load zone, rad, such pits are drawn: there races tire."""
CERTAIN = 3.0
"""Errors by which impacts stand out in a band, from which its multiples count against each other;"""
PATTERN_DB, PER = 3.6, 1.5
"""the error of one of them, by the path and the pit's form, and how many say as much as one that is independent."""
BANDWIDTH = 0.25
"""Of the curve through the draws, in the logarithm of the size."""
GRID = 200


@dataclass(frozen=True, kw_only=True)
class _Task:
    """Draws of one effect at one point."""

    place: Place
    terms: tuple[TermSpec, ...]
    rate: Rate
    ground: Ground
    test: Standing
    pattern: FloatArray


def pit_sizes(setting: Setting, names: Sequence[str], meter: Meter) -> dict[str, Severity]:
    """Sizes of those of the effects that are pits of bearings, where they are heard at a point or more."""
    if any(d.baseline is None or d.spectra[1] is None for d in setting.data):
        return {}
    pits = [n for n in names if kind_of(n) not in ("", "tooth")][:MOST]
    return {n: size for n in pits if (size := _size_of(setting, n, meter)) is not None}


def _size_of(setting: Setting, name: str, meter: Meter) -> Severity | None:
    family = known_family(setting.machine, name)
    if family is None:
        return None
    heard = [p for p in range(len(setting.data)) if _bands(setting, p) and base_at(setting, p, family).out]
    if not heard:
        return None
    terms = _terms(setting, name, heard[0], meter)
    tasks = [_task(setting, p, family, terms) for p in heard]
    points: list[FloatArray] = list(meter(_distances, tasks))  # type: ignore[arg-type]
    off = np.mean(points, axis=0)
    size = parameter_of(name)
    told = sized(np.log([abs(t.parameters[size.name]) for t in terms]), off)
    return None if told is None else severity_of(size, *told)


def _bands(setting: Setting, point: int) -> bool:
    return len(bands_of(setting.data[point].spectra[0].rate_hz)) > 0


def _terms(setting: Setting, name: str, point: int, meter: Meter) -> tuple[TermSpec, ...]:
    """The draws; of a ring that stands in its load zone, but for a pit that the machine file has and that grew."""
    term, site = name.split("@")
    rng = np.random.default_rng([setting.seed, 41, *name.encode()])
    candidate = Candidate(term=term, site=site)
    shares = np.linspace(LEAST, LARGEST, DRAWS)
    drawn = [draw_term(candidate, float(s), rng, setting.plan.machine) for s in shares]
    if kind_of(name) != "outer" or already(setting.plan.machine, term, site) is not None:
        return tuple(drawn)
    middle = draw_term(candidate, TURNED, rng, setting.plan.machine)
    tried = tuple(_turned(middle, float(a)) for a in np.arange(TURN) * 2.0 * np.pi / TURN)
    turned = _Turned(place=place_at(setting, point), terms=tried)
    found: list[FloatArray] = list(meter(_loudness, [turned]))  # type: ignore[arg-type,list-item]
    loud = found[0]
    zone = float(np.angle(np.sum(loud * np.exp(2j * np.pi * np.arange(TURN) / TURN))))
    return tuple(_turned(t, zone + float(rng.uniform(-ZONE, ZONE))) for t in drawn) if loud.any() else tuple(drawn)


def _turned(term: TermSpec, angle: float) -> TermSpec:
    return term.model_copy(update={"parameters": {**term.parameters, "angle": angle}})


@dataclass(frozen=True, kw_only=True)
class _Turned:
    """A pit at several angles."""

    place: Place
    terms: tuple[TermSpec, ...]


def _loudness(task: _Turned) -> FloatArray:
    """Root mean square of what a pit adds at each angle, (angles,)."""
    added = task.place.added(task.terms, machine=0)
    return np.array([0.0 if a is None else float(np.sqrt(np.mean(a**2))) for a in added])


def _task(setting: Setting, point: int, family: Family, terms: tuple[TermSpec, ...]) -> _Task:
    base = base_at(setting, point, family)
    place = place_at(setting, point)
    test = setting.data[point].spectra[0]
    ground = base.ground
    heard = ground.bands(base.heard)
    return _Task(
        place=place,
        terms=terms,
        rate=rate_of(family, place.point.speed_hz),
        ground=ground,
        test=base.test,
        pattern=patterns(heard, ground.seconds, base.test.hz, rate_of(family, test.speed_hz)),
    )


def _distances(task: _Task) -> FloatArray:
    """Squared distance of each draw from the test, (draws,); NaN where it does not run or adds nothing."""
    return np.array([np.nan if a is None else _off(task, a) for a in task.place.added(task.terms)])


def _off(task: _Task, motion: FloatArray) -> float:
    ground = task.ground
    bands = ground.bands(ground.white + ground.added(motion))
    model = standing(bands, ground.seconds, task.rate)
    shape = patterns(bands, ground.seconds, model.hz, task.rate)
    return apart(task.test, model.level) + apart_in_pattern(task.test, task.pattern, shape) / PER


def apart_in_pattern(test: Standing, own: FloatArray, other: FloatArray) -> float:
    """Squared distance of multiples against each other, (C, bands, multiples) in dB over the floor, in the bands where
    the test's stand out; what lies in the floor in both counts nothing."""
    known = np.isfinite(own) & np.isfinite(other) & (test.level > CERTAIN * test.error)[..., None]
    one, two = (np.where(known, np.maximum(x, 0.0), 0.0) for x in (own, other))
    many = np.maximum(known.sum(axis=2, keepdims=True), 1)
    differ = (one - one.sum(axis=2, keepdims=True) / many) - (two - two.sum(axis=2, keepdims=True) / many)
    out = 1.0 - 10.0 ** (-np.maximum(one, two) / 10.0)
    return float(np.sum(np.where(known, out * np.minimum((differ / PATTERN_DB) ** 2, MOST_OFF), 0.0)))


def sized(logs: FloatArray, off: FloatArray) -> tuple[float, float] | None:
    """Mean and standard deviation of the logarithm of a size by squared distances `off` (n,) of draws at `logs` (n,);
    None where they hardly tell it."""
    known = np.isfinite(off)
    if np.count_nonzero(known) < LEAST_DRAWS:
        return None
    grid = np.linspace(logs.min(), logs.max(), GRID)
    curve = np.array([_smooth(at, logs[known], off[known]) for at in grid])
    weights = np.exp(-0.5 * (curve - curve.min()))
    weights /= weights.sum()
    mean = float(weights @ grid)
    spread = float(np.sqrt(weights @ (grid - mean) ** 2))
    return (mean, float(np.hypot(spread, LEAST_SPREAD))) if spread <= TELLS else None


def _smooth(at: float, logs: FloatArray, off: FloatArray) -> float:
    """A line through what is near, by weighted least squares, there."""
    near = np.exp(-0.25 * ((logs - at) / BANDWIDTH) ** 2)
    sides = np.stack([near, near * (logs - at)], axis=1)
    return float(np.linalg.lstsq(sides, near * off, rcond=None)[0][0])
