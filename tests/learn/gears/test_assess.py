from dataclasses import replace

import pytest

from learn.gears.assess import LONG, SHORT, assess_stage, knows_gears, parts_of
from learn.model import default_model
from sim.core.errors import SpecError

RATE, SPEED, TEETH = 12_800.0, 25.0, (23, 57)


@pytest.mark.parametrize("gear", [0, 1])
def test_the_shipped_model_names_a_damaged_tooth_and_its_gear(stage, gear):
    found = assess_stage([stage(tooth=gear)[0]], RATE, SPEED, default_model(), TEETH)
    assert found.label == "tooth"
    assert found.probabilities["tooth"] > 0.7
    assert sum(found.probabilities.values()) == pytest.approx(1.0)
    assert found.gear == gear
    assert found.turns == pytest.approx(60, abs=0.1)


@pytest.mark.parametrize("turns", [60.0, 10.0])
def test_the_shipped_model_finds_a_modulated_sound_stage_sound(stage, turns):
    found = assess_stage([stage(turns=turns)[0]], RATE, SPEED, default_model(), TEETH)
    assert found.label == "healthy"


def test_ten_turns_show_a_clear_fault(stage):
    found = assess_stage([stage(turns=10.0, tooth=0, size=1.0)[0]], RATE, SPEED, default_model(), TEETH)
    assert (found.label, found.gear) == ("tooth", 0)


def test_a_speed_in_doubt_is_searched(stage):
    samples, _ = stage(tooth=0)
    found = assess_stage([samples], RATE, 1.01 * SPEED, default_model(), TEETH, doubt=0.005)
    assert (found.label, found.gear) == ("tooth", 0)


def test_long_recordings_are_read_in_parts_and_short_ones_refused(stage):
    samples, _ = stage(turns=230.0)
    parts = parts_of([samples], RATE, SPEED)
    assert [len(p) for p in parts] == [1, 1, 1]
    assert len({p[0].size for p in parts}) == 1
    with pytest.raises(SpecError, match="too few turns"):
        parts_of([samples[:1000]], RATE, SPEED)


def test_a_mesh_beyond_the_sampling_rate_is_refused(stage):
    samples, _ = stage()
    with pytest.raises(SpecError, match="too low to hold the mesh"):
        assess_stage([samples], RATE, SPEED, default_model(), (400, 57))


def test_a_model_without_gears_says_so():
    model = default_model()
    assert knows_gears(model)
    assert not knows_gears(replace(model, heads={k: v for k, v in model.heads.items() if k not in (SHORT, LONG)}))
