"""The plan is fixed, balanced, and its names give nothing away."""

from __future__ import annotations

from collections import Counter
from itertools import combinations, pairwise

import pytest

from proof.library import CLOSED
from proof.plan import COUNTS, EXTRA, FAULTS, FIRST, PAIRS, SHOWN_PAIRS, plan
from proof.sensor_faults import FAULTS as KNOWN_FAULTS
from proof.unknown import OPEN


@pytest.mark.parametrize(
    ("split", "least"),
    [
        ("dev", 60),
        ("sealed", 200),
        ("later", 90),
        ("third", 36),
        ("fourth", 18),
        ("quiet", 40),
        ("unmet", 18),
        ("next", 20),
        ("beside", 20),
        ("pitted", 15),
        ("anew", 25),
    ],
)
def test_the_plan_is_the_same_every_time_and_as_large_as_stated(split, least):
    cases = plan(split)
    assert cases == plan(split)
    counts = Counter(COUNTS[split]) + Counter(group for group, _ in EXTRA[split])
    assert Counter(c.group for c in cases) == counts
    assert len(cases) >= least


def test_names_do_not_follow_the_groups():
    groups = [c.group for c in plan("sealed")]
    changes = sum(a != b for a, b in pairwise(groups))
    assert changes > 0.6 * len(groups)


def test_half_of_the_single_effects_stand_at_the_target_condition():
    single = [c for c in plan("sealed") if c.group == "single"]
    target = [c for c in single if (len(c.sensors), c.snr_db, len(c.speeds_hz)) == (3, 20.0, 3)]
    assert 0.4 <= len(target) / len(single) <= 0.65
    for law in FIRST:
        at_target = [c for c in target if c.effects[0].law == law]
        all_of_law = [c for c in single if c.effects[0].law == law]
        assert 0.3 <= len(at_target) / len(all_of_law) <= 0.8, law


def test_the_third_split_stands_at_the_target_condition_with_every_severity():
    cases = plan("third")
    assert {(len(c.sensors), c.snr_db, len(c.speeds_hz), c.baseline) for c in cases} == {(3, 20.0, 3, True)}
    assert {c.level for c in cases if c.group == "single"} == {0, 1, 2, 3}
    assert {c.effects[0].law for c in cases if c.group == "single"} > set(FIRST)


def test_the_fourth_split_has_pairs_of_which_both_may_show():
    cases = plan("fourth")
    assert {(len(c.sensors), c.snr_db, len(c.speeds_hz), c.baseline) for c in cases} == {(3, 20.0, 3, True)}
    pairs = [tuple(e.law for e in c.effects) for c in cases if c.group == "double"]
    assert sorted(pairs) == sorted(SHOWN_PAIRS) and not {law for pair in pairs for law in pair} & {
        "root_crack",
        "run_out",
    }
    assert {c.level for c in cases if c.group == "double"} == {1, 2, 3}


def test_every_condition_and_severity_occurs():
    cases = [c for c in plan("sealed") if c.group == "single"]
    assert {len(c.sensors) for c in cases} == {1, 3, 8}
    assert {c.snr_db for c in cases} == {10.0, 20.0, 30.0}
    assert {len(c.speeds_hz) for c in cases} == {1, 3, 5}
    assert {c.level for c in cases} == {0, 1, 2, 3}
    assert min(Counter(c.level for c in cases).values()) >= 8


def test_the_laws_that_matter_most_are_run_most_and_none_twice_as_often_as_another():
    counts = Counter(c.effects[0].law for c in plan("sealed") if c.group == "single")
    assert all(counts[law] == 10 for law in FIRST)
    assert len(counts) >= 24


def test_at_least_six_laws_of_no_library():
    seen = {c.effects[0].law for c in plan("sealed") if c.group == "open"}
    assert seen == set(OPEN)
    assert len(OPEN) >= 6
    assert not any(OPEN[law].terms for law in OPEN)


@pytest.mark.parametrize(("one", "other"), [*combinations(COUNTS, 2)])
def test_splits_share_no_machine(one, other):
    first = {c.name: c.rng(1).random() for c in plan(one)}
    second = {c.name: c.rng(1).random() for c in plan(other)}
    assert not set(first.values()) & set(second.values())
    assert not set(first) & set(second)


def test_tables_agree():
    assert set(FAULTS) == set(KNOWN_FAULTS)
    assert all(law in CLOSED for pair in PAIRS for law in pair)


@pytest.mark.parametrize("split", [*COUNTS])
def test_every_effect_fits_its_law(split):
    for case in plan(split):
        for hiding in case.effects:
            law = hiding.about()
            assert hiding.site in law.sites
            assert 0.8 * law.levels[0] <= hiding.value <= 1.2 * law.levels[3]
            assert 0 <= hiding.variant < law.variants
