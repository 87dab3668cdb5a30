"""Causes of lines, shown by taking effects away: the same machine simulated without them, all else equal.

A *coalition* is the set of effects left acting; what it makes of a line is the line's power. Shares divide the power
of the line in the whole machine among the effects and the machine without any of them, so they add up to one.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import factorial
from typing import Literal

import numpy as np

from signals.floor import Floor
from signals.labels.types import LabelledPeak
from signals.series import BoolArray, FloatArray
from signals.spectra.types import Spectrum
from signals.windows import transform
from sim.core.lines import Order

Coalition = frozenset[int]
"""Indices of the effects that act."""
Rule = Literal["shapley_power", "leave_one_out_power"]
MAX_SHAPLEY = 3
"""Effects up to which every coalition is run (eight runs); beyond, each effect is taken away by itself."""
DEEPEST_DB = 120.0
"""What is reported when a line vanishes altogether: below, there is only rounding."""
_TERM = re.compile(r"([+-]?\d+(?:/\d+)?)\*([A-Za-z_]+\d*)")


@dataclass(frozen=True, kw_only=True)
class Cause:
    """What a line loses when an effect is taken away.

    `removed_db` = 20 log10(amplitude with / amplitude without): 0 nothing changes, negative the line grows.
    `at_least`: the line is lost in what remains, so more may have gone away. `share` is the effect's part of the line's
    power, 0..1. `counterfactual` says what stands for "without".
    """

    term: str
    site: str
    counterfactual: str
    removed_db: float
    at_least: bool
    share: float


@dataclass(frozen=True, kw_only=True)
class Reading:
    """Amplitudes of lines in a spectrum, unit of the spectrum, and whether each is no more than its noise; (lines,)."""

    amplitude: FloatArray
    lost: BoolArray


def orders_of(label: str) -> tuple[tuple[str, Order], ...]:
    """Bases and multiples of a label: `1*f_m-1*f_r1` gives (f_m, 1), (f_r1, -1), `1/2*f_r1` (f_r1, Fraction(1, 2))."""
    return tuple((base, Fraction(n) if "/" in n else int(n)) for n, base in _TERM.findall(label))


def places_hz(peaks: Sequence[LabelledPeak], bases_hz: Mapping[str, float]) -> FloatArray:
    """Where the labels' lines lie for other base frequencies, Hz, shape (lines,)."""
    return np.array(
        [abs(sum(float(n) * bases_hz[base] for base, n in orders_of(p.label))) for p in peaks], dtype=np.float64
    )


def read_lines(spectrum: Spectrum, frequency_hz: FloatArray, floor: Floor) -> Reading:
    """Amplitudes at given frequencies, whether or not a peak is there: the nearest bin over the window's transform."""
    position = frequency_hz / spectrum.resolution_hz
    bins = np.clip(np.rint(position), 1, spectrum.values.size - 1).astype(np.int64)
    shift = np.clip(position - bins, -0.5, 0.5)
    amplitude = spectrum.values[bins] / transform(spectrum.window, shift)
    return Reading(
        amplitude=np.asarray(amplitude, dtype=np.float64),
        lost=np.asarray(spectrum.values[bins] <= floor.threshold[bins]),
    )


def removed_db(present: FloatArray, without: FloatArray) -> FloatArray:
    """How much of each line goes away, dB, within +-`DEEPEST_DB`; shapes (lines,)."""
    least = 10 ** (-DEEPEST_DB / 20)
    ratio = np.maximum(without, present * least) / present
    return np.asarray(np.maximum(-20 * np.log10(ratio), -DEEPEST_DB), dtype=np.float64)


def coalitions(effects: int) -> tuple[Rule, tuple[Coalition, ...]]:
    """Rule of the shares, and the coalitions to run beside the whole one: all, or each effect and all missing."""
    everyone = frozenset(range(effects))
    if effects <= MAX_SHAPLEY:
        sizes = range(effects - 1, -1, -1)
        return "shapley_power", tuple(frozenset(c) for size in sizes for c in combinations(sorted(everyone), size))
    return "leave_one_out_power", (*(everyone - {i} for i in sorted(everyone)), frozenset())


def shares(power: Mapping[Coalition, FloatArray], effects: int, rule: Rule) -> FloatArray:
    """Shares of the effects and, in the last row, of the machine without them; shape (effects + 1, lines).

    `shapley_power`: L. S. Shapley's value (A value for n-person games, Contributions to the Theory of Games II, 1953,
    307-317) with the line's power as the worth of a coalition: the mean, over all orders of adding the effects, of
    what each adds. `leave_one_out_power`: what the line loses without each effect. Effects whose value is negative have
    no share. By Shapley that is what weakens a line on the mean over the orders: an effect without which the line
    grows may have a share all the same, for what it adds where others are missing.
    Rows are scaled to add up to one; a line without power has no shares.
    """
    everyone = frozenset(range(effects))
    base = np.maximum(power[frozenset()], 0.0)
    if rule == "shapley_power":
        parts = [_shapley(power, everyone, i) for i in range(effects)]
    else:
        parts = [power[everyone] - power[everyone - {i}] for i in range(effects)]
    rows = np.maximum(np.array([*parts, base]), 0.0)
    total = rows.sum(axis=0)
    return np.asarray(np.divide(rows, total, out=np.zeros_like(rows), where=total > 0), dtype=np.float64)


def _shapley(power: Mapping[Coalition, FloatArray], everyone: Coalition, effect: int) -> FloatArray:
    """Mean contribution of one effect over all orders of joining."""
    n = len(everyone)
    total = np.zeros_like(power[everyone])
    others = sorted(everyone - {effect})
    for size in range(n):
        weight = factorial(size) * factorial(n - size - 1) / factorial(n)
        for chosen in combinations(others, size):
            before = frozenset(chosen)
            total = total + weight * (power[before | {effect}] - power[before])
    return total


def split(base: FloatArray, lacking: Mapping[Coalition, FloatArray], count: int) -> FloatArray:
    """Parts 0..1 of the base machine's power that each of its own excitations explains, and in the last row the rest.

    `base` (lines,) is the base machine's power, `lacking` that of the machine without the excitations of a set: every
    single one, and pairs of them. A single excitation explains what goes away with it; one of a pair its Shapley value
    in the game of the two, so that two that each suffice, or that weaken each other, share what goes away with both:
    half of what it takes from the two together and half of what it makes alone. The stronger of two that work against
    each other so has nearly all, though the line may grow without it.
    Together they explain no more than all: beyond that they are scaled. Shape (count + 1, lines).
    """
    lost = [np.maximum(_explained(base, lacking, i), 0.0) for i in range(count)]
    rows = np.array(lost) if lost else np.zeros((0, base.size))
    total = np.maximum(rows.sum(axis=0), base)
    parts = np.divide(rows, total, out=np.zeros_like(rows), where=total > 0)
    return np.vstack([parts, np.maximum(1 - parts.sum(axis=0), 0.0)])


def _explained(base: FloatArray, lacking: Mapping[Coalition, FloatArray], i: int) -> FloatArray:
    """What goes away with excitation `i`: by itself, or as one of its pairs, their mean."""
    alone = base - lacking[frozenset({i})]
    pairs = [pair for pair in lacking if i in pair and len(pair) > 1]
    if not pairs:
        return np.asarray(alone)
    found = [0.5 * (alone + lacking[pair - {i}] - lacking[pair]) for pair in pairs]
    return np.asarray(np.mean(found, axis=0), dtype=np.float64)
