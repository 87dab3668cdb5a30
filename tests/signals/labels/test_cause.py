"""Causes by counterfactual: levels of lines, and the rules by which several effects share one."""

import numpy as np
import pytest
from gearbox import BASES, labelled, sines
from hypothesis import given
from hypothesis import strategies as st

from signals.floor import FloorSettings, noise_floor
from signals.labels.cause import coalitions, orders_of, places_hz, read_lines, removed_db, shares, split
from signals.series import FloatArray
from signals.spectra import amplitude_spectrum

LINES = {690.0: 1.0, 660.3: 0.02, 1234.5678: 0.3}


def row(*values: float) -> FloatArray:
    return np.array(values, dtype=np.float64)


def test_a_label_is_read_back_as_its_sum() -> None:
    assert orders_of("1*f_m-1*f_r1") == (("f_m", 1), ("f_r1", -1))
    assert orders_of("12*f_o1") == (("f_o1", 12),)
    assert orders_of("2*f_m-1*f_o1+1*f_r1") == (("f_m", 2), ("f_o1", -1), ("f_r1", 1))


@pytest.mark.slow
def test_lines_follow_another_machines_kinematics() -> None:
    peaks = [p for p in labelled({690.0: 1.0, BASES["f_o1"]: 0.1}).peaks if p.amplitude]
    slower = BASES | {"f_o1": 70.0}
    assert places_hz(peaks, slower) == pytest.approx([70.0, 690.0])


def test_lines_are_read_at_their_exact_place_and_noise_is_told() -> None:
    spectrum = amplitude_spectrum(sines(LINES))
    wanted = row(*LINES, 2000.1)
    found = read_lines(spectrum, wanted, noise_floor(spectrum, FloorSettings(), wanted))
    assert found.amplitude[:3] == pytest.approx(list(LINES.values()), rel=0.01)
    assert found.lost.tolist() == [False, False, False, True]
    assert found.amplitude[3] < 1e-4


def test_removed_in_decibels() -> None:
    drop = removed_db(row(1.0, 1.0, 1.0, 1.0), row(0.1, 1.0, 10.0, 0.0))
    assert drop == pytest.approx([20.0, 0.0, -20.0, 120.0])


def test_every_coalition_up_to_three_effects() -> None:
    for count in range(4):
        rule, groups = coalitions(count)
        assert rule == "shapley_power"
        assert len(set(groups)) == len(groups) == 2**count - 1
    rule, groups = coalitions(5)
    assert rule == "leave_one_out_power" and len(groups) == 6 and frozenset() in groups


def test_shares_of_effects_that_add_are_their_powers() -> None:
    """Powers 1, 2, 4 that simply add to a base of 1: shares in the same proportion."""
    worth = (1.0, 2.0, 4.0)
    for count in (1, 2, 3):
        rule, groups = coalitions(count)
        power = {g: row(1.0 + sum(worth[i] for i in g)) for g in (*groups, frozenset(range(count)))}
        total = 1.0 + sum(worth[:count])
        assert shares(power, count, rule)[:, 0] == pytest.approx([w / total for w in (*worth[:count], 1.0)])


def test_two_effects_that_need_each_other_share_equally() -> None:
    power = {frozenset({0, 1}): row(6.0), frozenset({0}): row(0.0), frozenset({1}): row(0.0), frozenset(): row(0.0)}
    assert shares(power, 2, "shapley_power")[:, 0] == pytest.approx([0.5, 0.5, 0.0])


def test_an_effect_that_weakens_a_line_has_no_share() -> None:
    power = {frozenset({0}): row(1.0), frozenset(): row(4.0)}
    assert shares(power, 1, "shapley_power")[:, 0] == pytest.approx([0.0, 1.0])


@given(st.lists(st.floats(0.0, 1e6), min_size=8, max_size=8))
def test_shares_add_up_to_one(worths: list[float]) -> None:
    rule, groups = coalitions(3)
    power = dict(zip((*groups, frozenset(range(3))), (row(w) for w in worths), strict=True))
    found = shares(power, 3, rule)
    assert np.all(found >= 0)
    assert found.sum() == pytest.approx(1.0) or not np.any(found)


def test_a_dummy_has_no_share_and_equals_have_equal_shares() -> None:
    """Two axioms of Shapley's value, on a game where 0 and 1 are alike and 2 does nothing."""
    worth = {0: 1.0, 1: 3.0, 2: 10.0}
    rule, groups = coalitions(3)
    power = {g: row(worth[len(g & {0, 1})]) for g in (*groups, frozenset(range(3)))}
    found = shares(power, 3, rule)[:, 0]
    assert found[2] == pytest.approx(0.0, abs=1e-12) and found[0] == pytest.approx(found[1])


def test_the_base_machine_is_split_among_its_excitations() -> None:
    lacking = {frozenset({0}): row(4.0, 0.0, 20.0), frozenset({1}): row(9.0, 0.0, 10.0)}
    parts = split(row(10.0, 10.0, 10.0), lacking, 2)
    assert parts[:, 0] == pytest.approx([0.6, 0.1, 0.3])
    assert parts[:, 1] == pytest.approx([0.5, 0.5, 0.0])  # each of two is necessary: they share
    assert parts[:, 2] == pytest.approx([0.0, 0.0, 1.0])  # taking one away makes the line grow


def test_a_pair_that_each_suffice_or_cancel_share_what_both_make() -> None:
    either = {frozenset({0}): row(10.0, 16.0), frozenset({1}): row(10.0, 9.0), frozenset({0, 1}): row(0.0, 0.0)}
    parts = split(row(10.0, 1.0), either, 2)
    assert parts[:, 0] == pytest.approx([0.5, 0.5, 0.0])  # each makes the line by itself
    # amplitudes 3 and 4 against each other leave 1: power (1 - 16 + 9) / 2 = -3 and (1 - 9 + 16) / 2 = 4
    assert parts[:, 1] == pytest.approx([0.0, 1.0, 0.0])


def test_an_effect_without_which_the_line_grows_may_have_a_share() -> None:
    """Alone 0 makes a power of 6 and 1 one of 4; together they leave 2: 0 adds (6 - 2) / 2 on the mean, 1 nothing."""
    power = {frozenset({0, 1}): row(2.0), frozenset({0}): row(6.0), frozenset({1}): row(4.0), frozenset(): row(0.0)}
    assert shares(power, 2, "shapley_power")[:, 0] == pytest.approx([1.0, 0.0, 0.0])
    assert shares(power, 2, "leave_one_out_power")[:, 0] == pytest.approx([0.0, 0.0, 0.0])
    lacking = {frozenset({0}): row(4.0), frozenset({1}): row(6.0), frozenset({0, 1}): row(0.0)}
    assert split(row(2.0), lacking, 2)[0] == pytest.approx([1.0])


def test_removing_nothing_explains_nothing() -> None:
    assert split(row(2.0, 3.0), {}, 0) == pytest.approx(np.ones((1, 2)))
