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
from reconcile.machine.injected import base_at
from reconcile.machine.meter import Meter
from reconcile.machine.rolling import kind_of, known_family, rate_of
from reconcile.machine.setting import Setting
from reconcile.machine.severity import parameter_of, severity_of
from reconcile.machine.size_likelihood import Curve, Heard, sized
from reconcile.observe.impact_bands import Rate, Standing, bands_of, standing
from reconcile.observe.impact_pattern import patterns
from reconcile.verdict import Severity
from signals.series import FloatArray
from sim.core.spec import TermSpec

DRAWS, LEAST, LARGEST = 24, 0.27, 0.92
"""Sizes evenly over the logarithm of what is sought, in shares of that: 0.3 to 4.3 mm."""
MOST = 2
"""Effects of an answer that are sized."""
TURN, TURNED = 8, 0.5
"""Angles at which a pit of a ring that stands is tried, and the share of the sizes of that one;"""
ZONE = 0.5
"""and how far from the middle of the load zone, rad, such pits are drawn: there races tire."""
LEVEL_DB = 1.0
"""Error of how firmly impacts stand in a band, beside what they scatter: by the path and the pit's form."""
CERTAIN = 3.0
"""Errors by which impacts stand out in a band, from which its multiples count against each other;"""
PATTERN_DB, PER = 3.6, 1.5
"""the error of one of them, by the path and the pit's form, and how many say as much as one that is independent."""
CURVE = Curve(bandwidth=0.5, degree=1)
"""Through what the draws show."""


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
    points: list[list[_Sound | None]] = list(meter(_sounds, tasks))  # type: ignore[arg-type]
    runs = [k for k in range(len(terms)) if all(point[k] is not None for point in points)]
    size = parameter_of(name)
    ways = [way for task, point in zip(tasks, points, strict=True) for way in _ways(task, [point[k] for k in runs])]
    told = sized(np.log([abs(terms[k].parameters[size.name]) for k in runs]), ways, CURVE)
    return None if told is None else severity_of(size, told.mean, told.spread)


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


@dataclass(frozen=True, kw_only=True)
class _Sound:
    """Of a draw on the recorded baseline: how firmly impacts stand, (C, bands), and their multiples against each other,
    (C, bands, multiples), both in dB."""

    level: FloatArray
    pattern: FloatArray


def _sounds(task: _Task) -> list[_Sound | None]:
    """Of each draw; None where it does not run or adds nothing."""
    return [None if a is None else _sound(task, a) for a in task.place.added(task.terms)]


def _sound(task: _Task, motion: FloatArray) -> _Sound:
    ground = task.ground
    bands = ground.bands(ground.white + ground.added(motion))
    model = standing(bands, ground.seconds, task.rate)
    return _Sound(level=model.level, pattern=patterns(bands, ground.seconds, model.hz, task.rate))


def _ways(task: _Task, sounds: Sequence[_Sound | None]) -> list[Heard]:
    """What the draws and the test show at a point: levels, and the multiples where the test's levels stand out."""
    whole = [s for s in sounds if s is not None]
    if not whole:
        return []
    test = task.test
    levels = Heard(
        shown=np.array([np.maximum(s.level, 0.0).ravel() for s in whole]),
        seen=np.maximum(test.level, 0.0).ravel(),
        variance=np.asarray((test.error**2 + LEVEL_DB**2).ravel()),
    )
    return [levels, against_each_other(test, task.pattern, [s.pattern for s in whole])]


def against_each_other(test: Standing, own: FloatArray, others: Sequence[FloatArray]) -> Heard:
    """Multiples less their mean, of the test and of draws (C, bands, multiples) in dB over the floor, in the bands
    where the test's stand out and as far as all have them; what lies in the floor counts as on it."""
    known = np.isfinite(own) & np.all(np.isfinite(others), axis=0) & (test.level > CERTAIN * test.error)[..., None]

    def shape(pattern: FloatArray) -> FloatArray:
        over = np.where(known, np.maximum(pattern, 0.0), 0.0)
        return np.asarray(
            (over - over.sum(axis=2, keepdims=True) / np.maximum(known.sum(axis=2, keepdims=True), 1))[known]
        )

    seen = shape(own)
    shown = np.array([shape(one) for one in others])
    return Heard(shown=shown, seen=seen, variance=np.full(seen.size, PATTERN_DB**2), alike=PER)
