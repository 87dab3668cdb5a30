import pytest

from learn.gears.detector import RULE, fm4_detector

RATE, SPEED = 12_800.0, 25.0


def test_fm4_of_a_modulated_sound_stage_is_below_the_rule(stage):
    label, levels = fm4_detector([stage()[0]], RATE, SPEED, (23, 57))
    assert label == "healthy"
    assert max(levels) < RULE


@pytest.mark.parametrize("gear", [0, 1])
def test_fm4_of_a_damaged_tooths_gear_is_above_it(stage, gear):
    label, levels = fm4_detector([stage(tooth=gear, size=1.5)[0]], RATE, SPEED, (23, 57))
    assert label == "tooth"
    assert levels[gear] == max(levels)
