"""Lines of a shaft at a speed far from the stated one: several harmonics of one fundamental where the label has none.

Labels are held against lines within a tenth of them (`reconcile.speed.estimate`); a label that is farther off finds
none there. A fundamental is looked for among the narrow lines themselves: each is tried as the first harmonic, its
multiples must be lines too, more of them than lines that stand anywhere would give, and what lies between them must be
empty, else the fundamental is a slower one's multiple (a cage's, another shaft's). Where teeth are known, the search
for the stated speed is begun anew from speeds all along.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from reconcile.speed.estimate import NOISE_LOG, SEARCH, coarse_speed, line_logs
from reconcile.speed.excess import line_excess, mains_bins
from reconcile.speed.octave import peak_near
from signals.recording import Recording
from signals.series import BoolArray, FloatArray

LOWEST, HIGHEST = 0.5, 1.9
"""Times the stated speed between which a fundamental is looked for. Near half and twice of it the octave decides
(`reconcile.speed.octave`), and a little above twice of it lies the supply of a motor with four poles."""
HARMONICS = 6
LEAST = 3
"""Harmonics of a fundamental that must be lines, the first and the second or the third among them."""
CLEAR, THERE = 1.5, 1.0
"""Log power over what noise reaches in one bin of 5e8 from which a line is clear, and from which one may be there."""
REACH = 0.002
"""Share of its frequency by which a harmonic may be away from a multiple: a shaft's speed wanders."""
REACH_BINS = 1.5
CHANCE = 0.01
"""That as many of the multiples of any line are lines, if lines stood anywhere."""
SUBMULTIPLES = (2, 3, 4, 5)
BETWEEN_TOP = 4
"""Multiple up to which lines between those of the fundamental are looked for."""
TEETH = (1, 2, 3)
"""Harmonics of the teeth that are looked for."""
WINDOWS = 15
"""Speeds from which the search, a tenth to either side, starts where teeth are known."""
HALF_SURE, SURE = 0.8, 0.99
"""Confidence from which a window is searched again from what was found, and from which teeth are believed: of so many
windows one in fifteen reaches 0.93 by chance."""
NEAR = 0.03
"""Relative difference from a speed that another recording tells, up to which a fundamental is looked for there."""
MAINS_HZ, MAINS_SHARE = (50.0, 60.0), 0.01
"""A fundamental this near the mains' may be theirs."""


@dataclass(frozen=True, kw_only=True)
class Elsewhere:
    """The lines of a shaft at `speed_hz`: the `harmonics` of it that are clear; `by_teeth`: those of its teeth are too.
    `own`: a line that is none of its is within a tenth of the stated speed or of twice that, so the stated one may be
    right as well."""

    speed_hz: float
    harmonics: tuple[int, ...]
    by_teeth: bool
    own: bool


@dataclass(frozen=True)
class Lines:
    """Narrow lines of all channels, (lines,): frequency in Hz, log power and whether they may be the mains';
    `step_hz`: of the bins; `top_hz`: up to which they were looked for."""

    hz: FloatArray
    log: FloatArray
    hum: BoolArray
    step_hz: float
    top_hz: float

    def reach(self, hz: float) -> float:
        """Hz by which a line may be away from its place."""
        return max(REACH * hz, REACH_BINS * self.step_hz)

    def near(self, hz: float, *, hum: bool = False) -> int | None:
        """Number of the strongest line at a frequency, those that may be the mains' left out unless `hum`."""
        first, last = np.searchsorted(self.hz, (hz - self.reach(hz), hz + self.reach(hz)))
        kept = np.arange(first, last)[hum | ~self.hum[first:last]]
        return int(kept[np.argmax(self.log[kept])]) if kept.size else None


@dataclass(frozen=True)
class Comb:
    """A fundamental, Hz, the lines at its multiples by their number, and how many multiples were looked at."""

    speed_hz: float
    there: Mapping[int, int]
    within: int


def lines_elsewhere(
    recording: Recording,
    stated_hz: float,
    *,
    ratios: Sequence[float] = (),
    teeth: Sequence[float] = (),
    seed: int = 0,
) -> Elsewhere | None:
    """Where a shaft's lines are clear between half and 1.9 times `stated_hz`, but a tenth from it at least, else None:
    by the teeth where these are known and sure, else the fundamental that has most harmonics.

    `ratios`: speeds of other shafts over the stated one's, whose lines say nothing against it; `teeth`: orders of the
    meshes.
    """
    lines = _lines(recording, stated_hz)
    speed = _by_teeth(line_logs(recording), stated_hz, teeth, seed) if teeth else None
    if speed is not None:
        there = _followed(lines, speed).there
        return Elsewhere(speed_hz=speed, harmonics=tuple(there), by_teeth=True, own=False)
    firsts = _firsts(lines, stated_hz)
    combs = [_followed(lines, hz) for hz in firsts]
    return _best(lines, stated_hz, [c for c in combs if _stands(lines, c, len(firsts), ratios)], ratios)


