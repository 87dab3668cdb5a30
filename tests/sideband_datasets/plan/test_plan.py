from __future__ import annotations

from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sideband_datasets import make_plan, recipe_named
from sideband_datasets.plan import drawing, estimate
from sideband_datasets.plan.plan import planned
from sideband_datasets.recipe import RECIPES
from sim.core.errors import SpecError
from tests.sideband_datasets.small import OUTER, document, tiny


def _machines(instances: int) -> list[dict[str, object]]:
    return [{**document()["machines"][0], "instances": instances}]


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(
    count=st.integers(1, 300),
    instances=st.integers(3, 25),
    healthy=st.floats(0, 0.9),
    shares=st.lists(st.floats(0.1, 1), min_size=1, max_size=3),
    seed=st.integers(0, 2**32 - 1),
)
def test_classes_and_splits_are_exact_and_no_machine_stands_in_two(count, instances, healthy, shares, seed):
    total = sum(shares)
    splits = {f"s{k}": share / total for k, share in enumerate(shares)}
    recipe = tiny(count=count, machines=_machines(instances), healthy_share=healthy, splits=splits, seed=seed)
    plan = planned(recipe)
    exact = np.array([healthy, (1 - healthy) / 2, (1 - healthy) / 2]) * count
    assert np.all(np.abs(np.bincount(plan.kind, minlength=3) - exact) < 1 + 1e-6)
    for name, share in splits.items():
        assert abs(plan.of_split(name).size - share * count) < 1 + 1e-6
    seen: dict[int, set[str]] = {}
    for number in range(count):
        seen.setdefault(int(plan.machine[number]), set()).add(plan.split(number))
    assert all(len(found) == 1 for found in seen.values())
    assert set(plan.split_of.tolist()) == set(range(len(shares)))


@pytest.mark.slow
@settings(max_examples=10, deadline=None)
@given(st.sampled_from(["sobol", "latin_hypercube", "factorial"]), st.integers(0, 100))
def test_what_is_drawn_lies_in_its_range_and_is_the_same_every_time(kind, seed):
    recipe = tiny(plan=kind, seed=seed, count=30)
    plan = planned(recipe)
    for number in range(30):
        drawn = drawing(plan, number)
        assert 25 <= drawn.spec.operating.speed_hz <= 40
        assert drawn == drawing(plan, number)
        for effect in drawn.effects:
            if effect.term == "outer_spall":
                assert 5e-4 <= effect.severity <= 3e-3
                assert effect.parameter == "width"
        support = drawn.spec.bearings[0].support.stiffness_y_n_per_m
        assert 2.5e7 * (1 - 1e-12) <= support <= 1e8 * (1 + 1e-12)
        assert 5e-5 <= drawn.chain.channels[0].noise.density_per_sqrt_hz <= 5e-3


def test_every_split_has_every_class():
    plan = planned(tiny(count=60, machines=_machines(10)))
    found = Counter((plan.split(i), int(plan.kind[i])) for i in range(60))
    assert all(found[split, kind] >= 8 for split in ("train", "test") for kind in range(3))
    assert not plan.warnings


def test_a_class_that_a_split_lacks_is_warned_of():
    assert any("does not occur" in told for told in planned(tiny(count=3)).warnings)


def test_a_sobol_plan_fills_the_range_evenly():
    plan = planned(tiny(count=192))
    speeds = [drawing(plan, i).spec.operating.speed_hz for i in range(192) if plan.kind[i] == 0]
    slices = np.histogram(speeds, bins=8, range=(25, 40))[0]
    assert slices.min() >= 6
    assert slices.max() <= 10


def test_a_machine_keeps_its_parameters_in_all_its_recordings():
    plan = planned(tiny(count=40))
    first: dict[str, float] = {}
    for i in range(40):
        drawn = drawing(plan, i)
        value = drawn.spec.bearings[0].support.stiffness_y_n_per_m
        assert first.setdefault(drawn.machine.machine_id, value) == value
        assert drawn.seed == drawn.machine.seed
    assert len(set(first.values())) == 4


def test_compound_faults_have_every_effect():
    plan = planned(tiny(count=30))
    drawn = next(drawing(plan, i) for i in range(30) if plan.kind[i] == 2)
    assert drawn.fault_type == "both"
    assert [effect.term for effect in drawn.effects] == ["outer_spall", "unbalance"]
    assert {t.term for t in drawn.spec.terms} >= {"outer_spall", "unbalance"}


PATH = {"kind": "modes", "modes": [{"frequency_hz": 3000, "damping_ratio": 0.05, "gain": 1.0}]}


def _with_path(vary: dict[str, object]) -> list[dict[str, object]]:
    chosen = document()["measurement"]
    chosen[0]["chain"]["channels"][0]["path"] = PATH
    return [{**chosen[0], "vary": vary}]


def test_one_path_for_all_machines_is_refused():
    with pytest.raises(SpecError, match="transfer path"):
        planned(tiny(measurement=_with_path({})))


def test_paths_of_their_own_are_told_apart():
    vary = {"channels.de.path.modes.0.frequency_hz": {"low": 1000, "high": 5000}}
    plan = planned(tiny(measurement=_with_path(vary)))
    assert len({m.path_id for m in plan.machines}) == 4


