"""Has one sensor at one operating point changed, and nothing else?

Across the load, and where teeth part, a motion may set in by itself from some speed on: sound machines near such a
speed begin it in one recording and hardly in the next, and it has a mirror image that is as likely. Three sound
machines of the proof show this, at one sensor and one of three speeds: c016 by 15 dB on the teeth's harmonics and the
floor beside them, v041 by the floor alone, c012 by all phases of the teeth, turned by half a turn at the same levels.
What is missing in a machine shows at a second sensor or a second speed; what shows at neither is told and left out.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.judge.changes import Changes
from reconcile.judge.nulls import group_lengths
from reconcile.judge.screen import largest_of_nulls
from reconcile.judge.space import Fitted
from reconcile.tail import tail_chance
from signals.series import FloatArray

LOUD_P = 0.0025
"""Chance of the most changed group in a sound machine, from which a change may be an answer."""
QUIET = 0.95
"""Quantile of sound machines' largest deviations elsewhere, up to which nothing has changed there."""


@dataclass(frozen=True, kw_only=True)
class Cell:
    """Number of an operating point and of a channel."""

    point: int
    channel: int


def features_of(changes: Changes, cell: Cell, points: int, channels: int) -> np.ndarray:
    """(F,): what is measured there: all of the channel's features and, as a phase is against the next channel's, the
    phases of the channel before it."""
    found = np.zeros((points, channels, changes.observed.size // (points * channels)), dtype=bool)
    found[cell.point, cell.channel] = True
    if changes.phases:
        found[cell.point, (cell.channel - 1) % channels, -changes.phases :] = True
    return found.ravel()


def lone_cell(fitted: Fitted, changes: Changes, points: int, channels: int) -> Cell | None:
    """The only sensor and operating point that changed; None where there are others, nothing has changed, or only one
    sensor or operating point is there to tell."""
    if min(points, channels) < 2:
        return None
    own = group_lengths(fitted.whiten(changes.observed)[None], fitted.groups)
    spread = np.maximum(fitted.resting.std(axis=0), 1e-9)
    seen, sound = ((x - fitted.resting.mean(axis=0)) / spread for x in (own, fitted.resting))
    if tail_chance(largest_of_nulls(fitted.resting), float(seen.max())) > LOUD_P:
        return None
    cells = [Cell(point=p, channel=c) for p in range(points) for c in range(channels)]
    left = [_elsewhere(fitted.groups, features_of(changes, cell, points, channels)) for cell in cells]
    rest = [float(seen[0, kept].max(initial=-np.inf)) for kept in left]
    best = int(np.argmin(rest))
    return cells[best] if rest[best] <= _usual(sound[:, left[best]]) else None


def _elsewhere(groups: np.ndarray, here: np.ndarray) -> np.ndarray:
    """Numbers of the groups without a feature that is `here`."""
    return np.setdiff1d(groups[(groups >= 0) & ~here], groups[here])


def _usual(sound: FloatArray) -> float:
    return float(np.quantile(sound.max(axis=1), QUIET)) if sound.shape[1] else -np.inf
