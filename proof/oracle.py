"""What could be seen at all: bounds from below and above, made with what no engine can know.

Both know the concealed machine's numbers and what each of them changes when it drifts, the one effect to look for with
its place and size, the path and noise of every sensor, and the angle of the shaft at every moment. Features are levels
in narrow bands of order.

**From below** a classifier is taught by tests of that very machine with and without the effect, each with a drift,
speed, slips and noise of its own, and has to tell others apart: Fisher's linear discriminant (R. A. Fisher, Ann.
Eugenics 7 (1936) 179-188), its covariance shrunk towards its diagonal. More tests would teach it more.

**From above** nothing but drift, taken as linear, and the sensors' noise is in the way: no speeds, slips or cages that
differ from test to test. The distance is then that of the best discriminant itself, and no test need be told.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.stats import norm

from proof.case import DURATION_S, MACHINE, OTHER_TEST, another_test, instruments_of, with_noise
from proof.each import of_each
from proof.machine import DRIFT, SPREAD, FloatArray, Hidden, hidden_machine
from proof.plan import Case, Hiding

TESTS = 15
"""Of each kind."""
FOLDS = 5
NOISES = 20
"""Draws of the sensors' noise on one test, from which its deviation is taken."""
DRAWS = 400
"""Of the tests, for the interval of the distance."""
WIDTH = 0.006
"""Of a band, as a share of its order: nearest sidebands of the first mesh harmonic are 0.015 apart."""
LEAST_BINS = 2
SHORTEST = 0.985
"""Turns that are looked at in all tests of a speed, as a share of what the stated one makes."""
SHRUNK = 0.3
"""Weight of the diagonal in the covariance."""
LEAST_DB = 0.02
"""Deviation of a level below which none is taken."""
DEVIATION = DRIFT * SPREAD / np.sqrt(3.0)
"""By which every number drifts, as a share (`Hidden.drifted`)."""
FALSE_ALARMS = 0.01
HALF = float(norm.isf(FALSE_ALARMS))
"""Distance at which half of the tests with the effect are told, if all spread normally."""


@dataclass(frozen=True, kw_only=True)
class Seen:
    """`distance`: of tests with the effect from tests without it, in deviations of either, along the discriminant of
    other such tests, with its 90 % interval over the tests; `most`: what it would be were drift and noise all."""

    distance: float
    low: float
    high: float
    most: float


def seen(case: Case, tests: int = TESTS) -> Seen:
    """Of a case with effects: as many tests of its machine with them, and as many without."""
    base, (ways, noises) = hidden_machine(case.rng(MACHINE)), instruments_of(case)
    turns = [int(SHORTEST * hz * DURATION_S) for hz in case.speeds_hz]

    def features(test: Sequence[FloatArray], *noise: int) -> FloatArray:
        """Levels of all tests of one time, one after the other."""
        drawn = with_noise(case, test, noises, *noise)
        return np.concatenate([levels(one, count) for one, count in zip(drawn, turns, strict=True)])

    def heard(number: int, hidden: Hidden, effects: tuple[Hiding, ...] = ()) -> FloatArray:
        return features(another_test(case, number, hidden, effects, ways), number, 1)

    drift = drifts(base, partial(heard, 0))
    quiet = another_test(case, 0, base, (), ways)
    noise = np.var([features(quiet, 0, 2, k) for k in range(NOISES)], axis=0, ddof=1)
    later = [base.drifted(case.rng(OTHER_TEST, number)) for number in range(1, tests + 1)]
    without, with_it = (
        np.array([heard(n, hidden, effects) for n, hidden in enumerate(later, 1)]) for effects in ((), case.effects)
    )
    moved = np.array([_deviations(base, hidden) for hidden in later]) @ drift
    distance, low, high = separation(without, with_it, drift, moved)
    most = farthest((with_it - without).mean(axis=0), drift, noise)
    return Seen(distance=distance, low=low, high=high, most=most)


def drifts(base: Hidden, heard: Callable[[Hidden], FloatArray]) -> FloatArray:
    """What one deviation of every number that drifts changes, (numbers, F) dB; all else being equal."""
    rest = heard(base)
    every = [{**base.factors, name: value * (1.0 + DEVIATION)} for name, value in base.factors.items()]
    return np.array([heard(replace(base, factors=factors)) - rest for factors in every])


def _deviations(base: Hidden, later: Hidden) -> FloatArray:
    """How many deviations every number has drifted, (numbers,)."""
    return np.array([(later.factors[n] / value - 1.0) / DEVIATION for n, value in base.factors.items()])