def test_machines_that_are_all_alike_are_refused():
    machine = {"name": "rotor", "preset": "rotor", "instances": 4}
    with pytest.raises(SpecError, match="same parameters"):
        planned(tiny(machines=[machine]))


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"faults": [{"name": "x", "terms": [{"term": "outer_spal"}]}]}, "did you mean outer_spall"),
        ({"faults": [{"name": "x", "terms": [{**OUTER, "parameters": {"widht": 1e-3}}]}]}, "did you mean width"),
        ({"faults": [{"name": "x", "terms": [{**OUTER, "parameters": {"width": 1.0}}]}]}, "out of bounds"),
        ({"faults": [{"name": "x", "terms": [{**OUTER, "sites": ["bearing9"]}]}]}, "faults.0.terms.0.sites"),
        ({"windows": {"per_recording": 3, "length_s": 0.05}}, "duration_s: 3 windows need 0.15 s"),
        ({"windows": {"length_revolutions": 10}}, "at 25 Hz"),
        ({"splits": {"a": 0.2, "b": 0.2, "c": 0.2, "d": 0.2, "e": 0.2}}, "5 splits need as many machines"),
        ({"windows": {"length_s": 1e-5}}, "windows.length_s: is too short"),
        ({"speeds_hz": {"low": 30, "high": 1800}}, "speeds_hz.high: .*if rpm were meant"),
        ({"torques_nm": 5}, "torques_nm: needs a machine with one torque"),
        ({"faults": [{"name": "x", "terms": [{**OUTER, "sites": ["bearing1"]}] * 2}]}, "acts at every one of these"),
        ({"conditions": {"bearings.bearing7.cage_phase_rad": 1.0}}, "bearing7"),
    ],
)
def test_what_cannot_be_made_is_told_by_its_field(changes, told):
    with pytest.raises(SpecError, match=told):
        make_plan(tiny(**changes))


def test_every_name_that_is_chosen_among_is_tried():
    """Also one that no recording of the first drawings has."""
    vary = {"bearings.drive_end.catalogue": {"choices": ["6205", "NU205"]}, "bodies.disc.mass_kg": {"factor": [0.5, 2]}}
    machines = [{"name": "rig", "preset": "bearing-rig", "instances": 12, "vary": vary}]
    chain = {"channels": [{"name": "de", "kind": "accelerometer", "place": {"location": "drive_end.outer"}}]}
    changes = {"machines": machines, "measurement": [{"name": "stud", "chain": chain}], "count": 24}
    with pytest.raises(SpecError, match="NU205"):
        make_plan(tiny(**changes))
    vary["bearings.drive_end.catalogue"]["choices"][1] = "6206"
    chosen = {m.spec.bearings[0].catalogue for m in make_plan(tiny(**changes)).machines}
    assert chosen == {"6205", "6206"}


def test_two_spalls_of_one_fault_never_share_a_bearing():
    plan = planned(tiny(count=20, faults=[{"name": "two", "terms": [OUTER, OUTER]}]))
    for i in range(20):
        assert len({effect.site for effect in drawing(plan, i).effects}) == 2 * (plan.kind[i] > 0)


def test_what_is_too_large_is_refused_before_it_starts():
    with pytest.raises(SpecError, match="too many rows"):
        estimate(
            make_plan(
                tiny(count=3000, duration_s=0.2, windows={"per_recording": 1000, "length_s": 0.0021, "overlap": 0.95})
            ),
            2,
        )
    with pytest.raises(SpecError, match="too large to be simulated 8 at a time"):
        estimate(make_plan(tiny(duration_s=60, sampling_rate_hz=500_000)), 2)


def test_a_stage_that_is_not_there_is_told_by_its_place():
    chosen = document()["measurement"]
    chosen[0]["each"] = {"channels.nde.noise.density_per_sqrt_hz": {"low": 1, "high": 2}}
    with pytest.raises(SpecError, match=r"measurement\.0\.each\.channels\.nde.*it is null"):
        make_plan(tiny(measurement=chosen))


def _two_families() -> dict[str, object]:
    rotor, chain = document()["machines"][0], document()["measurement"][0]
    rig = {
        "name": "rig",
        "preset": "bearing-rig",
        "instances": 2,
        "vary": {"bodies.disc.mass_kg": {"factor": [0.5, 2]}},
    }
    place = {"location": "resonator1"}
    channels = [{"name": name, "kind": "accelerometer", "place": place} for name in ("a", "b")]
    chains = [{**chain, "machines": ["rotor"]}, {"name": "pad", "machines": ["rig"], "chain": {"channels": channels}}]
    return {"machines": [rotor, rig], "measurement": chains, "faults": [{"name": "outer", "terms": [OUTER]}]}


def test_families_have_sensors_of_their_own():
    plan = make_plan(tiny(**_two_families()))
    assert {(m.family, plan.recipe.measurement[m.measurement].name) for m in plan.machines} == {
        ("rotor", "stud"),
        ("rig", "pad"),
    }
    for i in range(12):
        drawn = drawing(plan, i)
        assert drawn.measurement == {"rotor": "stud", "rig": "pad"}[drawn.machine.family]


def test_a_family_without_a_sensor_is_refused():
    changes = _two_families()
    changes["measurement"] = changes["measurement"][:1]
    with pytest.raises(SpecError, match=r"measurement: has nothing for some machines.*rig"):
        tiny(**changes)


def test_a_path_drawn_for_every_recording_is_refused():
    chosen = document()["measurement"]
    chosen[0]["each"] = {"channels.de.mounting.frequency_hz": {"low": 4000, "high": 9000}}
    with pytest.raises(SpecError, match="belongs to the machine"):
        make_plan(tiny(measurement=chosen))


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(RECIPES))
def test_ready_recipes_can_be_planned_and_estimated(name):
    plan = make_plan(recipe_named(name))
    assert not plan.warnings
    expected = estimate(plan, 2)
    assert expected.rows == plan.rows
    assert expected.core_seconds > 0
