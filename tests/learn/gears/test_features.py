import numpy as np
import pytest

from learn.gears import features
from learn.gears.assess import look
from learn.gears.features import BANDS, NAMES, flattened, kept

RATE, SPEED = 12_800.0, 25.0


def test_mesh_harmonics_with_low_sidebands_and_low_orders_are_removed():
    keep = kept(100, 30)
    assert not np.any(keep[:5])
    assert not np.any(keep[26:35])
    assert np.all(keep[5:26])
    assert np.all(keep[35:56])


def test_few_teeth_leave_orders_between_the_harmonics():
    assert np.sum(kept(100, 12)) > 40


def test_flattening_puts_a_resonance_level():
    rng = np.random.default_rng(0)
    lines = rng.standard_normal(600) + 1j * rng.standard_normal(600)
    lines[300:] *= 100
    power = np.abs(flattened(lines, 20)) ** 2
    assert np.mean(power[100:200]) == pytest.approx(np.mean(power[400:500]), rel=0.2)


@pytest.mark.parametrize("gear", [0, 1])
def test_a_damaged_tooth_is_one_place_of_its_own_gears_turn(stage, gear):
    samples, _ = stage(tooth=gear)
    found = look([samples], RATE, SPEED, (23, 57))
    row, which = features.vector(found)
    assert which == gear
    own, mate = found[gear].best, found[1 - gear].best
    assert own.alone > 1.5
    assert mate.alone < 0.8
    assert own.at == pytest.approx(0.3, abs=0.06)
    assert row.shape == (len(NAMES),)


def test_a_sound_stage_has_no_such_place(stage):
    sound, faulty = (features.vector(look([stage(tooth=t)[0]], RATE, SPEED, (23, 57)))[0] for t in (None, 0))
    at = NAMES.index("most_alone")
    assert sound[at] < 1.2
    assert faulty[at] > 1.8


def test_gain_does_not_matter(stage):
    samples, _ = stage(tooth=1)
    one, other = (features.vector(look([k * samples], RATE, SPEED, (23, 57)))[0] for k in (1.0, 1e-4))
    np.testing.assert_allclose(one, other, atol=1e-6)


def test_too_few_turns_of_the_slow_gear_leave_the_fast_one(stage):
    samples, _ = stage(turns=8.0, tooth=0)
    first, second = look([samples], RATE, SPEED, (23, 57))
    assert second.best is None
    row, which = features.vector((first, second))
    assert which == 0
    assert np.all(np.isfinite(row))
    assert np.all(np.isfinite(features.row(second, first)))
    assert second.most("alone") == [0.0] * len(BANDS)
