"""Of faults of one tooth that only a burst tells the crack is said first, where it is as good as any."""

import pytest

from reconcile.machine.decide import Decision
from reconcile.machine.of_teeth import AS_GOOD_TEETH, crack_first
from tests.reconcile.machine.screens import screen

NAMES = ("missing_tooth@pinion", "tooth_spall@pinion", "tooth_crack@pinion", "tooth_crack@gear", "unbalance@pinion")
TEETH = NAMES[:3]


def first(chosen, evidence, word="ambiguous"):
    decision = Decision(word=word, chosen=chosen, p=1e-6, reasons=("alike",))
    return crack_first(decision, screen(evidence, names=NAMES)).chosen


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


def test_a_name_is_no_set():
    assert first(("missing_tooth@pinion",), [26.0], word="explained") == ("missing_tooth@pinion",)
