"""What little is left of single lines: none of the known where nothing known is like the change."""

from __future__ import annotations

from dataclasses import replace

from reconcile.judge.adequacy import Rest
from reconcile.machine.decide import CLEAR_P, LITTLE_LEFT, SOME_PATTERN, STRANGE, decide
from reconcile.machine.left_lines import LEAST_LEFT_ELSEWHERE, LEAST_LEFT_UNKNOWN
from tests.reconcile.machine.screens import NAMES, screen


def test_a_little_more_left_of_single_lines_than_usual_is_neither_a_name_nor_unknown_physics() -> None:
    little = Rest(unmet=LEAST_LEFT_UNKNOWN - 0.1, kept=0.3, pooled=0.4, rough=False)
    other = replace(little, unmet=0.0, elsewhere=LEAST_LEFT_ELSEWHERE - 0.1)
    for rest in (little, other):
        found = decide(screen([20.0, 15.0], rest=rest), views=9)
        assert (found.word, found.reasons) == ("not_decidable", (LITTLE_LEFT,)) and found.chosen
    faint = screen([2.0, 1.0], rest=little, strongest=20.0)
    assert decide(faint, views=9).word == "not_decidable", "no pattern either"
    near = decide(screen([20.0, 19.0], rest=other), views=9)
    assert (near.word, near.chosen) == ("ambiguous", NAMES[:2]), "nothing is left of what they were fitted to"
    assert decide(screen([11.0, 10.0], rest=other), views=9).word == "not_decidable"
    assert decide(screen([20.0, 19.0], rest=little), views=9).word == "not_decidable"
    assert decide(screen([20.0] * len(NAMES), rest=other), views=9).word == "not_decidable"
    worse = screen([20.0, 15.0], rest=little, misfit=STRANGE + 0.01)
    assert decide(worse, views=9).word == "unknown_physics", "by all features"


def test_lines_that_changed_for_sure_and_have_no_pattern_are_unknown_however_little_is_left() -> None:
    little = Rest(unmet=1.4, kept=0.25, pooled=0.26, rough=False)
    sure = {"rest": little, "p_lines": CLEAR_P}
    assert decide(screen([SOME_PATTERN - 0.1, 4.0], **sure), views=9).word == "unknown_physics"  # type: ignore[arg-type]
    assert decide(screen([2.0, 1.0], **sure), views=9).word == "unknown_physics"  # type: ignore[arg-type]
    assert decide(screen([SOME_PATTERN, 4.0], **sure), views=9).reasons == (LITTLE_LEFT,)  # type: ignore[arg-type]
    unsure = replace(screen([SOME_PATTERN - 0.1, 4.0], rest=little), p_lines=2.0 * CLEAR_P)
    assert decide(unsure, views=9).reasons == (LITTLE_LEFT,)
