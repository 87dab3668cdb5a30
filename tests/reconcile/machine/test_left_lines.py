"""What is left of single lines: a name's limit, and none of the known where lines changed for sure."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

import pytest

from reconcile.judge.adequacy import Rest
from reconcile.machine.decide import (
    CLEAR_P,
    GREAT,
    LEFT_OVER,
    LITTLE_LEFT,
    NO_PATTERN,
    SOME_PATTERN,
    STRANGE,
    Decision,
    decide,
)
from reconcile.machine.left_lines import AMPLE, LEAST_LEFT_ELSEWHERE, LEAST_LEFT_UNKNOWN, UNMET, leaves_little
from tests.reconcile.machine.screens import screen

LITTLE = Rest(unmet=1.4, elsewhere=1.4, kept=0.25, pooled=0.26, rough=False)
BELOW = SOME_PATTERN - 0.1
changed = partial(screen, p_lines=CLEAR_P, rest=LITTLE, strongest=GREAT - 1.0)


def said(found: Decision) -> tuple[str, str]:
    return found.word, found.reasons[0]


def test_a_little_more_left_of_single_lines_than_usual_is_neither_a_name_nor_unknown_physics() -> None:
    little = Rest(unmet=LEAST_LEFT_UNKNOWN - 0.1, kept=0.3, pooled=0.4, rough=False)
    other = replace(little, unmet=0.0, elsewhere=LEAST_LEFT_ELSEWHERE - 0.1)
    for rest in (little, other):
        found = decide(changed([AMPLE - 0.1, 8.0], rest=rest), views=9)
        assert said(found) == ("not_decidable", LITTLE_LEFT) and found.chosen
    faint = screen([2.0, 1.0], rest=little, strongest=20.0)
    assert decide(faint, views=9).word == "not_decidable", "no pattern either"
    worse = changed([20.0, 15.0], rest=little, misfit=STRANGE + 0.01)
    assert decide(worse, views=9).word == "unknown_physics", "by all features"


def test_the_little_that_an_ample_pattern_leaves_is_a_remark() -> None:
    """Loose rings and feet whose draws come near, and not all the way (tw052 and tw010 of the proof)."""
    assert said(decide(changed([AMPLE, 5.0]), views=9)) == ("explained", LEFT_OVER)
    several = decide(changed([AMPLE, AMPLE - 1.0]), views=9)
    assert several.word == "ambiguous" and len(several.chosen) == 2
    much = replace(LITTLE, unmet=LEAST_LEFT_UNKNOWN, elsewhere=LEAST_LEFT_UNKNOWN)
    assert decide(changed([AMPLE, 8.0], rest=much), views=9).word == "unknown_physics", "more than a little"
    odd = changed([AMPLE, 8.0], misfit=STRANGE + 0.01)
    assert decide(odd, views=9).word == "unknown_physics", "by all features"
    assert LEFT_OVER in several.reasons, "told beside a set as well"
    few = (decide(changed([AMPLE, 5.0]), views=views) for views in (2, 3, 4))
    assert [one.word for one in few] == ["not_decidable", "not_decidable", "explained"], "so few views fit by chance"
    usual = changed([AMPLE, 5.0], p_lines=1.01 * CLEAR_P)
    assert said(decide(usual, views=9)) == ("not_decidable", LITTLE_LEFT)
    place = ("rub@gear", "unbalance@gear", "rub@pinion")
    here = decide(changed([AMPLE + 4.0, AMPLE, 1.0], place), views=9)
    assert (here.word, here.chosen) == ("ambiguous", place[:2]), "the place is told as before"
    assert LEFT_OVER not in here.reasons


@pytest.mark.parametrize("best", [2.0, 3.1, BELOW])
def test_lines_that_changed_for_sure_and_are_like_nothing_known_are_unknown_however_little_is_left(best: float) -> None:
    found = decide(changed([best, best - 1.0]), views=9)
    assert said(found) == ("unknown_physics", NO_PATTERN)


def test_so_they_are_not_where_something_is_like_them_or_lines_or_views_say_too_little() -> None:
    assert said(decide(changed([SOME_PATTERN, 4.0]), views=9)) == ("not_decidable", LITTLE_LEFT)
    forms = ("fit_clearance@b", "fit_clearance_series@b", "bearing_stiffness@c")
    merged = changed([4.9, 4.9, 5.4], forms)
    assert said(decide(merged, views=9)) == ("not_decidable", LITTLE_LEFT), "the best of all, not of what counts first"
    for p in (1.01 * CLEAR_P, 1.0):
        assert said(decide(changed([BELOW, 4.0], p_lines=p), views=9)) == ("not_decidable", LITTLE_LEFT)
    unasked = changed([BELOW, 4.0], p_lines=1.0, lines_asked=False)
    assert said(decide(unasked, views=9)) == ("not_decidable", LITTLE_LEFT), "lines of no teeth do not repeat"
    for best in (2.0, BELOW):
        assert decide(changed([best, best - 1.0]), views=2).word == "not_decidable", "so few views fit by chance"


def test_what_is_left_of_lines_that_are_usual_says_nothing() -> None:
    much = replace(LITTLE, unmet=2.5, elsewhere=2.5)
    for best in (3.1, 9.0, 20.0):  # more than a little is left
        usual = changed([best, best - 1.0], rest=much, p_lines=1.01 * CLEAR_P)
        assert said(decide(usual, views=9)) == ("not_decidable", LITTLE_LEFT)
        assert decide(replace(usual, p_lines=CLEAR_P), views=9).word == "unknown_physics"
        assert decide(replace(usual, lines_asked=False), views=9).word == "unknown_physics", "nothing says they are"
    odd = changed([9.0, 8.0], rest=much, p_lines=1.0, misfit=STRANGE + 0.01)
    assert decide(odd, views=9).word == "unknown_physics", "by all features"


@pytest.mark.parametrize(
    ("unmet", "elsewhere", "little"),
    [
        (UNMET, LEAST_LEFT_ELSEWHERE - 0.01, True),
        (UNMET, LEAST_LEFT_ELSEWHERE, False),
        (UNMET + 0.01, LEAST_LEFT_UNKNOWN - 0.01, True),
        (UNMET + 0.01, LEAST_LEFT_UNKNOWN, False),
        (LEAST_LEFT_UNKNOWN, 0.0, False),
    ],
)
def test_other_lines_may_be_left_as_far_only_where_none_of_the_fitted_are(
    unmet: float, elsewhere: float, little: bool
) -> None:
    assert leaves_little(replace(LITTLE, unmet=unmet, elsewhere=elsewhere)) == little
    assert not leaves_little(replace(LITTLE, unmet=unmet, elsewhere=elsewhere, rough=True))