def levels(heard: FloatArray, turns: int) -> FloatArray:
    """Decibels (channels * bands,) over order, of signals (channels, n) below the drive shaft's angle, rad, in so many
    turns of it: the bands are of the same orders whatever the speed."""
    angle = heard[0] / (2.0 * np.pi)
    even = angle[0] + turns * np.arange(angle.size) / angle.size
    window = np.hanning(angle.size)
    found = []
    for row in heard[1:]:
        power = np.abs(np.fft.rfft(CubicSpline(angle, row - row.mean())(even) * window)) ** 2
        edges = band_edges(power.size)
        found.append(10.0 * np.log10(np.add.reduceat(power, edges[:-1]) / np.diff(edges) + 1e-300))
    return np.concatenate(found)


def band_edges(bins: int) -> np.ndarray:
    """First bins of the bands, and where the last one ends; the lowest bins, which the window joins, are left out."""
    edges = [LEAST_BINS]
    while edges[-1] < bins:
        edges.append(edges[-1] + max(LEAST_BINS, round(WIDTH * edges[-1])))
    return np.array(edges[:-1])


def separation(
    without: FloatArray, with_it: FloatArray, drift: FloatArray, moved: FloatArray
) -> tuple[float, float, float]:
    """Distance of two sets of rows (n, F), one by one at the same times, along discriminants of the other rows, over
    their pooled deviation, and its 90 % interval when the tests are drawn again; `moved` (n, F): what drift has changed
    in each by `drift` (numbers, F)."""
    told = np.zeros((2, len(without)))
    for fold in range(FOLDS):
        out = np.arange(len(without)) % FOLDS == fold
        rest = (without - moved)[~out]
        spread = SHRUNK * np.maximum(rest.var(axis=0), LEAST_DB**2)
        rows = np.concatenate([drift, (rest - rest.mean(axis=0)) * np.sqrt((1.0 - SHRUNK) / len(rest))])
        along = discriminant((with_it - without)[~out].mean(axis=0), rows, spread)
        middle = without[~out].mean(axis=0)
        told[0, out], told[1, out] = (without[out] - middle) @ along, (with_it[out] - middle) @ along
    draws = np.random.default_rng(len(without)).integers(0, len(without), (DRAWS, len(without)))
    low, high = np.quantile([_apart(told[:, draw]) for draw in draws], (0.05, 0.95))
    return _apart(told), float(low), float(high)


def _apart(told: FloatArray) -> float:
    spread = np.sqrt(0.5 * (np.var(told[0], ddof=1) + np.var(told[1], ddof=1)))
    return float((told[1].mean() - told[0].mean()) / max(float(spread), 1e-300))


def discriminant(apart: FloatArray, rows: FloatArray, diagonal: FloatArray) -> FloatArray:
    """Direction (F,) in which `apart` (F,) shows most over a covariance rows^T rows + diag(diagonal), rows (n, F); of
    unit product with `apart`. By Woodbury's identity the matrix inverted is as large as there are rows."""
    along = _solved(apart, rows, diagonal)
    return np.asarray(along / max(float(apart @ along), 1e-300))


def farthest(apart: FloatArray, drift: FloatArray, noise: FloatArray) -> float:
    """Mahalanobis distance of a change (F,) over drift (numbers, F, one deviation each) and noise of variance (F,)."""
    return float(np.sqrt(max(float(apart @ _solved(apart, drift, np.maximum(noise, 1e-12))), 0.0)))


def _solved(apart: FloatArray, rows: FloatArray, diagonal: FloatArray) -> FloatArray:
    scaled = rows / diagonal
    inner = np.eye(len(rows)) + scaled @ rows.T
    return np.asarray(apart / diagonal - scaled.T @ np.linalg.solve(inner, scaled @ apart))


def measure(cases: Sequence[Case], store: Path, jobs: int) -> dict[str, Seen]:
    """Of all cases with effects; what is stored is not made again."""
    found = stored(store)
    todo = [c for c in cases if c.effects and c.name not in found]
    return of_each(todo, seen, found, store, jobs)


def store_of(results: Path, split: str) -> Path:
    """Where a split's are kept."""
    return results / f"oracle-{split}.json"


def stored(store: Path) -> dict[str, Seen]:
    """By case; empty where nothing is stored."""
    if not store.exists():
        return {}
    document: Mapping[str, Mapping[str, float]] = json.loads(store.read_text(encoding="utf-8"))
    return {name: Seen(**values) for name, values in document.items()}
