"""Mean speed of the shaft: pulses, else by its own harmonics, near a stated speed or anywhere.

Near a stated speed the likeliest one is taken, and how far others are as likely is its doubt; where that is as wide as
what was known before, the stated one is kept. Without a stated speed several candidates are handed on, and the answer
takes the one under which the machine's other lines fall into place best (`assess.estimated`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from learn.bank import MIN_TURNS
from learn.shaft import Shaft, shaft
from signals.series import FloatArray

LOWEST_HZ, HIGHEST_HZ = 8.0, 64.0
"""Searched where no speed is stated: those of the training data."""
SEARCH = 0.06
"""Share by which a stated speed may be wrong."""
USUAL_ERROR = 0.02
GRID = 3e-4
"""Relative steps of the search."""
FINE = 0.002
TRIED = 3
MOST = 6
APART = 0.004
DOUBTS = (5e-4, USUAL_ERROR)
UNCONFIRMED = 0.0195
"""From this doubt on the lines say no more than the statement, which is kept (`learn.sim2real.left_out`)."""


@dataclass(frozen=True, kw_only=True)
class Speed:
    """Speed in Hz; `method`: `tacho`, `lines` near the stated one, `stated`, `scan`, `given`; `standing`: how far its
    log-likelihood stands out; `doubt`: relative deviation."""

    speed_hz: float
    method: str
    standing: float
    doubt: float = 0.0
    likely: tuple[float, ...] = ()
    """Speeds near a stated one, each as likely as the next: where lines do not decide, all are to be tried."""


def candidates(channels: Sequence[FloatArray], rate_hz: float, stated_hz: float | None) -> list[Speed]:
    """Speeds worth trying, the likeliest first; near a stated speed one: the likeliest."""
    duration = min(c.size for c in channels) / rate_hz
    low, high = (LOWEST_HZ, HIGHEST_HZ) if stated_hz is None else ((1 - SEARCH) * stated_hz, (1 + SEARCH) * stated_hz)
    low = max(low, MIN_TURNS / duration)
    lines = shaft(channels, rate_hz, high)
    speeds = np.geomspace(low, high, max(3, int(np.log(high / low) / GRID)))
    score = lines.likelihood(speeds)
    if stated_hz is not None:
        score -= 0.5 * ((speeds / stated_hz - 1) / USUAL_ERROR) ** 2
        found = _placed(lines, speeds, score, "lines", float(np.max(score) - np.median(score)))
        if found.doubt >= UNCONFIRMED:
            found = Speed(speed_hz=stated_hz, method="stated", standing=0.0, doubt=USUAL_ERROR)
        return [replace(found, likely=_quantiles(speeds, score))]
    several = []
    for k in _peaks(speeds, score):
        near = np.abs(speeds / speeds[k] - 1) <= USUAL_ERROR
        several.append(_placed(lines, speeds[near], score[near], "scan", float(score[k] - np.median(score))))
    return several


def _placed(lines: Shaft, speeds: FloatArray, score: FloatArray, method: str, standing: float) -> Speed:
    """The likeliest speed; its doubt is the deviation of all speeds, each as likely as it is, from it."""
    k = int(np.argmax(score))
    found = _finely(lines, float(speeds[k]))
    likely = np.exp(score - score[k])
    doubt = float(np.sqrt(np.sum(likely * (speeds / found - 1) ** 2) / np.sum(likely)))
    return Speed(speed_hz=found, method=method, standing=standing, doubt=float(np.clip(doubt, *DOUBTS)))


def _quantiles(speeds: FloatArray, score: FloatArray) -> tuple[float, ...]:
    """Middles of equal shares of the likelihood."""
    share = np.cumsum(np.exp(score - np.max(score)))
    middles = (np.arange(TRIED) + 0.5) / TRIED * share[-1]
    return tuple(float(f) for f in speeds[np.searchsorted(share, middles)])


def _finely(lines: Shaft, speed_hz: float) -> float:
    """The place within `FINE` where the harmonics have most power."""
    speeds = speed_hz * (1 + np.arange(-FINE, FINE + GRID / 4, GRID / 2))
    return float(speeds[np.argmax(lines.fine(speeds))])


def _peaks(speeds: FloatArray, standing: FloatArray) -> list[int]:
    """Places of the largest values, no two nearer than `APART`."""
    chosen: list[int] = []
    for k in np.argsort(-standing):
        if all(abs(speeds[k] / speeds[j] - 1) > APART for j in chosen):
            chosen.append(int(k))
        if len(chosen) == MOST:
            break
    return chosen
