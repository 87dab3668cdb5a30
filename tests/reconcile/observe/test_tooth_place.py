"""Where in a gear's turn a burst comes back: the place, the gear, what it counts for."""

import numpy as np
import pytest

from reconcile.observe.tooth_place import PLACED, PLACED_BARE, Look, ToothPlace, angle_window, placed, window_of
from reconcile.observe.whole_turn import WholeTurn


def turned(at_deg, width_deg=20.0, height=5.0, steps=720):
    angle = 360.0 * np.arange(steps) / steps
    off = (angle - at_deg + 180.0) % 360.0 - 180.0
    return WholeTurn(windows=1.0 + (height - 1.0) * np.exp(-((off / width_deg) ** 2)), teeth=23, turns=30)


def place(standing, *, bare=False, at_deg=90.0, shaft="input"):
    return ToothPlace(shaft=shaft, standing=standing, strongest=turned(at_deg), start_turns=0.0, bare=bare)


def test_what_sound_gears_show_counts_for_nothing():
    assert place(1.1).evidence == 0.0
    assert place(1.1).chance == 1.0
    assert angle_window({"pinion": place(1.1)}) is None


def test_evidence_grows_as_the_chance_falls():
    faint, clear = place(PLACED), place(3.0)
    assert 3.0 < faint.evidence < 8.0 < clear.evidence
    assert faint.chance < 3e-3
    assert clear.chance < 1e-5
    assert clear.evidence == pytest.approx(-np.log(clear.chance) - 1.0)


def test_without_a_baseline_more_is_asked():
    assert place(PLACED_BARE - 0.1).told
    assert not place(PLACED_BARE - 0.1, bare=True).told
    assert place(PLACED_BARE, bare=True).told


def test_the_window_is_that_of_the_gear_that_stands_out_most():
    found = angle_window({"pinion": place(1.4), "gear": place(2.5, at_deg=200.0, shaft="output")})
    assert found is not None
    assert found.shaft == "output"
    assert found.centre_deg == pytest.approx(200.0, abs=1.0)


@pytest.mark.parametrize("at_deg", [5.0, 180.0, 355.0])
def test_a_window_reaches_to_half_its_height(at_deg):
    found = window_of(turned(at_deg, height=9.0), shaft="input", start_turns=0.25)
    assert found.centre_deg == pytest.approx((at_deg + 90.0) % 360.0, abs=1.0)
    # 1 + 8 exp(-x^2) = 4.5 at x = 0.909
    assert found.high_deg - found.low_deg == pytest.approx(2 * 0.909 * 20.0, abs=2.0)


def look(standing, speed_hz):
    return Look(standing=standing, turn=turned(90.0), start_turns=0.0, speed_hz=speed_hz)


def test_operating_points_add_up_and_recordings_of_one_do_not():
    assert placed("input", [look(0.5, 20.0), look(0.6, 30.0), look(0.7, 40.0)]).standing == pytest.approx(1.8)
    ten = placed("input", [look(0.3, 30.0 + 0.02 * k) for k in range(10)])
    assert ten.standing == pytest.approx(0.3) and not ten.told
