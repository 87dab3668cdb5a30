"""Of faults of one tooth that only a burst tells the crack is said first, where it is as good as any."""

import pytest

from reconcile.machine.decide import Decision
from reconcile.machine.of_teeth import APART, AS_GOOD_TEETH, looks_like, of_teeth
from tests.reconcile.machine.screens import screen

NAMES = ("missing_tooth@pinion", "tooth_spall@pinion", "tooth_crack@pinion", "tooth_crack@gear", "unbalance@pinion")
TEETH = NAMES[:3]


def first(chosen, evidence, word="ambiguous"):
    decision = Decision(word=word, chosen=chosen, p=1e-6, reasons=("alike",))
    return of_teeth(decision, screen(evidence, names=NAMES)).chosen


def test_the_crack_comes_first_and_none_is_left_out():
    assert first(TEETH, [26.4, 25.0, 25.3]) == ("tooth_crack@pinion", "missing_tooth@pinion", "tooth_spall@pinion")


def test_what_fits_clearly_better_stays_first():
    assert first(TEETH, [26.4, 25.0, 26.3 - AS_GOOD_TEETH]) == TEETH


@pytest.mark.parametrize(
    "chosen",
    [
        ("missing_tooth@pinion", "tooth_crack@pinion", "unbalance@pinion"),
        ("missing_tooth@pinion", "tooth_crack@pinion", "tooth_crack@gear"),
        ("missing_tooth@pinion", "tooth_spall@pinion"),
    ],
)
def test_other_sets_keep_their_order(chosen):
    assert first(chosen, [26.0, 26.0, 25.9, 25.9, 25.9]) == chosen


def test_a_name_far_ahead_of_the_other_faults_of_that_gear_stays():
    decision = Decision(word="explained", chosen=TEETH[:1], p=1e-6, reasons=())
    others = ("missing_tooth@pinion", "tooth_crack@pinion", "tooth_crack@gear", "tooth_spall@gear")
    alone = of_teeth(decision, screen([26.0, 26.0 - APART, 26.0, 26.0], names=others))
    assert alone == decision, "faults of the other gear are no other name for it"


@pytest.mark.parametrize("chosen", [TEETH[0], TEETH[1]])
def test_a_broken_and_a_pitted_tooth_are_never_told_apart(chosen):
    decision = Decision(word="explained", chosen=(chosen,), p=1e-6, reasons=())
    evidence = [56.3 if name == chosen else 8.0 for name in NAMES]
    found = of_teeth(decision, screen(evidence, names=NAMES))
    assert found.word == "ambiguous" and found.chosen[0] == chosen and set(found.chosen) == set(TEETH[:2])


def test_else_it_is_the_set_of_those_that_are_near():
    decision = Decision(word="explained", chosen=TEETH[:1], p=1e-6, reasons=())
    found = of_teeth(decision, screen([34.7, 24.5, 27.0, 1.0], names=NAMES))
    assert found.word == "ambiguous" and found.reasons
    assert found.chosen == ("missing_tooth@pinion", "tooth_crack@pinion", "tooth_spall@pinion")


def test_other_names_are_left_alone():
    decision = Decision(word="explained", chosen=("unbalance@pinion",), p=1e-6, reasons=())
    assert of_teeth(decision, screen([26.0, 26.0, 26.0, 26.0, 26.5], names=NAMES)) == decision


def test_the_other_of_a_broken_and_a_pitted_tooth_is_that_gear_s():
    assert [looks_like(name) for name in NAMES] == ["tooth_spall@pinion", "missing_tooth@pinion", "", "", ""]
