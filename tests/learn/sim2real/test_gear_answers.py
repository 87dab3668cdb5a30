import numpy as np
import pytest

from learn.model import default_model
from learn.real.load import Case
from learn.sim2real.answers import units
from learn.sim2real.gear_answers import GearsByModel, by_fm4, gear_ways
from learn.sim2real.gear_table import WINDOWS, windows_of
from learn.simulate.gear_rows import GearRow

RATE, SPEED, TEETH = 12_800.0, 25.0, (23, 57)


@pytest.fixture
def case(stage):
    def make(tooth):
        return Case(
            rig="made",
            name="one",
            label="healthy" if tooth is None else "tooth",
            channels=np.stack([stage(tooth=tooth, size=1.5)[0]]),
            rate_hz=RATE,
            speed_hz=SPEED,
            stated_hz=1.01 * SPEED,
            orders=None,
            size=None,
            teeth=TEETH,
        )

    return make


@pytest.mark.slow
@pytest.mark.parametrize("tooth", [None, 1])
def test_a_made_stage_is_answered_with_the_speed_given_and_near_the_stated_one(case, tooth):
    made = case(tooth)
    unit = units(made)[0]
    for way in (GearsByModel(model=default_model()), GearsByModel(model=default_model(), near=True), by_fm4):
        assert way(unit).label == made.label
    assert "57 teeth" in GearsByModel(model=default_model())(unit).detail or tooth is None


def test_without_gears_there_are_no_answers():
    assert gear_ways([], default_model(), None) == ([], [], [])


def test_windows_are_ten_turns_of_all_channels():
    row = GearRow(
        machine=3,
        label="healthy",
        fault="sound",
        channels=np.zeros((2, 20_000)),
        rate_hz=RATE,
        speed_hz=SPEED,
        teeth=TEETH,
        place=None,
        clear_db=0.0,
    )
    found = windows_of(row)
    assert [w.shape for w in found] == [(2, int(10 * RATE / SPEED))] * WINDOWS
