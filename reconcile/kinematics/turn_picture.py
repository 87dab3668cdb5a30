"""The picture of a tooth's place: the mean turn of its gear in the test and in its baseline, over the angle."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from reconcile.observe.whole_turn import WINDOW_TEETH, WholeTurn
from signals.series import FloatArray

POINTS = 1440
"""Of a curve; of more steps the largest of each stretch is kept, which keeps bursts."""
LEAST = 1e-3
"""Of the middle of a turn: what is less is drawn as that."""


def turn_picture(
    now: WholeTurn,
    before: WholeTurn | None,
    *,
    gear: str,
    shaft: str,
    start: str,
    starts: tuple[float, float],
    speed_hz: float,
    same_start: bool,
) -> dict[str, object]:
    """`{"mean_turn": ...}`: power in windows of a turn over the middle of them, dB, `test_db` and `baseline_db` at each
    of `angle_deg` of the `shaft`. `starts`: angles at which both turns begin, turns; `start`: what angles count from;
    `same_start`: whether the baseline's count from the same."""
    count = min(POINTS, now.windows.size)
    picture: dict[str, object] = {
        "gear": gear,
        "shaft": shaft,
        "speed_hz": speed_hz,
        "turns": now.turns,
        "window_deg": 360.0 * WINDOW_TEETH / now.teeth,
        "start": start,
        "same_start": same_start,
        "angle_deg": [round(360.0 * (k + 0.5) / count, 3) for k in range(count)],
        "test_db": _curve(now.windows, starts[0], count),
    }
    if before is not None:
        picture["baseline_db"] = _curve(before.windows, starts[1], count)
    return {"mean_turn": picture}


def _curve(windows: FloatArray, start: float, count: int) -> list[float]:
    """Of (steps,) windows the first of which is at `start` turns, the largest of each of `count` stretches of the turn
    from angle 0 on, dB."""
    steps = windows.size
    turned = np.roll(windows, round(start * steps) % steps)
    edges = np.linspace(0, steps, count + 1).astype(int)
    most = [float(turned[a : max(b, a + 1)].max()) for a, b in pairwise(edges)]
    return [round(10.0 * float(np.log10(max(value, LEAST))), 2) for value in most]
