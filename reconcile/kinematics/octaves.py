"""Does half or twice the speed explain a bearing's own lines better? A comb holds every other line of a denser one.

A race that is struck at a rate has lines at its multiples and none half way between. Where lines stand there too, it
is struck half as often, and all of it is met at half the speed; where its odd multiples are missing, at twice the
speed. The scores of the combs do not tell: they share most of their lines. Balls are left out: one that meets one race
only has lines half way.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from reconcile.kinematics.candidate import Candidate
from reconcile.kinematics.contrast import band_turns
from reconcile.kinematics.envelopes import order_depth
from reconcile.kinematics.evidence import Evidence
from reconcile.kinematics.lines import CLEAR_DB, order_lines
from reconcile.kinematics.observe import Observation
from reconcile.speed.excess import power_over_floor
from signals.series import FloatArray

RACES = ("outer", "inner")
PRESENT_DB = 10.0
"""Power over the noise of a line that is there."""
BETWEEN_SHARE = 0.3
"""Of the power of the comb's own first three lines, that those between them hold at least: measured bearings at a speed
stated twice too high 1.3 to 3.3, at the right one up to 0.02."""
LEAST_BETWEEN = 2
ODD_SHARE = 0.08
"""Of the second line's power, that the first and the third hold at most: measured bearings at half the speed up to
0.02, at the right one 1.5 and more."""
WIDTH = 0.002
"""Half width of a line, share of its order."""
TAKEN = 0.01
"""Nearer than this share to a line of another part that is there, a line between is that part's."""
HARMONICS = (1.0, 2.0, 3.0)
ODD, LEAST_ODD = (1.0, 3.0, 5.0), 2
"""Multiples of the shaft of which so many must be clear lines."""


def octave_of(candidate: Candidate, every: Sequence[Candidate], tests: Sequence[Observation]) -> float | None:
    """0.5 or 2 where that times the speed explains a race's lines better in most of the tests; else None."""
    if candidate.family.kind not in RACES:
        return None
    others = [c for c in every if c is not candidate and c.present]
    found = [_octave(e, t, others, i) for i, (e, t) in enumerate(zip(candidate.evidence, tests, strict=True))]
    return next((f for f in (0.5, 2.0) if 2 * sum(x == f for x in found) > len(found)), None)


def odd_lines(tests: Sequence[Observation]) -> bool:
    """Whether the shaft has lines at odd multiples of the speed in most of the tests: it does not turn twice as fast,
    and the race is struck twice a ball pass, as by both edges of a long spall."""
    return 2 * sum(_has_odd_lines(t) for t in tests) > len(tests)


def _has_odd_lines(test: Observation) -> bool:
    if test.speed.method != "harmonics" or test.speed.rival_hz is not None:
        return False
    for channel in test.recording.names:
        lines = order_lines(test, channel)
        if lines is None:
            continue
        level, floor = lines.at(np.array(ODD))
        if np.sum(level - floor >= CLEAR_DB) >= LEAST_ODD:
            return True
    return False


def _octave(e: Evidence, test: Observation, others: Sequence[Candidate], number: int) -> float | None:
    if test.speed.method == "tacho":
        return None
    depth, step = order_depth(*band_turns(test, e.channel, e.band_hz))
    excess_db = 10 * np.log10(power_over_floor(depth**2) + 1e-12)

    def at(orders: Sequence[float]) -> tuple[FloatArray, FloatArray]:
        """(power over noise in dB, square of the depth) of the largest bin at each order."""
        rows = []
        for order in orders:
            reach = max(1, round(WIDTH * order / step))
            part = slice(max(round(order / step) - reach, 0), round(order / step) + reach + 1)
            rows.append((np.max(excess_db[part], initial=-99.0), np.max(depth[part], initial=0.0) ** 2))
        level, power = np.array(rows).reshape(-1, 2).T
        return level, np.where(level > PRESENT_DB, power, 0.0)

    _, own = at([k * e.order for k in HARMONICS])
    taken = [k * c.evidence[number].order for c in others for k in HARMONICS]
    between = [(a + b) / 2 * e.order for a, b in pairwise((0.0, *HARMONICS))]
    level, odd = at([o for o in between if all(abs(o / x - 1) > TAKEN for x in taken)])
    if np.sum(level > PRESENT_DB) >= LEAST_BETWEEN and np.sum(odd) > BETWEEN_SHARE * np.sum(own):
        return 0.5
    return 2.0 if own[1] > 0 and own[0] + own[2] < ODD_SHARE * own[1] else None
