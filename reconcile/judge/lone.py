"""Has one sensor at one operating point changed, and nothing else, or hardly anything?

Across the load, and where teeth part, a motion may set in by itself from some speed on: sound machines near such a
speed begin it in one recording and hardly in the next, and it has a mirror image that is as likely. Three sound
machines of the proof show this, at one sensor and one of three speeds: c016 by 15 dB on the teeth's harmonics and the
floor beside them, v041 by the floor alone, c012 by all phases of the teeth, turned by half a turn at the same levels.
A fault of these plans mostly shows at a second sensor or a second speed; what shows at neither is told and left out.
Where the motion is strong the sensors beside it hear some of it too (j053: 23 deviations, and 4 at the next sensor).
"""

from __future__ import annotations

from collections.abc import Callable
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
"""Quantile of what sound machines show elsewhere, in one group and in the mean of all, up to which nothing has changed
there."""

FEWEST_POINTS = 3
"""Operating points from which one of them may be told to have changed alone: two others must say nothing."""
HEARD_BESIDE = 0.25
"""Of the most changed group's deviations, the most that any other sensor may show of a motion at one sensor."""


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
    """The only sensor and operating point that changed; None where there are others, nothing has changed, it may be
    either of two (the phase between them is all), or only one sensor or operating point is there to tell."""
    if min(points, channels) < 2:
        return None
    seen, sound = _deviations(fitted, changes)
    if tail_chance(largest_of_nulls(fitted.resting, fitted.pairs), float(seen.max())) > LOUD_P:
        return None
    silent = []
    for cell in (Cell(point=p, channel=c) for p in range(points) for c in range(channels)):
        left = _elsewhere(fitted.groups, features_of(changes, cell, points, channels))
        if left.size and all(_usual(seen[left], sound[:, left], how) for how in (np.max, np.mean)):
            silent.append(cell)
    return silent[0] if len(silent) == 1 else None


def loudest_cell(fitted: Fitted, changes: Changes, points: int, channels: int) -> Cell | None:
    """The sensor that changed by far the most at the only operating point that changed; None where other points have
    changed, another sensor shows more than a share of it there, nothing has changed, or too few points are there."""
    if points < FEWEST_POINTS or channels < 2:
        return None
    seen, sound = _deviations(fitted, changes)
    if tail_chance(largest_of_nulls(fitted.resting, fitted.pairs), float(seen.max())) > LOUD_P:
        return None
    most = np.full((points, channels), -np.inf)
    for cell in (Cell(point=p, channel=c) for p in range(points) for c in range(channels)):
        own = _whole(fitted.groups, cell, points, channels)
        most[cell.point, cell.channel] = seen[own].max(initial=-np.inf)
    point, channel = (int(k) for k in np.unravel_index(np.argmax(most), most.shape))
    if np.delete(most[point], channel).max() > HEARD_BESIDE * most[point, channel]:
        return None
    here = np.repeat(np.arange(points) == point, changes.observed.size // points)
    left = _elsewhere(fitted.groups, here)
    quiet = left.size and all(_usual(seen[left], sound[:, left], how) for how in (np.max, np.mean))
    return Cell(point=point, channel=channel) if quiet else None


def _deviations(fitted: Fitted, changes: Changes) -> tuple[FloatArray, FloatArray]:
    """Lengths of the groups seen (k,) and of sound machines (n, k), in deviations of the latter."""
    own = group_lengths(fitted.whiten(changes.observed)[None], fitted.groups)[0]
    spread = np.maximum(fitted.resting.std(axis=0), 1e-9)
    middle = fitted.resting.mean(axis=0)
    return (own - middle) / spread, (fitted.resting - middle) / spread


def _whole(groups: np.ndarray, cell: Cell, points: int, channels: int) -> np.ndarray:
    """Numbers of the groups of a cell's own features."""
    own = groups.reshape(points, channels, -1)[cell.point, cell.channel]
    return np.unique(own[own >= 0])


def _elsewhere(groups: np.ndarray, here: np.ndarray) -> np.ndarray:
    """Numbers of the groups without a feature that is `here`."""
    return np.setdiff1d(groups[(groups >= 0) & ~here], groups[here])


def _usual(seen: FloatArray, sound: FloatArray, how: Callable[..., FloatArray]) -> bool:
    """Whether sound machines' groups (n, k) show as much as those seen (k,), by their largest or their mean."""
    return bool(how(seen) <= np.quantile(how(sound, axis=1), QUIET))
