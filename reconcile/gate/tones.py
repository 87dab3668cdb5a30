"""Tones fixed in Hz: lines that stay where they are while the machine turns faster, and that no baseline has.

An inverter's switching, another machine, a clock: what turns with the shaft moves with it, so a narrow line at the
same frequency at two speeds is none of its motions. A structure's own frequency stays too but is not narrow. Lines
beside such a tone at a fixed multiple of the shaft's speed (what a drive's current does to its switching) go with it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, floor

import numpy as np

from reconcile.compiled.lines import lines_beside, standing
from reconcile.gate.combs import supply_comb, without_comb
from reconcile.gate.findings import Finding
from reconcile.gate.mains import GROWN_DB, LEAST_SHARE, MATERIAL_SHARE, power_at
from reconcile.gate.sines import without_sines
from reconcile.shares import percent
from reconcile.speed.excess import line_excess
from signals.recording import Recording
from signals.series import FloatArray

APART = 1.03
"""Ratio of two speeds from which on a line of the machine has moved by many bins."""
PRESENT_DB = 20.0
BESIDE_DB = 15.0
"""Of a line beside a tone."""
NARROW_DB = 12.0
"""By which a tone stands above the bins three to eight beside it: a sine does by 40, a mode of the structure not."""
MOST_LINES = 40
STAY_BINS, BESIDE_BINS, OWN_BINS = 1.5, 3.0, 2.5
ELSEWHERE = (-61, -43, -29, -17, 17, 29, 43, 61)
"""Bins away from a line, where the other tests' lines meet it by chance only."""
RARE = 0.3
"""Lines that meet so; more, and those that stay must be more than their scatter."""
FARTHEST = 12.0
"""Orders of the shaft between a tone and a line that goes with it."""
COMB, COMB_LEAST, DENSE_LEAST = 4, 0.75, 0.9
"""Lines of a comb looked at on either side of one of it, and the shares of them, and of those of a denser one, that
must be there."""
COMB_ORDERS, COMB_BINS, WHOLE = (0.2, 40.0), 10.0, 0.02
"""Between which orders of the shaft combs are looked for, how many bins apart their lines are at least, and how near to
a whole order is one;"""
DENSER = (2, 3, 5)
"""How many times as dense a comb may be that stands still in Hz."""
SAME_ORDER = 0.01
"""and by which they may differ between tests: rolling elements slip."""
SLIP, LEAST_ORDER = 0.02, 1.0
"""By which a comb may differ from a bearing's numbers; a cage's lines are so close that some pass everywhere."""
SIDEBANDS = (0, 1, -1, 2, -2, 3, -3, 4, -4)
"""Turns of the shaft by which lines stand beside those of a bearing: the load goes round in its impacts."""
BESIDE_BLOCK_S = 0.25
"""Lines beside a tone wander with the speed."""


@dataclass(frozen=True)
class Heard:
    """One channel of one test: power of the bins over the floor, Hz a bin, the shaft's speed, the machine's lines, and
    the orders of the bearings' impacts."""

    excess: FloatArray
    step_hz: float
    speed_hz: float
    expected_hz: FloatArray
    impacts: tuple[float, ...] = ()

    def own(self, hz: float) -> bool:
        """Whether a frequency is one of the machine's own or of the shaft's harmonics."""
        reach = OWN_BINS * self.step_hz
        harmonic = abs(hz - round(hz / self.speed_hz) * self.speed_hz) < reach
        return harmonic or (self.expected_hz.size > 0 and float(np.min(np.abs(self.expected_hz - hz))) < reach)

    def peak(self, hz: float, bins: float, least_db: float, *, narrow: bool) -> float | None:
        """Frequency of the strongest bin near `hz`, Hz; None where it does not stand out."""
        factor = 10 ** (NARROW_DB / 10) if narrow else 0.0
        top = standing(self.excess, self.step_hz, hz, bins, 10 ** (least_db / 10), factor)
        return None if top < 0 else top * self.step_hz

    def combs(self, hz: float) -> list[float]:
        """Spacings, in orders of the shaft, of combs that pass a frequency. Not whole ones: sidebands of a drive's tone
        stand so far from it."""
        closest = max(COMB_ORDERS[0] * self.speed_hz, COMB_BINS * self.step_hz)
        counts = range(max(1, int(hz / (COMB_ORDERS[1] * self.speed_hz))), int(hz / closest) + 1)
        orders = ((n, hz / (n * self.speed_hz)) for n in counts)
        return [o for n, o in orders if abs(o - max(1, round(o))) > WHOLE and self.passed(hz, n)]

    def bearings(self, hz: float) -> list[float]:
        """Spacings, in orders of the shaft, of combs of known bearings that pass a frequency, or whole turns beside."""
        found = []
        for place in (hz + k * self.speed_hz for k in SIDEBANDS):
            turns = max(0.0, place / self.speed_hz)
            for order in (x for x in self.impacts if x > LEAST_ORDER):
                counts = range(max(1, ceil(turns / (order * (1 + SLIP)))), floor(turns / (order * (1 - SLIP))) + 1)
                found += [turns / n for n in counts if self._beside(place, n, 1, COMB_LEAST)]
        return found

    def passed(self, hz: float, count: int) -> bool:
        """Whether `hz` is the `count`-th line of a comb: those beside it stand out, and those between that a denser one
        would have do not."""
        return self._beside(hz, count, 1, COMB_LEAST) and not any(
            self._beside(hz, count * n, n, DENSE_LEAST) for n in DENSER
        )

    def _beside(self, hz: float, count: int, every: int, least: float) -> bool:
        """Whether at `least` so large a share of the lines of a comb beside its `count`-th stand out, without each
        `every`-th."""
        found = lines_beside(
            self.excess, self.step_hz, hz, count, every, COMB, BESIDE_BINS, 10 ** (BESIDE_DB / 10), least
        )
        return bool(found)

    def peaks(self, least_db: float, *, narrow: bool) -> list[float]:
        """The strongest lines, Hz, strongest first."""
        inner = self.excess[1:-1]
        tops = 1 + np.flatnonzero((inner >= self.excess[:-2]) & (inner > self.excess[2:]))
        tops = tops[self.excess[tops] > 10 ** (least_db / 10)]
        strongest = tops[np.argsort(-self.excess[tops])][:MOST_LINES]
        found = [self.peak(top * self.step_hz, 0.0, least_db, narrow=narrow) for top in strongest]
        return [hz for hz in found if hz is not None]


