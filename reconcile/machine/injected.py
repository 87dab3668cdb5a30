"""Which of several bearings with the same lines is struck: a defect at each, simulated, added to the baseline.

Impacts say at which rate, and bearings of one geometry on one shaft share it. What tells them apart is which sensor
hears the impacts in which band: a pit at the sensor's own bearing excites it far above what comes through the shaft
from the next one. The features of the atlas are levels of all that a machine does, of which a young pit is a small
part; here the motion that the pit alone adds on machines that agree with the baseline, through the sensors' gains, is
added to the recorded baseline, sized anew, and measured as the test is (docs/decisions/reconcile-injected.md).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.judge.screen import Screen, of_best
from reconcile.kinematics.families import Family
from reconcile.kinematics.judge import same
from reconcile.machine.added import Place, place_at
from reconcile.machine.direct import HEARD
from reconcile.machine.ground import Ground, ground_of
from reconcile.machine.meter import Meter
from reconcile.machine.refine import best_draws, near_draws, seen_draws
from reconcile.machine.rolling import family_of, kind_of, rate_of
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import LEAST_EVIDENCE
from reconcile.observe.impact_bands import ComplexArray, Rate, Standing, bands_of, standing, standings
from signals.series import FloatArray
from sim.core.spec import MachineSpec, TermSpec

LEADERS, DRAWS = 3, 16
"""Best draws of an effect, and draws about them, that are added to the baseline."""
MOST_GROUPS, MOST_RIVALS = 2, 4
"""Effects of which places are compared, and places of each."""
SIZES_DB = np.arange(-35.0, 26.0, 5.0)
"""By which the added motion is made larger or smaller: the size is free."""
MODEL_DB, FLOOR_DB = 3.0, 1.0
"""Errors of the path and of the pit's form, where impacts stand out, and of any level."""
MOST_OFF = 9.0
"""Of a squared deviation: one resonance that the model has elsewhere must not decide."""
OUT = 1.5
"""Mean square of the deviations upwards from control rates, over all bands of all channels, from which anything is
heard in the test and its point counts. Baselines of four concealed pits 0.1 to 0.7, their tests 0.7 to 9."""
AUDIBLE_DB = 3.0
"""Over the baseline alone, that a draw must reach in one band at the largest size at one point."""
LEAST_BANDS = 3
PER = 1.5
"""Log evidence a unit of half the squared distance. Draws of one place, taken for what was observed, lead the other
place by 2.5 to 14, 6.5 on the mean; concealed pits lie a third to a half as far ahead, as their form is another."""
MOST = 8.0
"""Log evidence that hearing is worth at most."""


@dataclass(frozen=True, kw_only=True)
class Base:
    """A baseline to which is added, at one point, the test over the same floors, how it stands out, and the baseline
    alone."""

    ground: Ground
    heard: ComplexArray
    test: Standing
    alone: Standing

    @property
    def out(self) -> bool:
        """Whether anything is heard in the test."""
        known = self.test.error > 0.0  # bands too narrow for the rate say nothing
        off = np.clip(self.test.level / np.hypot(self.test.error, FLOOR_DB), 0.0, None)
        return bool(np.any(known)) and float(np.mean(off[known] ** 2)) >= OUT


@dataclass(frozen=True, kw_only=True)
class _Task:
    """Effects, several draws of each, at one point; `rates`: of each effect's part."""

    place: Place
    terms: tuple[tuple[TermSpec, ...], ...]
    rates: tuple[Rate, ...]
    base: Base


@dataclass(frozen=True, kw_only=True)
class _Off:
    """Squared distances from the test (draws, sizes), infinite where a machine does not run; which draws are heard."""

    squared: FloatArray
    heard: np.ndarray


def placed_by_hearing(setting: Setting, found: Found, meter: Meter) -> Screen:
    """The screen, in which places of the firmest impacts that share their lines count by how each would be heard."""
    screen = found.screen
    if any(d.baseline is None or d.spectra[1] is None for d in setting.data):
        return screen
    if any(len(bands_of(d.spectra[0].rate_hz)) < LEAST_BANDS for d in setting.data):
        return screen
    for group in twins(found, setting.machine)[:MOST_GROUPS]:
        if beyond_hearing(found.screen, group):
            continue
        rivals = group[:MOST_RIVALS]
        off = distances(setting, found, rivals, meter)
        screen = counted(screen, off) if len(off) == len(rivals) else screen
    if np.argmax(screen.evidence) == np.argmax(found.screen.evidence):
        return screen
    again = of_best(screen, found.views, setting.changes.observed)
    best = screen.names[int(np.argmax(screen.evidence))]
    return replace(again, rest=replace(again.rest, rough=best not in found.led))


def beyond_hearing(screen: Screen, group: Sequence[str]) -> bool:
    """Whether the first of the places is so far ahead of all other effects by what else is known that hearing could
    neither open it nor bring another effect before it."""
    told = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    return told[group[0]] - max(value for name, value in told.items() if name != group[0]) >= MOST + LEAST_EVIDENCE


def counted(screen: Screen, off: Mapping[str, float]) -> Screen:
    """The screen with evidence against places that are farther `off` than the nearest. Whether there are impacts is
    another question: `direct` stays."""
    against = worth(off)
    evidence = screen.evidence - np.array([against.get(n, 0.0) for n in screen.names])
    log = evidence - evidence.max()
    heard = {**screen.heard, **against}
    return replace(screen, evidence=evidence, weights=np.exp(log) / np.exp(log).sum(), heard=heard)


