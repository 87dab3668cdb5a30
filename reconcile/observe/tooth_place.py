"""A place of a gear's turn at all operating points: whether it is that of a faulty tooth, and what that counts for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.observe.whole_turn import WholeTurn
from reconcile.verdict import AngleWindow

USUAL, SHARE, SCALE = 0.3, 0.05, 0.3
"""Of the sum over operating points of how far a window stands out: a twentieth of the looks at gears whose teeth are
sound, whatever else is wrong, is above the first and falls off by a factor e every 0.3. Of 108 such looks of the
proof's split `entire` the highest reached 1.12 (a fault of a sensor; the next 0.80); seven cracked teeth of 6 to 10 %
heard by three sensors 2.5 to 6.1."""
PLACED, PLACED_BARE = 1.25, 2.0
"""The same from which a place is told; the second where a point has no baseline. Without their baselines the 108 reach
0.91, the seven 2.3 and more."""
ONE_SPEED = 1.03
"""Recordings whose speeds differ by less are looks at one operating point: their middle counts, however many."""


@dataclass(frozen=True, kw_only=True)
class Look:
    """How far the fullest window of a recording's mean turn stands out, that turn, the angle at which it begins (turns)
    and the speed of the drive shaft."""

    standing: float
    turn: WholeTurn | None
    start_turns: float
    speed_hz: float


@dataclass(frozen=True, kw_only=True)
class ToothPlace:
    """How far the fullest windows of a gear's mean turns stand out, over all operating points; the turns of the
    strongest of these and its angle at the first sample, in turns. `bare`: not all of them have a baseline."""

    shaft: str
    standing: float
    strongest: WholeTurn | None
    start_turns: float
    bare: bool = False

    @property
    def evidence(self) -> float:
        """Log evidence of a faulty tooth: minus the log of how rare it is elsewhere."""
        return max(0.0, (self.standing - USUAL) / SCALE + float(np.log(1 / SHARE)) - 1.0) if self.told else 0.0

    @property
    def told(self) -> bool:
        """Whether there is a place at all."""
        return self.standing >= (PLACED_BARE if self.bare else PLACED)

    @property
    def chance(self) -> float:
        """Of so much on a gear whose teeth are sound."""
        return min(1.0, SHARE * float(np.exp(-(self.standing - USUAL) / SCALE))) if self.told else 1.0


def placed(shaft: str, looks: Sequence[Look], *, bare: bool = False) -> ToothPlace:
    """All recordings of a gear together: the sum over operating points of the middle of each."""
    best = max(looks, key=lambda one: one.standing)
    points: list[list[Look]] = []
    for one in sorted(looks, key=lambda one: one.speed_hz):
        if points and one.speed_hz < ONE_SPEED * points[-1][0].speed_hz:
            points[-1].append(one)
        else:
            points.append([one])
    total = sum(float(np.median([one.standing for one in point])) for point in points)
    return ToothPlace(shaft=shaft, standing=total, strongest=best.turn, start_turns=best.start_turns, bare=bare)


def angle_window(places: Mapping[str, ToothPlace]) -> AngleWindow | None:
    """The window that stands out most among all gears; None where none is told.

    Angles are those of the gear's shaft from the tacho's pulse on, without one from the first sample on.
    """
    best = max(places.values(), key=lambda p: p.standing, default=None)
    if best is None or not best.told or best.strongest is None:
        return None
    return window_of(best.strongest, shaft=best.shaft, start_turns=best.start_turns)


def window_of(turn: WholeTurn, *, shaft: str, start_turns: float = 0.0) -> AngleWindow:
    """The fullest window to half its height; `start_turns`: angle of the shaft at the first sample."""
    steps, at = turn.windows.size, turn.at
    middle = steps // 2
    below = np.flatnonzero(np.roll(turn.windows, middle - at) <= turn.height / 2)
    low = int(np.max(below[below < middle], initial=-1)) + 1
    high = int(np.min(below[below > middle], initial=steps)) - 1
    centre, step = (360.0 * (at / steps + start_turns)) % 360.0, 360.0 / steps
    return AngleWindow(
        shaft=shaft,
        centre_deg=centre,
        low_deg=centre - step * (middle - low),
        high_deg=centre + step * (high - middle),
    )