def tone_findings(
    tests: Sequence[Recording],
    labels: Sequence[str],
    speeds_hz: Sequence[float],
    expected_hz: Sequence[FloatArray],
    baselines: Sequence[Recording],
    impacts: Sequence[float] = (),
) -> tuple[tuple[Finding, ...], list[Recording]]:
    """One `fixed_tones` a channel, and the tests without them; nothing is claimed of tests at one speed. `impacts`:
    orders of the bearings' parts."""
    order = np.sort(np.asarray(speeds_hz))
    if not any(b > APART * a > 0 for a, b in pairwise(order)):
        return (), list(tests)
    found, clean = [], list(tests)
    for name in tests[0].names:
        if any(name not in one.names for one in tests):
            continue
        heard = [
            Heard(*line_excess(one.series(name)), hz, own, tuple(impacts))
            for one, hz, own in zip(tests, speeds_hz, expected_hz, strict=True)
        ]
        tones = fixed_tones(heard)
        beside = beside_tones(heard, tones) if tones else []
        comb = supply_comb(tones, heard[0].step_hz) if tones else None
        if comb is not None:  # a shaft's own strong lines may stand at some of them
            tones = [hz for hz in tones if _new(tests, baselines, name, hz)]
            comb = supply_comb(tones, heard[0].step_hz)
        finding = _told(tests, labels[0], name, tones, beside, baselines, comb)
        if finding is None:
            continue
        found.append(finding)
        if comb is not None:
            clean = [without_comb(one, name, comb) for one in clean]
            continue
        clean = [without_sines(one, {name: tones}) for one in clean]
        clean = [
            without_sines(one, {name: [tone + o * h.speed_hz for tone, o in beside]}, block_s=BESIDE_BLOCK_S)
            for one, h in zip(clean, heard, strict=True)
        ]
    return tuple(found), clean


def fixed_tones(heard: Sequence[Heard]) -> list[float]:
    """Frequencies, Hz, of narrow lines that all tests have at one place and at least two speeds' own lines have not;
    none where lines meet as often at places that the tests do not share, as in the forest that a pit brings.

    A shaft at 25 Hz has its own lines wherever a supply of 50 Hz has: what is free at one other speed only is taken
    where it is a supply's comb."""
    found = _more_than_chance(heard, apart=True)
    if supply_comb(found, heard[0].step_hz) is None:
        once = _more_than_chance(heard, apart=False)
        return once if supply_comb(once, heard[0].step_hz) is not None else found
    return found


def _more_than_chance(heard: Sequence[Heard], *, apart: bool) -> list[float]:
    found = _staying(heard, 0, apart=apart)
    chance = float(np.mean([len(_staying(heard, shift, apart=apart)) for shift in ELSEWHERE]))
    return found if chance < RARE or len(found) > chance + 3.0 * chance**0.5 else []


