from __future__ import annotations

import pytest

from sideband_datasets.plan.identity import channel_paths, content_of, hashed, path_id_of
from signals.overrides import apply_overrides
from sim.presets import preset

PAIR = preset("gear-pair")
MODES = {"kind": "modes", "direct": 1.0, "modes": [{"frequency_hz": 3000.0, "damping_ratio": 0.05, "gain": 0.3}]}


@pytest.mark.parametrize(
    "changes",
    [
        {"name": "another"},
        {"notes": "as found"},
        {"speed_hz": 17.0},
        {"profile": {"kind": "ramp", "end_ratio": 2.0, "duration_s": 1.0}},
        {"torque_nm": 5.0},
        {"gravity": 9.81},
    ],
)
def test_words_and_operating_point_make_no_other_machine(changes):
    changed = apply_overrides(PAIR, changes)
    assert changed != PAIR
    assert content_of(changed, ()) == content_of(PAIR, ())


def test_what_a_machine_is_built_of_makes_another():
    for changes in ({"gears.pinion.face_width_m": 0.0171}, {"unbalance@pinion.moment": 1.7e-5}):
        assert content_of(apply_overrides(PAIR, changes), ()) != content_of(PAIR, ())


@pytest.mark.parametrize("key", ["gears.pinion.face_width_m", "unbalance@pinion.moment"])
def test_what_is_drawn_for_every_recording_tells_no_machines_apart(key):
    one, other = (apply_overrides(PAIR, {key: value}) for value in (0.0171, 0.0172))
    assert content_of(one, ()) != content_of(other, ())
    assert content_of(one, (key,)) == content_of(other, (key,))


def test_a_condition_that_leads_nowhere_is_left_to_who_applies_it():
    assert content_of(PAIR, ("gears.none.teeth", "speed_hz")) == content_of(PAIR, ())


def test_every_channel_has_the_hash_of_its_own_path():
    chain = {"channels": [{"name": "a", "path": MODES}, {"name": "b", "path": None}, {"name": "c", "path": MODES}]}
    found = channel_paths(chain)
    assert found == {"a": hashed(MODES), "c": hashed(MODES)}
    assert channel_paths(None) == {}


def test_the_id_of_all_paths_is_the_machine_s_own_without_any():
    bare = {"channels": [{"name": "a", "path": None}]}
    assert path_id_of("rig-0001", bare) == path_id_of("rig-0001", None) != path_id_of("rig-0002", bare)
    heard = {"channels": [{"name": "a", "path": MODES}]}
    assert path_id_of("rig-0001", heard) == path_id_of("rig-0002", heard)


def test_an_effect_of_no_size_and_the_order_of_effects_make_no_other_machine():
    one = apply_overrides(PAIR, {"unbalance@pinion.moment": 1e-5, "eccentricity@gear.amplitude": 1e-5})
    other = apply_overrides(PAIR, {"eccentricity@gear.amplitude": 1e-5, "unbalance@pinion.moment": 1e-5})
    assert one.terms != other.terms
    assert content_of(one, ()) == content_of(other, ()) != content_of(PAIR, ())
    assert content_of(apply_overrides(PAIR, {"tooth_crack@pinion.depth": 0.0}), ()) == content_of(PAIR, ())
