"""What the card says of all machines of a family."""

from sideband_datasets.folder.held import held
from tests.sideband_datasets.small import document, tiny


def test_drawing_settings_effects_and_profile_of_all_machines_are_told():
    (rotor,) = document()["machines"]
    ramp = {"profile.kind": "ramp", "profile.end_ratio": 1.5, "profile.duration_s": 0.4}
    settings = {"pedestal_looseness@bearing1.loss": 0.25, "bearings.bearing1.radial_clearance_m": 2e-6, **ramp}
    ((name, words),) = held(tiny(machines=[{**rotor, "set": settings}]))
    assert name == rotor["name"] and "preset `rotor`" in words
    assert "`pedestal_looseness@bearing1` (loss 0.25" in words
    assert "`bearings.bearing1.radial_clearance_m` 2e-06" in words
    assert "kind ramp" in words and "end_ratio 1.5" in words
    ((_, plain),) = held(tiny())
    assert "profile" not in plain and "looseness" not in plain
