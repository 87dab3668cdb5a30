"""Cases of other nominal machines: told as they are, sealed, and without any number of the paper's machine left in."""

from __future__ import annotations

import json
from collections import Counter

import numpy as np
import pytest

from proof import case as made
from proof import seal
from proof.effects import Choice
from proof.kinds import kinds
from proof.kinematic import kinematics
from proof.library import CLOSED
from proof.machine import NOMINAL, arrays_of, contact_ratio, document, exact_machine, pair_stiffness
from proof.model.layout import B, G, Tooth
from proof.model.mesh import sound_pair
from proof.nominals import KINDS, NOMINALS, PAPER
from proof.others import SPLITS, cases_of, others
from proof.plan import plan
from sim.presets.reference import reference_machine

STRANGERS = sorted(set(NOMINALS) - {PAPER})
ALL = NOMINALS | KINDS


def test_every_other_machine_has_two_sound_cases_and_four_effects_at_the_target_condition():
    cases = others()
    assert {(len(c.sensors), c.snr_db, len(c.speeds_hz), c.baseline) for c in cases} == {(3, 20.0, 3, True)}
    for machine in STRANGERS:
        mine = [c for c in cases if c.machine == machine]
        assert Counter(c.group for c in mine) == {"null": 2, "single": 4}
        assert {c.speeds_hz for c in mine} == {NOMINALS[machine].speeds_hz}
        assert {c.torque_nm for c in mine} == {NOMINALS[machine].parameters["T"]}


def test_two_further_machines_have_cases_of_all_groups_at_the_target_condition():
    cases = kinds()
    assert {(len(c.sensors), c.snr_db, len(c.speeds_hz), c.baseline) for c in cases} == {(3, 20.0, 3, True)}
    for machine, nominal in KINDS.items():
        mine = [c for c in cases if c.machine == machine]
        assert Counter(c.group for c in mine) == {"null": 2, "sensor": 1, "single": 6, "double": 2, "open": 1}
        assert {c.speeds_hz for c in mine} == {nominal.speeds_hz}
        assert all(c.level > 0 for c in mine if c.effects)


def test_names_and_machines_are_shared_with_no_other_split():
    assert cases_of("third") == plan("third")
    for mine in ("others", "kinds"):
        known = {c.name for split in SPLITS if split != mine for c in cases_of(split)}
        assert not known & {c.name for c in cases_of(mine)}
        assert len({c.rng(1).random() for c in cases_of(mine)}) == len(cases_of(mine))


def test_the_committed_seals_are_those_of_the_other_machines():
    assert seal.manifest("others", others())["sha256"] == seal.seals_of("others")
    assert seal.manifest("kinds", kinds())["sha256"] == seal.seals_of("kinds")


def test_only_the_truth_of_another_machine_says_which():
    assert "machine" not in made.truth_of(plan("dev")[0])
    assert {made.truth_of(c)["machine"] for c in others()} == set(STRANGERS)


@pytest.mark.parametrize("name", [*STRANGERS, *KINDS])
def test_the_told_machine_is_the_one_that_was_drawn(name):
    case = next(c for c in (*others(), *kinds()) if c.machine == name)
    told = json.loads(made.canonical(document(made.told(case), case.nominal.rolling)))
    machine = reference_machine(told["parameters"], bearings=told["bearings"]).machine
    given = case.nominal
    assert [g.teeth for g in machine.gears] == [given.parameters["z1"], given.parameters["z2"]]
    assert {b.geometry.balls for b in machine.bearings} == {given.rolling.balls} != {7}
    assert kinematics(told)["kinematics"]["bearings"][0]["balls"] == given.rolling.balls
    arrays = arrays_of(exact_machine(), made.told(case), given.rolling)
    assert set(arrays.bearings[:, B.COUNT]) == {given.rolling.balls}
    assert arrays.g[G.Z2] == given.parameters["z2"]
    gaps = np.diff(arrays.spread[0, : given.rolling.balls, 0])
    assert np.allclose(gaps, 2.0 * np.pi / given.rolling.balls)


def mean_stiffness(p):
    """Of the generator's mesh over a base pitch, N/m."""
    eps = contact_ratio(p)
    sums = [sum(sound_pair(s + b, eps) for b in (0, 1) if s + b < eps) for s in np.arange(200) / 200]
    return float(np.mean(sums)) * pair_stiffness(p) / pair_stiffness(NOMINAL)


@pytest.mark.slow
@pytest.mark.parametrize("name", list(ALL))
def test_mesh_stiffness_is_near_what_the_teeth_make_it(name):
    p = ALL[name].parameters
    table = reference_machine(p, bearings=document(p, ALL[name].rolling)["bearings"]).machine.meshes[0].table
    assert mean_stiffness(p) == pytest.approx(np.mean(table.stiffness_n_per_m), rel=0.17)


@pytest.mark.parametrize("name", [*STRANGERS, *KINDS])
@pytest.mark.parametrize("site", [0, 1])
def test_damaged_teeth_are_teeth_that_the_gear_has(name, site):
    p = ALL[name].parameters
    teeth = int(p[("z1", "z2")[site]])
    crack, pitch = CLOSED["root_crack"], CLOSED["tooth_pitch"]
    met = set()
    for seed in range(12 * teeth):
        machine = arrays_of(exact_machine(), p)
        crack.apply(machine, Choice(site=site, value=0.1, variant=0, rng=np.random.default_rng(seed)))
        met |= set(np.flatnonzero(machine.teeth[site, :, Tooth.CRACK]))
    assert met == set(range(teeth))
    pitch.apply(machine, Choice(site=site, value=1e-6, variant=0, rng=np.random.default_rng(1)))
    assert np.flatnonzero(machine.teeth[site, :, Tooth.PITCH]).tolist() == list(range(teeth))