def lines_near(
    recording: Recording, stated_hz: float, told: Sequence[tuple[float, Sequence[int]]], *, ratios: Sequence[float] = ()
) -> Elsewhere | None:
    """Where a shaft's lines are clear near a speed (Hz) that another recording of the machine tells by the harmonics
    beside it, if it lies between half and 1.9 times `stated_hz`, but a tenth from it at least; else None.

    The places are foretold, so the lines of a defect between them do not make chance of those that are met.
    """
    lines = _lines(recording, stated_hz)
    combs = []
    for hz, harmonics in told:
        for first in (f for f in _firsts(lines, stated_hz) if abs(f / hz - 1.0) <= NEAR):
            comb = _followed(lines, first)
            met = set(harmonics) & set(comb.there)
            of = [k for k in harmonics if k * first < lines.top_hz]
            near = _below(lines, (max(of, default=0) + 0.5) * first)
            alone = min(2 * NEAR * hz * np.sum(near.log >= CLEAR) / near.top_hz, 1.0)
            chance = float(alone) * _chance(near, comb.speed_hz, len(met) - 1, len(of) - 1)
            if _enough(lines, comb, ratios) and len(met) >= LEAST and chance < CHANCE:
                combs.append(comb)
    return _best(lines, stated_hz, combs, ratios)


def harmonics_of(recording: Recording, speed_hz: float) -> tuple[int, ...]:
    """Those of a shaft that turns at `speed_hz` which are clear lines."""
    return tuple(_followed(_lines(recording, speed_hz), speed_hz).there)


def _best(lines: Lines, stated_hz: float, combs: Sequence[Comb], ratios: Sequence[float]) -> Elsewhere | None:
    """Of combs that stand the one that has most harmonics, those left out whose lines may be another's."""
    combs = [c for c in combs if not _mains(c.speed_hz) and not _known(c.speed_hz / stated_hz, ratios)]
    best = max(combs, key=lambda c: (len(c.there), sum(lines.log[i] for i in c.there.values())), default=None)
    if best is None:
        return None
    own = _own(lines, stated_hz, best.speed_hz, (1.0, *ratios))
    return Elsewhere(speed_hz=best.speed_hz, harmonics=tuple(best.there), by_teeth=False, own=own)


def _lines(recording: Recording, stated_hz: float) -> Lines:
    """Local maxima that may be lines in any channel, up to the highest multiple that is looked at: of those of two
    channels at one place the stronger."""
    rows: list[tuple[float, float, bool]] = []
    top, step = HARMONICS * HIGHEST * stated_hz * 1.01, 0.0
    for name in recording.names:
        ratio, width = line_excess(recording.series(name))
        log, hum = np.log(np.maximum(ratio, 1e-3)) - NOISE_LOG, mains_bins(ratio.size, width)
        inner = log[1:-1]
        peaks = 1 + np.flatnonzero((inner >= log[:-2]) & (inner > log[2:]) & (inner >= THERE))
        bent = log[peaks - 1] - 2 * log[peaks] + log[peaks + 1]
        place = (peaks + 0.5 * (log[peaks - 1] - log[peaks + 1]) / np.minimum(bent, -1e-9)) * width
        rows += [(float(f), float(log[p]), bool(hum[p])) for f, p in zip(place, peaks, strict=True) if f < top]
        top, step = min(top, ratio.size * width), max(step, width)
    kept: list[tuple[float, float, bool]] = []
    for row in sorted(rows):
        if kept and row[0] - kept[-1][0] <= REACH_BINS * step:
            kept[-1] = max(kept[-1], row, key=lambda one: one[1])
        else:
            kept.append(row)
    hz, level, hums = np.array(kept).reshape(-1, 3).T
    return Lines(hz=hz, log=level, hum=hums > 0, step_hz=step, top_hz=float(top))


def _by_teeth(
    combs: Sequence[tuple[FloatArray, float]], stated_hz: float, teeth: Sequence[float], seed: int
) -> float | None:
    """The speed at which the search for a stated speed is surest of shaft and teeth, if it is sure; Hz."""
    top = 0.9 * min(log.size * width for log, width in combs)
    best, sure = None, SURE
    for factor in np.geomspace(LOWEST, HIGHEST, WINDOWS):
        start = float(factor * stated_hz)
        for _ in range(2):  # once more from what was found: a speed at the edge of a window is believed less
            orders = tuple(k * z for z in teeth for k in TEETH if k * z * start * (1 + SEARCH) < top)
            if not orders:
                break
            start, confidence, _ = coarse_speed(combs, orders, start, SEARCH, seed)
            if confidence < HALF_SURE:
                break
        else:
            met = [k for k in orders if np.mean([peak_near(log, k * start / width) for log, width in combs]) >= THERE]
            if confidence > sure and len(met) >= LEAST and abs(start / stated_hz - 1.0) > SEARCH:
                best, sure = start, confidence
    return best


