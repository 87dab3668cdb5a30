"""What could be seen at all: a classifier taught by the concealed machine itself, for the concealed effect alone.

It knows what no engine can: the machine's numbers but for their drift, the effect with its place and size, the path of
every sensor, the colour of its noise, the speed at every moment. It is shown tests of that machine with and without the
effect, each with a drift, speed and noise of its own, and then has to tell others apart. What it cannot tell is not to
be seen in such features by anyone.

Features are levels in narrow bands of order. They are told apart by Fisher's linear discriminant (R. A. Fisher, Ann.
Eugenics 7 (1936) 179-188), its covariance shrunk towards its diagonal, as there are more features than tests.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import partial
from multiprocessing import get_context
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.stats import norm
from tqdm import tqdm

from proof.case import MACHINE, OTHER_TEST, another_test, instruments_of
from proof.machine import DRIFT, SPREAD, FloatArray, Hidden, hidden_machine
from proof.plan import Case, Hiding

TESTS = 15
"""Of each kind."""
FOLDS = 5
WIDTH = 0.006
"""Of a band, as a share of its order: nearest sidebands of the first mesh harmonic are 0.015 apart."""
LEAST_BINS = 2
SHRUNK = 0.3
"""Weight of the diagonal in the covariance."""
LEAST_DB = 0.02
"""Deviation of a level below which none is taken."""
DEVIATION = DRIFT * SPREAD / np.sqrt(3.0)
"""By which every number drifts, as a share (`Hidden.drifted`)."""
FALSE_ALARMS = 0.01


@dataclass(frozen=True, kw_only=True)
class Seen:
    """`distance`: of tests with the effect from tests without it, in deviations of either, along the discriminant of
    other such tests. `power`: share that would be told at one false alarm in a hundred, if both spread normally."""

    distance: float
    power: float


def seen(case: Case, tests: int = TESTS) -> Seen:
    """Of a case with effects: as many tests of its machine with them, and as many without."""
    base, instruments = hidden_machine(case.rng(MACHINE)), instruments_of(case)

    def heard(number: int, hidden: Hidden, effects: tuple[Hiding, ...] = ()) -> FloatArray:
        """Levels of all tests of one time, one after the other."""
        return np.concatenate([levels(one) for one in another_test(case, number, hidden, effects, instruments)])

    drift = drifts(base, partial(heard, 0))
    later = [base.drifted(case.rng(OTHER_TEST, number)) for number in range(1, tests + 1)]
    without, with_it = (
        np.array([heard(n, hidden, effects) for n, hidden in enumerate(later, 1)]) for effects in ((), case.effects)
    )
    moved = np.array([_deviations(base, hidden) for hidden in later]) @ drift
    distance = separation(without, with_it, drift, moved)
    return Seen(distance=distance, power=float(norm.cdf(distance - norm.isf(FALSE_ALARMS))))


def drifts(base: Hidden, heard: Callable[[Hidden], FloatArray]) -> FloatArray:
    """What one deviation of every number that drifts changes, (numbers, F) dB; all else being equal."""
    rest = heard(base)
    every = [{**base.factors, name: value * (1.0 + DEVIATION)} for name, value in base.factors.items()]
    return np.array([heard(replace(base, factors=factors)) - rest for factors in every])


def _deviations(base: Hidden, later: Hidden) -> FloatArray:
    """How many deviations every number has drifted, (numbers,)."""
    return np.array([(later.factors[n] / value - 1.0) / DEVIATION for n, value in base.factors.items()])


def levels(heard: FloatArray) -> FloatArray:
    """Decibels (channels * bands,) over order, of signals (channels, n) below the drive shaft's angle, rad."""
    turns = heard[0] / (2.0 * np.pi)
    even = np.linspace(turns[0], turns[-1], turns.size)
    window = np.hanning(turns.size)
    found = []
    for row in heard[1:]:
        power = np.abs(np.fft.rfft(CubicSpline(turns, row - row.mean())(even) * window)) ** 2
        edges = band_edges(power.size)
        found.append(10.0 * np.log10(np.add.reduceat(power, edges[:-1]) / np.diff(edges) + 1e-300))
    return np.concatenate(found)


def band_edges(bins: int) -> np.ndarray:
    """First bins of the bands, and where the last one ends; the lowest bins, which the window joins, are left out."""
    edges = [LEAST_BINS]
    while edges[-1] < bins:
        edges.append(edges[-1] + max(LEAST_BINS, round(WIDTH * edges[-1])))
    return np.array(edges[:-1])


def separation(without: FloatArray, with_it: FloatArray, drift: FloatArray, moved: FloatArray) -> float:
    """Distance of two sets of rows (n, F), one by one at the same times, along discriminants of the other rows, over
    their pooled deviation; `moved` (n, F): what drift has changed in each by `drift` (numbers, F)."""
    told: tuple[list[float], list[float]] = ([], [])
    for fold in range(FOLDS):
        out = np.arange(len(without)) % FOLDS == fold
        along = discriminant((with_it - without)[~out].mean(axis=0), (without - moved)[~out], drift)
        middle = without[~out].mean(axis=0)
        for kind, rows in zip(told, (without, with_it), strict=True):
            kind += list((rows[out] - middle) @ along)
    spread = np.sqrt(0.5 * (np.var(told[0], ddof=1) + np.var(told[1], ddof=1)))
    return float((np.mean(told[1]) - np.mean(told[0])) / max(float(spread), 1e-300))


def discriminant(apart: FloatArray, rest: FloatArray, drift: FloatArray) -> FloatArray:
    """Direction (F,) in which `apart` (F,) shows most over drift (numbers, F, one deviation each) and what else differs
    from test to test, `rest` (n, F); of unit product with `apart`.

    (J^T J + (1 - d) X^T X / n + d D)^-1 m by Woodbury's identity: the matrix inverted is as large as there are rows.
    """
    own = rest - rest.mean(axis=0)
    diagonal = SHRUNK * np.maximum(own.var(axis=0), LEAST_DB**2)
    rows = np.concatenate([drift, own * np.sqrt((1.0 - SHRUNK) / len(own))])
    scaled = rows / diagonal
    along = apart / diagonal - scaled.T @ np.linalg.solve(np.eye(len(rows)) + scaled @ rows.T, scaled @ apart)
    return np.asarray(along / max(float(apart @ along), 1e-300))


def measure(cases: Sequence[Case], store: Path, jobs: int) -> dict[str, Seen]:
    """Of all cases with effects; what is stored is not made again."""
    found = stored(store)
    todo = [c for c in cases if c.effects and c.name not in found]
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        for case, one in zip(todo, tqdm(pool.map(seen, todo), total=len(todo), desc="oracle"), strict=True):
            found[case.name] = one
            text = json.dumps({name: asdict(v) for name, v in sorted(found.items())}, indent=1)
            store.write_text(text + "\n", encoding="utf-8")
    return found


def store_of(results: Path, split: str) -> Path:
    """Where a split's are kept."""
    return results / f"oracle-{split}.json"


def stored(store: Path) -> dict[str, Seen]:
    """By case; empty where nothing is stored."""
    if not store.exists():
        return {}
    document: Mapping[str, Mapping[str, float]] = json.loads(store.read_text(encoding="utf-8"))
    return {name: Seen(**values) for name, values in document.items()}
