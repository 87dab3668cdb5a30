"""What comes back at one angle holds power in the mean turn; meshes, balls and noise do not."""

import numpy as np
import pytest

from reconcile.observe.mean_turn import Turning, turn_powers
from tests.reconcile.observe.test_turn import RATE, SPEED_HZ, TEETH, TURNS, healthy, struck

BAND = ((1500.0, 2500.0),)
INPUT = Turning(hz=SPEED_HZ, teeth=(TEETH,))


def power(samples, turning=INPUT, top_hz=8000.0):
    return float(turn_powers(np.atleast_2d(samples), RATE, turning, BAND, top_hz)[0, 0])


@pytest.mark.parametrize("size", [0.3, 1.0, 5.0])
def test_power_grows_with_the_square_of_the_burst(size):
    burst = struck(TURNS, 100.0)
    turn = burst[: round(RATE / SPEED_HZ)]
    # mean square over two teeth of what the band keeps of one burst
    spectrum = np.fft.rfft(turn)
    hz = np.fft.rfftfreq(turn.size, 1 / RATE)
    share = np.sum(np.abs(spectrum[(hz >= BAND[0][0]) & (hz < BAND[0][1])]) ** 2) / np.sum(np.abs(spectrum) ** 2)
    left = (1 - 3 / TEETH) ** 2  # of the amplitude at the burst: three orders of every 23 are the mesh's
    expected = size**2 * share * left * np.mean(turn**2) * TEETH / 2
    assert power(size * burst) == pytest.approx(expected, rel=0.1)


def test_mesh_balls_and_noise_are_left_out():
    burst = power(healthy(1) + struck(TURNS, 100.0))
    assert burst == pytest.approx(power(struck(TURNS, 100.0)), rel=0.2)
    assert power(healthy(1)) < 0.02 * burst
    assert power(struck(3.5731 * TURNS, 40.0)) < 0.05 * burst
    other = Turning(hz=SPEED_HZ * 23 / 81, teeth=(81,))
    assert power(struck(TURNS * 23 / 81, 40.0, size=4.0), other) > 5 * power(healthy(1), other)


def test_what_cannot_be_told_is_not_a_number():
    short = healthy(1)[: round(5 * RATE / SPEED_HZ)]
    assert np.isnan(power(short)), "two turns a half"
    assert np.isnan(power(healthy(1), top_hz=2000.0)), "the band reaches over what is trusted"
    assert np.isnan(power(healthy(1), Turning(hz=np.nan, teeth=(23,))))
