"""The picture of a mean turn: its burst stands where the gear is, whatever angle the turn begins at."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from reconcile.kinematics.turn_picture import POINTS, turn_picture
from reconcile.observe.tooth_place import window_of
from reconcile.observe.whole_turn import WholeTurn


def turn(at: float, steps: int, height: float = 10.0) -> WholeTurn:
    """All 1 but for one step at a share of the turn."""
    windows = np.ones(steps)
    windows[round(at * steps)] = height
    return WholeTurn(windows=windows, teeth=20, turns=30)


def drawn(now: WholeTurn, before: WholeTurn | None = None, starts: tuple[float, float] = (0.0, 0.0)) -> dict[str, Any]:
    found = turn_picture(
        now, before, gear="pinion", shaft="in", start="the tacho", starts=starts, speed_hz=30.0, same_start=True
    )["mean_turn"]
    assert isinstance(found, dict)
    return found


@pytest.mark.parametrize("steps", [600, POINTS, 3 * POINTS + 7])
@pytest.mark.parametrize("start", [0.0, 0.4, 0.9])
def test_the_highest_point_is_at_the_window_and_as_high_as_the_burst(steps: int, start: float) -> None:
    now = turn(0.25, steps)
    shown = drawn(now, starts=(start, 0.0))
    top = int(np.argmax(shown["test_db"]))
    apart = abs(shown["angle_deg"][top] - window_of(now, shaft="in", start_turns=start).centre_deg) % 360.0
    assert min(apart, 360.0 - apart) <= 1.5 * 360.0 / min(steps, POINTS)
    assert shown["test_db"][top] == pytest.approx(10.0)
    assert len(shown["angle_deg"]) == len(shown["test_db"]) <= POINTS


def test_the_baseline_is_beside_it_from_its_own_start() -> None:
    assert "baseline_db" not in drawn(turn(0.25, 400))
    shown = drawn(turn(0.25, 400), turn(0.5, 800, height=2.0), (0.0, 0.25))
    assert len(shown["baseline_db"]) == len(shown["test_db"]) == 400
    assert shown["angle_deg"][int(np.argmax(shown["baseline_db"]))] == pytest.approx(270.0, abs=1.0)
    assert max(shown["baseline_db"]) == pytest.approx(10 * np.log10(2.0), abs=0.01)


def test_what_is_said_of_it_is_the_turns_own() -> None:
    shown = drawn(turn(0.25, 400))
    assert (shown["turns"], shown["window_deg"], shown["same_start"]) == (30, pytest.approx(1.2 * 360 / 20), True)
    assert shown["angle_deg"][0] == pytest.approx(0.45) and shown["angle_deg"][-1] == pytest.approx(359.55)
    other = turn_picture(
        turn(0.25, 400), None, gear="g", shaft="s", start="x", starts=(0.0, 0.0), speed_hz=1.0, same_start=False
    )["mean_turn"]
    assert isinstance(other, dict) and other["same_start"] is False


def test_nothing_at_all_is_drawn_as_a_number() -> None:
    empty = WholeTurn(windows=np.zeros(300), teeth=20, turns=30)
    assert set(drawn(empty)["test_db"]) == {-30.0}