def worth(off: Mapping[str, float]) -> dict[str, float]:
    """Log evidence against each place."""
    return {name: min(MOST, PER * (value - min(off.values()))) for name, value in off.items()}


def twins(found: Found, machine: MachineSpec) -> list[tuple[str, ...]]:
    """Places of one effect that strike at the same lines, likeliest first: of the firmest impacts, then of others."""
    screen = found.screen
    direct = dict(zip(screen.names, map(float, screen.direct), strict=True))
    evidence = dict(zip(screen.names, map(float, screen.evidence), strict=True))
    rolling = [n for n, value in direct.items() if value >= HEARD and kind_of(n) not in ("", "tooth")]
    rolling.sort(key=lambda n: (-round(direct[n], 6), -evidence[n]))
    groups: list[tuple[str, ...]] = []
    for first in rolling:
        grouped = {n for group in groups for n in group}
        if first in grouped:
            continue
        term, own = first.split("@")[0], family_of(machine, first)
        near = [
            n
            for n in rolling
            if n not in grouped and n.split("@")[0] == term and direct[n] > direct[first] - LEAST_EVIDENCE
        ]
        groups.append(tuple(sorted((n for n in near if same(family_of(machine, n), own)), key=lambda n: -evidence[n])))
    return [group for group in groups if len(group) > 1]


def distances(setting: Setting, found: Found, names: Sequence[str], meter: Meter) -> dict[str, float]:
    """Half the squared distance of each effect's nearest draw from what is heard, over the points where anything is;
    without those that cannot run or that nobody would hear."""
    families = [family_of(setting.machine, n) for n in names]
    rng = np.random.default_rng([setting.seed, 31])
    drawn = tuple(tuple(near_draws(own, DRAWS, rng)) for own in leaders(found, names, setting.changes.observed))
    tasks = []
    for p in range(len(setting.data)):
        base, place = base_at(setting, p, families[0]), place_at(setting, p)
        if base.out:
            rates = tuple(rate_of(f, place.point.speed_hz) for f in families)
            tasks.append(_Task(place=place, terms=drawn, rates=rates, base=base))
    points: list[list[_Off]] = list(meter(_heard, tasks))  # type: ignore[arg-type]
    nearest = {n: _nearest([p[k] for p in points]) for k, n in enumerate(names)} if points else {}
    return {name: value for name, value in nearest.items() if np.isfinite(value)}


def leaders(found: Found, names: Sequence[str], observed: FloatArray) -> list[list[TermSpec]]:
    """Of each place of an effect the nearest draws that show anything, as a pit of an outer race that no loaded ball
    meets does not; where none does, what shows at another place, put here; else the nearest."""
    fitted, known = found.fitted, found.known
    own = [seen_draws(fitted, fitted.visible, known, n, observed, LEADERS) for n in names]
    others = [term for terms in own for term in terms][:LEADERS]
    return [
        terms
        or [t.model_copy(update={"site": n.split("@")[1]}) for t in others]
        or best_draws(fitted, known, n, observed, LEADERS)
        for n, terms in zip(names, own, strict=True)
    ]


def _nearest(points: Sequence[_Off]) -> float:
    """The mean over points, as what errs in the model errs at all of them, of the nearest draw that is heard at one."""
    heard = np.any([p.heard for p in points], axis=0)
    squared = np.mean([p.squared for p in points], axis=0)[heard]
    return 0.5 * float(squared.min()) if squared.size else float("inf")


def base_at(setting: Setting, point: int, family: Family) -> Base:
    """At a point, for the lines of a part; there must be a baseline."""
    ground, heard = ground_of(setting, point)
    test, baseline = setting.data[point].spectra
    assert baseline is not None
    return Base(
        ground=ground,
        heard=heard,
        test=standing(ground.bands(heard), ground.seconds, rate_of(family, test.speed_hz)),
        alone=standing(ground.bands(ground.white), ground.seconds, rate_of(family, baseline.speed_hz)),
    )


def _heard(task: _Task) -> list[_Off]:
    """Of each effect."""
    found = []
    for added, rate in zip(task.place.added_by(task.terms), task.rates, strict=True):
        off = [_off(task.base, a, rate) for a in added]
        found.append(_Off(squared=np.array([o for o, _ in off]), heard=np.array([h for _, h in off], dtype=np.bool_)))
    return found


def _off(base: Base, motion: FloatArray | None, rate: Rate) -> tuple[FloatArray, bool]:
    """Squared distance of what would be heard from the test, (sizes,), and whether anything would at any size: a pit
    of the outer race that no loaded ball meets says nothing of its bearing."""
    if motion is None:
        return np.full(SIZES_DB.size, np.inf), False
    ground = base.ground
    sizes = 10.0 ** (SIZES_DB / 20.0)
    louder = ground.white[:, None] + sizes[:, None] * ground.added(motion)[:, None]  # (C, sizes, n // 2 + 1)
    levels = [one.level for one in standings(ground.bands(louder), ground.seconds, rate)]
    loudest = max(float((level - np.maximum(base.alone.level, 0.0)).max()) for level in levels)
    return np.array([apart(base.test, level) for level in levels]), loudest >= AUDIBLE_DB


def apart(test: Standing, level: FloatArray) -> float:
    """Squared distance of levels (C, bands) from the test's."""
    out = 1.0 - 10.0 ** (-np.maximum(np.maximum(level, test.level), 0.0) / 10.0)
    squared = (test.level - level) ** 2 / (test.error**2 + FLOOR_DB**2 + (MODEL_DB * out) ** 2)
    return float(np.minimum(squared, MOST_OFF).sum())
