"""What a channel's strong lines did: a unit or a gain multiplies them as it does the noise, added noise leaves them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.gate.units import UNIT_RATIOS, possible
from reconcile.speed.excess import line_excess
from signals.series import FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum

STRONG = 100.0
"""Power of a line over that of the noise in its bin."""
MOST_LINES = 8
REACH = 0.03
"""Of its frequency, by which a line may have moved between records of one speed."""
REACH_BINS = 3
LEAST_GAIN_DB = 10.0
"""From which on lines are asked: the load changes them by less."""
SHARE = 0.5
"""Of a gain, that lines must have risen by."""
LEAST_STAYED, KEPT_DB = 3, 1.5
"""Strong lines of a channel that together deny any gain; by how much the bands of a channel that tells of the load may
have changed."""
LEAST_LINES = 5
"""Of a channel, over all pairs, that say what it did."""
OFF_DB, SCATTER_DB = 4.0, 4.0
"""By which the median of a channel's lines may miss a unit's ratio, and half of them scatter: of 160 channels of the
proof's cases, with faults of all kinds, the lines of none moved by 16 to 24 dB at two of three sensors."""
FAR_DB = 12.0
"""By which they miss it that are another channel's."""
FLOOR_SHARE = 25.0
"""Percentile of a channel's bands that stands for its floor: in the proof's cases (split `next`, all tests scaled by
9.8 either way) it is within 1.7 dB of the ratio on every channel whose unit only its lines tell."""
ALIKE = 2.0 / 3.0
"""Share of the channels that must agree, two at least: a fault may drown or raise the lines of one."""


@dataclass(frozen=True, kw_only=True)
class StrongLines:
    """The strongest lines of a baseline, (lines,): frequency, growth, and that of the noise under each."""

    hz: FloatArray
    change_db: FloatArray
    floor_db: FloatArray


def line_changes(test: Series, baseline: Series) -> FloatArray:
    """Growth, dB, of the baseline's strongest lines, (lines,): of the largest amplitude near each, so at least."""
    return strong_lines(test, baseline).change_db


def strong_lines(test: Series, baseline: Series) -> StrongLines:
    """The same with where they are and what the noise did there."""
    (excess, step), (excess_now, step_now) = line_excess(baseline), line_excess(test)
    before, after = amplitude_spectrum(baseline).values, amplitude_spectrum(test)
    tiny = np.finfo(np.float64).tiny
    wider = 10 * float(np.log10(step_now / step))  # of bins, which hold as much more noise
    found: list[tuple[float, float, float]] = []
    left = excess.copy()
    while len(found) < MOST_LINES and left.max(initial=0.0) >= STRONG:
        top = int(np.argmax(left))
        reach = REACH * top + REACH_BINS
        left[max(0, int(top - reach)) : int(top + reach) + 1] = 0.0
        hz, width = top * step, REACH * top * step
        low = int((hz - width) / after.resolution_hz) - REACH_BINS
        near = after.values[max(1, low) : int((hz + width) / after.resolution_hz) + REACH_BINS + 1]
        if near.size:
            now = max(1, low) + int(np.argmax(near))
            change = 20 * float(np.log10((np.max(near) + tiny) / (before[top] + tiny)))
            over = 10 * float(np.log10((excess_now[min(now, excess_now.size - 1)] + tiny) / excess[top]))
            found.append((hz, change, change - over - wider))
    rows = np.array(found).reshape(-1, 3)
    return StrongLines(hz=rows[:, 0], change_db=rows[:, 1], floor_db=rows[:, 2])


def denied(gain_db: float, changes: FloatArray) -> bool:
    """Whether lines stayed so far behind a gain that something added noise instead. Without lines nothing is denied."""
    return gain_db >= LEAST_GAIN_DB and changes.size > 0 and float(np.median(changes)) < SHARE * gain_db


def stayed(gain_db: float, c: int, lines_db: Sequence[FloatArray], bands_db: Sequence[float]) -> bool:
    """Whether the strong lines of channel `c` stayed where all its bands changed by `gain_db`, of any size and sign:
    then its noise changed (friction, another machine), not its gain. Few lines, or lines that scatter, say nothing.

    `lines_db`: of each channel the changes of all pairs; `bands_db`: of each channel the median of all bands. Load
    moves lines too: channels that kept their level tell by how much, where they have lines.
    """
    own = lines_db[c]
    kept = [x for k, x in enumerate(lines_db) if k != c and abs(bands_db[k]) < KEPT_DB and x.size >= LEAST_STAYED]
    load = float(np.median(np.concatenate(kept))) if kept else 0.0
    if own.size < LEAST_STAYED:
        return False
    low, middle, high = np.percentile(own - load, [25, 50, 75]) / gain_db
    return bool(middle < SHARE and abs(high - low) < SHARE)


def common_unit_gains(
    changes: Sequence[FloatArray], floors_db: Sequence[float], quantities: Sequence[str]
) -> tuple[float | None, ...]:
    """Of each channel the ratio of two units, dB, by which the lines and the floor of nearly all channels moved, where
    its own floor did too; None where they did not.

    `changes`: of each channel `line_changes` of all pairs; `floors_db`: the change of its quieter bands, `FLOOR_SHARE`
    of which changed by less; `quantities`: of the channels. Beside a fault that raises most bands the lines keep what a
    unit did to all channels, and the quieter bands tell it from lines that grew by themselves: an unbalance ten times
    larger leaves the floor where it was.
    """
    channels = list(zip(changes, floors_db, quantities, strict=True))
    exact = [sign * 20 * float(np.log10(r)) for r in UNIT_RATIOS.values() for sign in (-1, 1)]
    moved = [(sum(_allows(x, f, q) and _moved_by(x, change) for change, f, q in channels), x) for x in exact]
    count, ratio = max(moved, key=lambda one: one[0])
    if count < max(2.0, ALIKE * len(changes)) - 1e-9:
        return (None,) * len(changes)
    return tuple(ratio if _allows(ratio, f, q) and not _denies(ratio, change) else None for change, f, q in channels)


def _allows(gain_db: float, floor_db: float, quantity: str) -> bool:
    """Whether a quantity has such units, and a channel's quieter bands moved by their ratio."""
    known = any(abs(abs(gain_db) - 20 * float(np.log10(r))) < 1e-6 for r in possible(quantity).values())
    return known and abs(floor_db - gain_db) <= OFF_DB


def _moved_by(gain_db: float, lines_db: FloatArray) -> bool:
    middle, scatter = _spread(lines_db)
    return abs(middle - gain_db) <= OFF_DB and scatter <= SCATTER_DB


def _denies(gain_db: float, lines_db: FloatArray) -> bool:
    middle, scatter = _spread(lines_db)
    return abs(middle - gain_db) > FAR_DB and scatter <= SCATTER_DB


def _spread(lines_db: FloatArray) -> tuple[float, float]:
    """Median and half of the range of half of the lines; any where these are too few to say."""
    if lines_db.size < LEAST_LINES:
        return 0.0, float("inf")
    low, middle, high = np.percentile(lines_db, [25, 50, 75])
    return float(middle), float(high - low) / 2
