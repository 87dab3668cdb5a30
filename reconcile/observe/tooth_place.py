"""A place of a gear's turn at all operating points: whether it is that of a faulty tooth, and what that counts for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from reconcile.observe.whole_turn import WholeTurn
from reconcile.verdict import AngleWindow

USUAL, SHARE, SCALE = 0.28, 0.05, 0.2
"""Of the sum over operating points of how far a window stands out: a twentieth of the looks at gears whose teeth are
sound, whatever else is wrong, is above the first and falls off by a factor e every 0.2. Of 110 such looks of the
proof's split `entire` the highest reached 0.62; seven cracked teeth of 6 to 10 % heard by three sensors 2.7 to 6.1."""
PLACED, PLACED_BARE = 1.0, 2.0
"""The same from which a place is told; the second where a point has no baseline. Without their baselines the 110 reach
1.66 (a sensor's fault), the seven 2.4 and more."""


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


def placed(shaft: str, points: Sequence[tuple[float, WholeTurn | None, float]], *, bare: bool = False) -> ToothPlace:
    """All operating points of a gear together: how far each stands out, its turn, and the angle at its first sample."""
    _, strongest, start = max(points, key=lambda p: p[0])
    total = sum(p[0] for p in points)
    return ToothPlace(shaft=shaft, standing=total, strongest=strongest, start_turns=start, bare=bare)


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
