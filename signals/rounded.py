"""Time stamps on a regular grid but for how they are written: decimals, significant digits, single precision."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import scipy

from signals.series import FloatArray
from signals.timebase import JITTER_SHARE

MOST_DIGITS = 12
COARSE_STEPS = 50
"""Stamps rounded to more than this many steps say nothing about their regularity."""
SINGLE_SHARE = 0.1
"""Of the spacing of single precision, within which a stamp is one of its numbers: eight digits print them to 0.08."""
DIGITS_OF_SINGLE = (7, 8, 9)
"""Digits with which numbers of single precision are printed."""
LEAST_SINGLE = 8
"""Stamps that must lie on numbers of single precision by more than the decimals they are printed with."""
SLACK = 1.02
"""Of half a rounding: what was computed before it was rounded."""
COMPUTED = 4
"""Spacings of double precision by which a stamp that was computed is off."""
FEW, LEAST_ALIKE = 2, 20
"""Gaps that are no rounding if none of the other steps, of which there must be so many, shows any."""
ROUNDS = 60
BLOCK = 1000
"""Stamps over which a clock that drifts is still one of an even rate: 1e-4 in 1000 steps is 0.01 of a step."""
MOST_DRIFT = 1e-4
"""Share by which the rate of a clock may drift within a recording: crystals do by 1e-5, cheap ones by 5e-5."""
FINE_SHARE = 0.1
"""Of a step, up to which stamps may be rounded for it."""


@dataclass(frozen=True, kw_only=True)
class Rounding:
    """How stamps are written: `steps`, shape (n,), are the distances of what can be written near each."""

    said: str
    steps: FloatArray


@dataclass(frozen=True, kw_only=True)
class Grid:
    """The grid that stamps were rounded from: `step`, fitted by all, and `rounding` at its largest, in their unit."""

    step: float
    rounding: float
    said: str
    "How they are written, in words."


def regular_grid(stamps: FloatArray) -> Grid | None:
    """The grid of stamps, shape (n,), that lie on one but for their rounding; None where no way of writing explains
    them, not with `JITTER_SHARE` of a step besides."""
    if np.any(np.diff(stamps) < 0) or _few_breaks(stamps):
        return None
    ways = tuple(roundings(stamps))
    for share in (JITTER_SHARE / 10, JITTER_SHARE):
        for way in ways:
            line = _line(stamps, _halves(stamps, way, share))
            if line is not None:
                return Grid(step=line[1] / (stamps.size - 1), rounding=float(np.max(way.steps)), said=way.said)
    return None


def drifting_grid(stamps: FloatArray) -> Grid | None:
    """The grid of stamps, shape (n,), of a clock whose rate drifts by `MOST_DRIFT` at most, finely rounded; None where
    they are of none.

    Blocks that share a stamp with the next lie each on a grid of its own. A sample that was lost is a whole step, far
    beyond what the straight line of a block leaves; only so fine a rounding shows it.
    """
    mean = float(stamps[-1] - stamps[0]) / (stamps.size - 1)
    if stamps.size < 2 * BLOCK or not mean > 0 or np.any(np.diff(stamps) < 0):
        return None
    edges = [*range(0, stamps.size - BLOCK, BLOCK), stamps.size - 1]
    for way in roundings(stamps):
        rounding = float(np.max(way.steps))
        if rounding > FINE_SHARE * mean:
            continue
        near = MOST_DRIFT + 2 * rounding / (BLOCK * mean)
        halves = _halves(stamps, way, JITTER_SHARE)
        if all(_steady(stamps[a : b + 1], halves[a : b + 1], mean, near) for a, b in pairwise(edges)):
            return Grid(step=mean, rounding=rounding, said=way.said)
    return None


def _steady(stamps: FloatArray, halves: FloatArray, mean: float, near: float) -> bool:
    """Whether stamps (n,) lie on a grid whose step is the mean one but for the share `near`."""
    line = _line(stamps, halves)
    return line is not None and abs(line[1] / (stamps.size - 1) / mean - 1.0) <= near


def _few_breaks(stamps: FloatArray) -> bool:
    """Whether all steps of stamps (n,) are alike but for one or two gaps or repeats: these are no rounding, which a
    step that is a multiple of what can be written does not show."""
    steps = np.diff(stamps)
    usual = float(np.median(steps))
    other = np.abs(steps - usual) > JITTER_SHARE * usual
    broken = np.abs(steps - usual) > usual / 2
    return bool(usual > 0 and steps.size >= LEAST_ALIKE and 0 < np.sum(other) <= FEW and np.any(broken))


def first_off_grid(stamps: FloatArray) -> int | None:
    """The first stamp of shape (n,) by which no grid fits, by the way of writing that carries furthest; None: none."""
    found = [_first_off(stamps, _halves(stamps, way, JITTER_SHARE)) for way in roundings(stamps)]
    places = [place for place in found if place is not None]
    back = (np.flatnonzero(np.diff(stamps) < 0) + 1).tolist()
    return min([max(places), *back[:1]]) if len(places) == len(found) else next(iter(back), None)


def roundings(stamps: FloatArray) -> Iterator[Rounding]:
    """Ways of writing in which each stamp, shape (n,), would stand as it does, the finest first."""
    double = COMPUTED * np.spacing(np.abs(stamps))
    decimals = resolution(stamps)
    plain = np.maximum(double, decimals)
    yield Rounding(said=f"multiples of {decimals:g}" if decimals else "double precision", steps=plain)
    single = np.spacing(np.abs(stamps).astype(np.float32)).astype(np.float64)
    cast = stamps.astype(np.float32)
    off = np.abs(cast.astype(np.float64) - stamps)
    kept = np.unique(cast).size == np.unique(stamps).size  # seconds since 1970 all become one number
    telling = SINGLE_SHARE * single > 0.51 * decimals
    if kept and np.all(off <= np.maximum(SINGLE_SHARE * single, 0.51 * decimals)) and np.sum(telling) >= LEAST_SINGLE:
        yield Rounding(said="single precision", steps=np.maximum(single, decimals))
    digits = significant_digits(stamps)
    if digits is None:
        return
    last = np.maximum(double, _last_digit(stamps, digits))
    yield Rounding(said=f"{digits} significant digits", steps=last)
    if digits in DIGITS_OF_SINGLE:
        yield Rounding(said=f"{digits} significant digits of single precision", steps=last + single)


def resolution(stamps: FloatArray) -> float:
    """The step to which stamps were rounded when they were printed, in their own unit; 0 when none is seen."""
    scale = float(np.max(np.abs(stamps), initial=0.0))
    for digits in range(MOST_DIGITS):
        if np.allclose(np.round(stamps, digits), stamps, rtol=0, atol=4 * np.finfo(np.float64).eps * scale):
            return float(10.0**-digits)
    return 0.0


def significant_digits(stamps: FloatArray) -> int | None:
    """The digits of each stamp, the first that is not 0 counted as one; None where there are `MOST_DIGITS` or more."""
    for digits in range(1, MOST_DIGITS):
        last = _last_digit(stamps, digits)
        if np.all(np.abs(np.round(stamps / last) * last - stamps) <= 4 * np.spacing(np.abs(stamps))):
            return digits
    return None


def _last_digit(stamps: FloatArray, digits: int) -> FloatArray:
    """The value of the last of `digits` significant digits of each stamp."""
    size = np.abs(stamps)
    least = float(np.min(size, where=size > 0, initial=np.inf))
    exponent = np.floor(np.log10(np.where(size > 0, size, least if np.isfinite(least) else 1.0)) + 1e-12)
    return np.asarray(10.0 ** (exponent + 1 - digits), dtype=np.float64)


def _halves(stamps: FloatArray, way: Rounding, share: float) -> FloatArray:
    """How far each stamp may lie from its grid, in its unit: half a rounding and that share of a step."""
    step = float(stamps[-1] - stamps[0]) / (stamps.size - 1)
    return np.minimum(SLACK * way.steps / 2, COARSE_STEPS * step) + share * step


def _first_off(stamps: FloatArray, halves: FloatArray) -> int | None:
    if _line(stamps, halves) is not None:
        return None
    fits, off = 2, stamps.size
    while off - fits > 1:
        middle = (fits + off) // 2
        if _line(stamps[:middle], halves[:middle]) is None:
            off = middle
        else:
            fits = middle
    return off - 1


def _line(stamps: FloatArray, halves: FloatArray) -> tuple[float, float] | None:
    """Start and length of the straight line within `halves` of stamps (n,), fitted by all; None where there is none.

    Least squares weighted by the halves; where its largest deviation is too large the least largest one is looked for,
    by linear programming over the stamps that bound it.
    """
    along = np.linspace(0.0, 1.0, stamps.size)
    from_first = stamps - stamps[0]
    start, length = _least_squares(along, from_first, halves)
    bounding: set[int] = {0, stamps.size - 1}
    left = (from_first - start - length * along) / halves
    unit = float(np.min(halves))
    more, least = (0.0, 0.0), 0.0
    for _ in range(ROUNDS):
        now = left - (more[0] + more[1] * along) / halves
        worst = {int(np.argmax(now)), int(np.argmin(now))}
        if float(np.max(np.abs(now))) <= 1:
            return start + more[0], length + more[1]
        if least > 1 or worst <= bounding:
            return None
        bounding |= worst
        these = sorted(bounding)
        rows = np.stack((np.ones(len(these)), along[these]), axis=1) * (unit / halves[these])[:, None]
        (first, second), least = _least_largest(rows, left[these])
        more = first * unit, second * unit
    return None


def _least_squares(along: FloatArray, values: FloatArray, halves: FloatArray) -> tuple[float, float]:
    """Start and length of the line through values (n,) at `along` (n,), weighted by the squares of 1 / `halves`."""
    weights = (float(np.min(halves)) / halves) ** 2
    weights /= np.sum(weights)
    middle, mean = float(weights @ along), float(weights @ values)
    length = float(weights @ ((along - middle) * (values - mean))) / float(weights @ (along - middle) ** 2)
    return mean - length * middle, length


def _least_largest(rows: FloatArray, values: FloatArray) -> tuple[tuple[float, float], float]:
    """The two factors of `rows` (n, 2) whose sum misses `values` (n,) by the least largest amount, and that amount."""
    ones = np.ones((values.size, 1))
    both = np.block([[rows, -ones], [-rows, -ones]])
    found = scipy.optimize.linprog(
        [0.0, 0.0, 1.0], A_ub=both, b_ub=np.concatenate((values, -values)), bounds=[(None, None)] * 2 + [(0, None)]
    )
    if found.x is None:
        return (0.0, 0.0), float("inf")
    first, second, most = (float(v) for v in found.x)
    return (first, second), most