def _firsts(lines: Lines, stated_hz: float) -> list[float]:
    """Clear lines between half and 1.9 times the stated speed that are a tenth away from it."""
    clear = lines.hz[(lines.log >= CLEAR) & ~lines.hum] / stated_hz
    return [float(f * stated_hz) for f in clear if LOWEST <= f <= HIGHEST and abs(f - 1.0) > SEARCH]


def _followed(lines: Lines, first: float) -> Comb:
    """The multiples of a fundamental that are clear lines, each found narrowing it for the next (least squares)."""
    speed, there, within = first, {}, 0
    for k in range(1, HARMONICS + 1):
        if k * speed >= lines.top_hz:
            break
        within = k
        line = lines.near(k * speed, hum=True)
        if line is not None and lines.log[line] >= CLEAR:
            there[k] = line
            order = np.array(list(there), dtype=np.float64)
            speed = float(order @ lines.hz[list(there.values())] / (order @ order))
    return Comb(speed, there, within)


def _stands(lines: Lines, comb: Comb, tried: int, ratios: Sequence[float]) -> bool:
    """Whether enough multiples are lines, more than lines that stand anywhere would give, none of a slower
    fundamental."""
    if not _enough(lines, comb, ratios):
        return False
    above = replace(lines, top_hz=comb.within * comb.speed_hz)
    return tried * _chance(above, comb.speed_hz, len(comb.there) - 1, comb.within - 1) < CHANCE


def _enough(lines: Lines, comb: Comb, ratios: Sequence[float]) -> bool:
    """Whether enough multiples are lines, none of a slower fundamental. What may be the mains' counts, but not
    alone."""
    own = sum(not lines.hum[i] for i in comb.there.values())
    if 1 not in comb.there or len(comb.there) < LEAST or own < 2 or not {2, 3} & set(comb.there):
        return False
    return not _slower(lines, comb.speed_hz, ratios)


def _chance(lines: Lines, speed_hz: float, met: int, of: int) -> float:
    """That at least `met` of so many multiples above the first are lines, if lines stood anywhere up to the top."""
    above = lines.hz[(lines.log >= CLEAR) & (lines.hz > 1.01 * speed_hz)]
    width = 2 * np.maximum(REACH * above, REACH_BINS * lines.step_hz)
    covered = min(float(np.sum(width)) / max(lines.top_hz - speed_hz, lines.step_hz), 1.0)
    return float(scipy.stats.binom.sf(met - 1, of, covered))


def _below(lines: Lines, top_hz: float) -> Lines:
    """Those below a frequency."""
    kept = lines.hz < top_hz
    return replace(lines, hz=lines.hz[kept], log=lines.log[kept], hum=lines.hum[kept], top_hz=min(lines.top_hz, top_hz))


def _slower(lines: Lines, first: float, ratios: Sequence[float]) -> bool:
    """Whether half or more of the lines between the fundamental's own may be there, those of other shafts left out."""
    for m in SUBMULTIPLES:
        between = [j * first / m for j in range(1, BETWEEN_TOP * m) if j % m]
        between = [hz for hz in between if not any(_off(hz, r * first) <= lines.reach(hz) for r in ratios)]
        if 2 * sum(lines.near(hz) is not None for hz in between) >= max(len(between), 1):
            return True
    return False


def _off(hz: float, base: float) -> float:
    """Distance from the next multiple of a frequency, Hz."""
    return abs(hz - max(round(hz / base), 1) * base)


def _known(factor: float, ratios: Sequence[float]) -> bool:
    """Whether a fundamental is that of another shaft, or twice of it, at the stated speed."""
    return any(abs(factor / (r * m) - 1.0) <= SEARCH for r in ratios for m in (1, 2))


def _mains(hz: float) -> bool:
    return any(abs(hz / (m * k) - 1.0) <= MAINS_SHARE for m in MAINS_HZ for k in (1, 2))


def _own(lines: Lines, stated_hz: float, speed_hz: float, ratios: Sequence[float]) -> bool:
    """Whether a clear line near the stated speed, or twice of it, is no harmonic of the other, nor of its shafts."""
    clear = lines.hz[(lines.log >= CLEAR) & ~lines.hum]
    for k in (1, 2):
        for hz in clear[np.abs(clear / (k * stated_hz) - 1.0) <= SEARCH]:
            if min(_off(float(hz), r * speed_hz) for r in ratios) > 2 * lines.reach(float(hz)):
                return True
    return False
