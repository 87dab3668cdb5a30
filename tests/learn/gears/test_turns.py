import numpy as np
import pytest

from learn.gears.turns import both_gears, finer, first_half, turns_of

RATE, SPEED = 12_800.0, 25.0


def angle_of(turns):
    return 2 * np.pi * SPEED / RATE * np.arange(int(turns / SPEED * RATE))


def test_finer_samples_are_those_in_between():
    x = np.cos(2 * np.pi * 5 * np.arange(64) / 64)
    np.testing.assert_allclose(finer(x), np.cos(2 * np.pi * 5 * np.arange(256) / 256), atol=1e-12)


def test_turns_of_a_pattern_are_all_alike():
    angle = angle_of(20)
    found = turns_of(finer(np.cos(7 * angle)), angle, (23, 57), 0)
    assert found.count in {19, 20}
    pattern = np.cos(7 * 2 * np.pi * np.arange(found.samples.shape[1]) / found.samples.shape[1])
    np.testing.assert_allclose(found.samples[2:-2], np.tile(pattern, (found.count - 4, 1)), atol=0.02)


def test_the_mean_turn_of_the_other_gear_is_taken_out():
    angle = angle_of(60)
    first, second = both_gears([np.cos(9 * angle) + np.cos(8 * 23 / 57 * angle)], angle, (23, 57))
    for one, order in ((first[0], 9), (second[0], 8)):
        lines = np.abs(np.fft.rfft(one.samples[2:-2].ravel())) / one.samples[2:-2].size * 2
        own = order * (one.count - 4)
        assert lines[own] == pytest.approx(1.0, abs=0.03)
        lines[own] = 0.0
        assert np.max(lines) < 0.1


def test_lines_of_both_gears_stay():
    """Of 30 and 60 teeth every second order of the large one is also the small one's."""
    angle = angle_of(60)
    _, second = both_gears([np.cos(4 * 0.5 * angle)], angle, (30, 60))
    assert np.std(second[0].samples) == pytest.approx(np.sqrt(0.5), rel=0.02)


def test_halves_let_nothing_of_a_mate_through_that_repeats_in_few_turns():
    """Of 32 and 80 teeth two turns of the large gear are five of the small one."""
    first = first_half(8, 80, 32)
    np.testing.assert_array_equal(first, [True, True, False, False] * 2)
    np.testing.assert_array_equal(first_half(8, 40, 40), [True, False] * 4)


def test_what_is_not_locked_has_no_product_of_halves():
    angle = angle_of(200)
    noise = np.random.default_rng(0).standard_normal(angle.size)
    a, b = turns_of(finer(noise), angle, (23, 57), 0).halves()
    assert abs(np.mean(a * b)) < 0.2 * np.mean(a**2)
