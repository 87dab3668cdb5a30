"""The split that one engine runs: its groups, conditions and forms; pits whose edges stand up."""

from __future__ import annotations

from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from proof import seal
from proof.effects import LIPPED, Choice
from proof.entire import (
    CLEAR,
    ENTIRE,
    HELD,
    JURY,
    MIXED,
    STRUCK,
    VAST,
    WIDE,
    YOUNG,
    Design,
    cases_of_design,
    clear,
    entire,
    held,
    jury,
    mixed,
    vast,
    wide,
    young,
)
from proof.library import CLOSED
from proof.machine import arrays_of, exact_machine
from proof.model.balls import pit
from proof.model.layout import B
from proof.one_engine import DESIGNS
from proof.others import SPLITS, cases_of
from proof.plan import FIRST, ORTHOGONAL, SENSOR_COUNTS, SNRS_DB, SPEED_COUNTS, plan
from proof.unknown import OPEN

CASES = entire()
GROUPS = ENTIRE.groups


def test_three_of_four_cases_stand_at_the_target_condition():
    assert Counter(c.group for c in CASES) == GROUPS and len({c.name for c in CASES}) == sum(GROUPS.values()) == 192
    conditions = Counter((len(c.sensors), c.snr_db, len(c.speeds_hz)) for c in CASES)
    assert conditions[3, 20.0, 3] >= 0.75 * len(CASES)
    for row in ORTHOGONAL:
        assert conditions[SENSOR_COUNTS[row[0]], SNRS_DB[row[1]], SPEED_COUNTS[row[2]]] >= 2


def test_the_first_half_is_a_sample_of_all_groups():
    half = Counter(c.group for c in CASES[:96])
    assert all(abs(half[g] - n / 2) <= 2 + 0.2 * n for g, n in GROUPS.items())


def test_every_known_and_unknown_law_of_the_usual_load_occurs_and_every_third_pit_has_a_lip():
    laws = Counter(e.law for c in CASES for e in c.effects)
    assert set(laws) >= set(OPEN) and len(set(laws) & set(CLOSED)) >= 20
    forms = Counter(e.variant for c in CASES if c.group == "single" for e in c.effects if e.law in STRUCK)
    assert forms[LIPPED] >= 0.2 * sum(forms.values()) and set(forms) == {0, 1, LIPPED}
    others = [e for s in ("dev", "sealed", "later", "third", "anew") for c in plan(s) for e in c.effects]
    assert not any(e.variant == LIPPED for e in others if e.law in STRUCK), "which no earlier split has"


@pytest.mark.parametrize("design", DESIGNS, ids=[d.split for d in DESIGNS])
def test_the_seals_were_committed(design: Design) -> None:
    assert seal.seals_of(design.split) == seal.manifest(design.split, cases_of_design(design))["sha256"]


def test_the_second_has_no_case_of_the_first_and_is_a_sample_at_any_length():
    cases = held()
    assert Counter(c.group for c in cases) == HELD.groups and len({c.name for c in cases}) == 120
    drawn, others = (
        {(e.law, e.site, e.value) for c in s if c.group != "ambiguous" for e in c.effects} for s in (cases, CASES)
    )
    assert len(drawn) > 80 and not drawn & others, "look-alikes have one size"
    assert {len(c.speeds_hz) for c in cases} == {1, 3} and not any(c.group == "misset" for c in cases)
    target = sum((len(c.sensors), c.snr_db, len(c.speeds_hz)) == (3, 20.0, 3) for c in cases)
    assert target == 86 and {len(c.sensors) for c in cases} == {1, 3, 8}
    half = Counter(c.group for c in cases[:60])
    assert all(abs(half[g] - n / 2) <= 2 + 0.2 * n for g, n in HELD.groups.items())


def test_the_third_has_no_case_of_the_others():
    cases = wide()
    assert Counter(c.group for c in cases) == WIDE.groups and len({c.name for c in cases}) == 72
    free = [c for c in cases if c.group != "ambiguous"]  # their sizes are given
    seen = {(e.law, e.site, round(e.value, 12)) for c in (*CASES, *held()) for e in c.effects}
    assert not any((e.law, e.site, round(e.value, 12)) in seen for c in free for e in c.effects)
    assert {len(c.speeds_hz) for c in cases} == {1, 3} and not any(c.group == "misset" for c in cases)


def test_the_fourth_hides_what_the_third_leaves_out():
    cases, before = mixed(), wide()
    assert Counter(c.group for c in cases) == MIXED.groups and len({c.name for c in cases}) == 72
    assert not {c.seed for c in cases} & {c.seed for c in (*CASES, *held(), *before)}, "its machines are its own"
    rare, seen = ({e.law for c in s if c.group == "single" for e in c.effects} - set(FIRST) for s in (cases, before))
    assert len(rare) == 8 and len(rare - seen) >= 6
    pairs, told = ({tuple(e.law for e in c.effects) for c in s if c.group == "double"} for s in (cases, before))
    assert len(pairs) == 8 and not pairs & told
    half = Counter(c.group for c in cases[:36])
    assert all(abs(half[g] - n / 2) <= 2 + 0.2 * n for g, n in MIXED.groups.items())


