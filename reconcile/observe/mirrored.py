"""Motion across the load that begins as its own mirror image: which sensors to read the other way round.

Where all teeth push along y, nothing tells one side of x from the other. From some speed on a motion across the load
sets in by itself, and which of two mirror images it is hangs on how the recording began: all its phases are turned by
half a turn against the baseline's, at the same levels, in sound machines as in others.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.observe.statistics import Statistics
from reconcile.observe.watch import WatchList
from sim.core.response import Channel
from sim.core.spec import MachineSpec

HALF_TURN = 0.9
"""Of half a turn, from which the middle of all lines' changes of phase is one: of 75 concealed cases of the proof with
an x sensor 13 come to 0.92 and more, 12 of them at 30 Hz; the next to 0.88 and below, where lines differ at random."""
FEWEST_LINES = 4
AGREED = 0.9
"""Length of the mean of the changes along the load, as numbers of length 1, from which they are one change."""


@dataclass(frozen=True, kw_only=True)
class Sides:
    """Numbers of the channels across the load and along it."""

    across: tuple[int, ...]
    along: tuple[int, ...]


def sides(machine: MachineSpec, channels: Sequence[Channel]) -> Sides:
    """Of a machine whose teeth all push along y; no channel is across in any other."""
    symmetric = bool(machine.meshes) and all(m.line_of_action == "y" for m in machine.meshes)
    of_axis = {axis: tuple(k for k, c in enumerate(channels) if c.axis == axis) for axis in ("x", "y")}
    return Sides(across=of_axis["x"] if symmetric else (), along=of_axis["y"])


def mirrored(test: Statistics, baseline: Statistics, watched: WatchList, which: Sides) -> tuple[int, ...]:
    """Channels across the load whose phases are turned by half a turn against those along it since the baseline, at
    the machine's own lines."""
    if not which.across or not which.along:
        return ()
    own = np.asarray(watched.own)[list(watched.phased)]
    turned = np.exp(1j * (test.phase - baseline.phase)[:, own])
    along = np.mean(turned[list(which.along)], axis=0)
    agreed = np.abs(along) >= AGREED
    if np.sum(agreed) < FEWEST_LINES:
        return ()
    apart = {c: np.abs(np.angle(turned[c, agreed] / along[agreed])) for c in which.across}
    return tuple(c for c, angles in apart.items() if np.median(angles) >= HALF_TURN * np.pi)


def turned_round(seen: Statistics, channels: Sequence[int]) -> Statistics:
    """The other mirror image on these channels: other signs of all their phases."""
    phase = seen.phase.copy()
    phase[list(channels)] += np.pi
    return replace(seen, phase=phase)
