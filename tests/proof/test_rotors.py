"""Cases of rotors: sealed, told as they are drawn, and moving as the product's simulator moves the same machine."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest

from proof import case as made
from proof import seal
from proof.machine import exact_machine
from proof.model.layout import B, G, X
from proof.others import SPLITS, cases_of
from proof.rotors.machine import GRAVITY, ROTORS
from proof.rotors.plan import SITES
from proof.run_up import OVERSAMPLING, RATE_HZ, X_DOFS, Y_DOFS, accelerations, steady
from sim.core.spec import MachineSpec
from sim.solve.api import simulate

BOTH = ("rotors", "rotors-later")


@pytest.mark.parametrize("split", BOTH)
def test_every_split_has_all_groups_at_the_target_condition_on_both_machines(split):
    cases = cases_of(split)
    assert Counter(c.group for c in cases) == {"null": 5, "sensor": 3, "single": 10, "double": 2, "open": 2}
    assert {(len(c.sensors), c.snr_db, c.speeds_hz, c.baseline) for c in cases} == {
        (3, 20.0, r.speeds_hz, True) for r in ROTORS.values()
    }
    assert {hiding.site for c in cases for hiding in c.effects} <= SITES
    assert {c.torque_nm for c in cases} == {0.0}


@pytest.mark.parametrize("split", BOTH)
def test_the_committed_seals_are_those_of_the_rotors(split):
    assert seal.manifest(split, cases_of(split))["sha256"] == seal.seals_of(split)


def test_names_are_shared_with_no_other_split():
    names = [c.name for split in SPLITS for c in cases_of(split)]
    assert len(names) == len(set(names))


def test_truths_name_sites_as_the_machine_file_does():
    sites = {s for c in cases_of("rotors") for e in made.truth_of(c)["effects"] for s in e["sites"]}
    assert sites <= {"bearing1", "bearing2", "disc", "input"} and "disc" in sites


@pytest.mark.parametrize("name", list(ROTORS))
def test_the_told_machine_is_the_one_that_was_drawn(name):
    rotor = ROTORS[name]
    machine = MachineSpec.model_validate(json.loads(made.canonical(rotor.document(rotor.parameters))))
    assert [b.geometry.balls for b in machine.bearings] == [rotor.rolling.balls, rotor.second.balls]
    arrays = rotor.sound(exact_machine())
    assert arrays.bearings[:2, B.COUNT].tolist() == [rotor.rolling.balls, rotor.second.balls]
    gaps = np.diff(arrays.spread[1, : rotor.second.balls, 0])
    assert np.allclose(gaps, 2.0 * np.pi / rotor.second.balls)
    assert arrays.g[G.GRAVITY] == machine.gravity_m_per_s2 == GRAVITY
    assert arrays.x[X.UNBALANCE] == machine.terms[0].parameters["moment"]


def line_db(signal, hz):
    """Amplitude at a frequency (Hann), dB."""
    window = np.hanning(signal.size)
    turns = np.exp(-2j * np.pi * hz * np.arange(signal.size) / RATE_HZ)
    return 20.0 * np.log10(abs(np.sum(signal * window * turns)) / window.sum())


@pytest.mark.slow
@pytest.mark.parametrize("name", list(ROTORS))
def test_a_sound_rotor_shakes_as_the_products_does(name):
    rotor = ROTORS[name]
    hz = rotor.speeds_hz[1]
    machine = MachineSpec.model_validate(rotor.document(rotor.parameters))
    channels = ("resonator1.y.acceleration", "resonator2.y.acceleration", "bearing1.outer.x.acceleration")
    theirs = simulate(machine, duration_s=0.8, output_rate_hz=RATE_HZ, channels=channels)
    given = {"duration_s": 0.6, "settle_s": 0.2, "dofs": (*Y_DOFS[:2], X_DOFS[0])}
    ours = accelerations(rotor.sound(exact_machine()), steady(hz), **given)[:, ::OVERSAMPLING]
    for mine, channel in zip(ours, channels, strict=True):
        other = theirs.signal(channel)[round(0.2 * RATE_HZ) :]
        assert line_db(mine, hz) == pytest.approx(line_db(other, hz), abs=0.3)
        assert 20.0 * np.log10(np.std(mine) / np.std(other)) == pytest.approx(0.0, abs=3.0)