def test_the_fifth_hides_what_the_two_before_leave_out():
    cases, before = young(), (*mixed(), *wide())
    assert Counter(c.group for c in cases) == YOUNG.groups and len({c.name for c in cases}) == 72
    assert not {c.seed for c in cases} & {c.seed for c in (*CASES, *held(), *before)}, "its machines are its own"
    rare, seen = ({e.law for c in s if c.group == "single" for e in c.effects} - set(FIRST) for s in (cases, before))
    assert len(rare) == 8 and len(rare - seen) >= 5
    pairs, told = ({tuple(e.law for e in c.effects) for c in s if c.group == "double"} for s in (cases, mixed()))
    assert len(pairs) == 8 and not pairs & told


def test_the_sixth_hides_what_the_fifth_leaves_out():
    cases, before = vast(), (*young(), *mixed(), *wide())
    assert Counter(c.group for c in cases) == VAST.groups and len({c.name for c in cases}) == 72
    assert not {c.seed for c in cases} & {c.seed for c in (*CASES, *held(), *before)}, "its machines are its own"
    rare, seen = ({e.law for c in s if c.group == "single" for e in c.effects} - set(FIRST) for s in (cases, young()))
    assert len(rare) == 8 and not rare & seen
    pairs, told = ({tuple(e.law for e in c.effects) for c in s if c.group == "double"} for s in (cases, young()))
    assert len(pairs) == 8 and len(pairs - told) >= 7


def test_the_seventh_hides_what_the_sixth_leaves_out():
    cases, before = clear(), (*vast(), *young(), *mixed(), *wide())
    assert Counter(c.group for c in cases) == CLEAR.groups and len({c.name for c in cases}) == 72
    assert not {c.seed for c in cases} & {c.seed for c in (*CASES, *held(), *before)}, "its machines are its own"
    rare, seen = ({e.law for c in s if c.group == "single" for e in c.effects} - set(FIRST) for s in (cases, vast()))
    assert len(rare) == 8 and not rare & seen
    pairs, told = ({tuple(e.law for e in c.effects) for c in s if c.group == "double"} for s in (cases, vast()))
    assert len(pairs) == 8 and len(pairs - told) >= 6


def test_the_eighth_hides_what_the_seventh_leaves_out():
    cases, before = jury(), (*clear(), *vast(), *young(), *mixed(), *wide())
    assert Counter(c.group for c in cases) == JURY.groups and len({c.name for c in cases}) == 72
    assert not {c.seed for c in cases} & {c.seed for c in (*CASES, *held(), *before)}, "its machines are its own"
    rare, seen = ({e.law for c in s if c.group == "single" for e in c.effects} - set(FIRST) for s in (cases, clear()))
    assert len(rare) == 8 and not rare & seen
    pairs, told = ({tuple(e.law for e in c.effects) for c in s if c.group == "double"} for s in (cases, clear()))
    assert len(pairs) == 8 and len(pairs - told) == 8


@pytest.mark.parametrize(("latest", "last"), list(pairwise(DESIGNS))[:5])
def test_a_later_plan_hides_what_the_one_before_leaves_out(latest: Design, last: Design):
    cases, told = cases_of_design(latest), cases_of_design(last)
    before = [c for design in DESIGNS[DESIGNS.index(last) :] for c in cases_of_design(design)]
    assert Counter(c.group for c in cases) == latest.groups and len({c.name for c in cases}) == 72
    assert not {c.seed for c in cases} & {c.seed for c in before}, "its machines are its own"
    rare, seen = ({e.law for c in s if c.group == "single" for e in c.effects} - set(FIRST) for s in (cases, told))
    assert len(rare) == 8 and not rare & seen
    pairs, known = ({tuple(e.law for e in c.effects) for c in s if c.group == "double"} for s in (cases, told))
    assert len(pairs) == 8 and len(pairs - known) == 8


def test_no_two_plans_share_a_name():
    names = [c.name for split in SPLITS for c in cases_of(split)]
    assert len(names) == len(set(names))


def test_a_lip_squeezes_the_ball_before_and_behind_the_pit():
    a = arrays_of(exact_machine())
    CLOSED["outer_pit"].apply(a, Choice(site=0, value=1e-3, variant=LIPPED, rng=np.random.default_rng(2)))
    b = a.bearings[0]
    assert 1e-6 <= b[B.LIP] <= 4e-6
    radius, half = 0.025, 0.5e-3
    way = np.linspace(-1e-3, 1e-3, 4001)
    drop = np.array([pit(s / radius, 1e-3, 1e-4, radius, 100.0, b) for s in way])
    outside = np.abs(way) > half
    assert drop[outside].min() == pytest.approx(-b[B.LIP], rel=1e-3) and drop[outside].max() == 0.0
    assert np.all(drop[~outside] >= 0.0) and not np.any(drop[np.abs(way) > half + 1.01 * b[B.LIP_LENGTH]])
    assert np.max(np.abs(np.diff(drop))) < 0.1 * drop.max(), "no step"
    b[B.LIP] = 0.0
    assert not np.any(np.array([pit(s / radius, 1e-3, 1e-4, radius, 100.0, b) for s in way])[outside])