def _staying(heard: Sequence[Heard], shift: int, *, apart: bool = True) -> list[float]:
    """The lines of the first test, Hz, that the others have so many bins away; `apart`: that are not the machine's
    own at two speeds at least, else at one."""
    found = []
    for hz in heard[0].peaks(PRESENT_DB, narrow=True):
        at = [hz + (shift * h.step_hz if k else 0.0) for k, h in enumerate(heard)]
        places = [h.peak(place, STAY_BINS, PRESENT_DB, narrow=True) for h, place in zip(heard, at, strict=True)]
        free = [h.speed_hz for h, place in zip(heard, at, strict=True) if not h.own(place)]
        if None not in places and free and (not apart or max(free) > APART * min(free)) and not _struck(heard, at):
            found.append(hz)
    return sorted(found)


def _struck(heard: Sequence[Heard], at: Sequence[float]) -> bool:
    """Whether a comb that goes with the speed passes the frequencies `at` in every test: impacts at 20 and 40 turns a
    second have every second line in common. Of a known bearing also the lines whole turns beside: the second at 20 is
    the first at 40."""

    def there(order: float, one: Heard, hz: float) -> bool:
        count = round(hz / (order * one.speed_hz))
        alike = count > 0 and abs(hz / (count * one.speed_hz) / order - 1.0) < SAME_ORDER
        return alike and one.passed(hz, count)

    rest = list(zip(heard, at, strict=True))[1:]
    if any(all(there(order, *one) for one in rest) for order in heard[0].combs(at[0])):
        return True
    first, *others = (one.bearings(hz) for one, hz in zip(heard, at, strict=True))
    return any(all(any(abs(x / order - 1.0) < SAME_ORDER for x in other) for other in others) for order in first)


def beside_tones(heard: Sequence[Heard], tones: Sequence[float]) -> list[tuple[float, float]]:
    """(tone in Hz, orders of the shaft from it) of lines that keep their distance from a tone in orders."""
    found: list[tuple[float, float]] = []
    first = heard[0]
    for hz in first.peaks(BESIDE_DB, narrow=False):
        near = min(tones, key=lambda tone: abs(hz - tone))
        away = (hz - near) / first.speed_hz
        if abs(away) > FARTHEST or abs(hz - near) < OWN_BINS * first.step_hz:
            continue
        places = [near + away * h.speed_hz for h in heard]
        free = [h.speed_hz for h, place in zip(heard, places, strict=True) if not h.own(place)]
        met = [h.peak(place, BESIDE_BINS, BESIDE_DB, narrow=False) for h, place in zip(heard, places, strict=True)]
        if None not in met and free and max(free) > APART * min(free):
            found.append((near, away))
    return found


def _new(tests: Sequence[Recording], baselines: Sequence[Recording], name: str, hz: float) -> bool:
    """Whether a tone is stronger in every test than in any baseline."""
    before = [power_at(one, name, [hz]) for one in baselines if name in one.names]
    return not before or min(power_at(one, name, [hz]) for one in tests) > max(before) * 10 ** (GROWN_DB / 10)


def _told(
    tests: Sequence[Recording],
    label: str,
    name: str,
    tones: Sequence[float],
    beside: Sequence[tuple[float, float]],
    baselines: Sequence[Recording],
    comb: float | None,
) -> Finding | None:
    """The finding where the tones are new; what a baseline has as well is left to the comparison."""
    if not tones:
        return None
    power = min(power_at(one, name, tones) for one in tests)
    share = min(power_at(one, name, tones) / max(float(np.var(one.series(name).samples)), 1e-300) for one in tests)
    before = [power_at(one, name, tones) for one in baselines if name in one.names]
    grown = 10 * np.log10(power / max(*before, 1e-300)) if before else None
    if share < (MATERIAL_SHARE if grown is None else LEAST_SHARE) or (grown is not None and grown < GROWN_DB):
        return None
    detail = f"narrow lines at {', '.join(f'{hz:.5g}' for hz in tones)} Hz stay there at every speed"
    detail += f", with lines at fixed orders beside them ({len(beside)})" if beside else ""
    detail += f" and hold {percent(share)} of the power or more"
    detail += "" if grown is None else f", {grown:+.0f} dB against the baseline"
    if comb is None:
        detail += ": not this machine's motion, but a drive's switching, another machine or the recorder"
    else:
        detail += f": multiples of {comb:.5g} Hz, so impulses at the supply's rate (a drive, a lamp, a welder)"
    return Finding(
        kind="fixed_tones",
        channel=name,
        recording=label,
        detail=detail,
        severity=float(min(1.0, share)),
        where=", ".join(f"{hz:.5g} Hz" for hz in tones[:6]) if comb is None else f"{comb:.5g} Hz and multiples",
        fault=True,
        tones_hz=tuple(tones),
    )
