"""What few sensors and points leave open, and what is told of a change without a pattern."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.judge.adequacy import Rest
from reconcile.machine.decide import CLEAR_P, FEW_UNDECIDED, LINES_QUIET, NO_PATTERN, STRANGE, decide
from tests.reconcile.machine.screens import NAMES, screen, struck


def test_a_change_without_a_pattern_is_not_said_to_fit_badly() -> None:
    """It fits no worse than known effects do; of few views it is open whether one of them changed so."""
    usual = decide(screen([2.0, -9.0], p_lines=CLEAR_P), views=9)
    assert (usual.word, usual.reasons) == ("unknown_physics", (NO_PATTERN,))
    worst = decide(screen([2.0, -9.0], misfit=STRANGE + 0.005), views=9)
    assert "fits worse than 98 % of" in worst.reasons[0]
    few = decide(screen([2.0, -9.0], p_lines=CLEAR_P), views=2)
    assert (few.word, few.reasons) == ("not_decidable", (FEW_UNDECIDED,))
    assert decide(screen([2.0, -9.0], misfit=STRANGE + 0.005), views=2).word == "unknown_physics"


def test_few_views_do_not_exclude_what_explains_half_as_much() -> None:
    one = screen([20.0, 11.0, 3.0])
    assert decide(one, views=9).word == "explained"
    few = decide(one, views=1)
    assert few.word == "ambiguous" and len(few.chosen) == 2
    assert "so few sensors" in few.reasons[1], "weights alone would have named one"
    assert len(decide(screen([20.0, 19.8, 3.0]), views=1).reasons) == 1


def test_few_views_exclude_what_does_not_strike() -> None:
    evidence, views = [30.0, 5.0, 20.0], 1
    assert decide(screen(evidence), views=views).word == "ambiguous"
    assert decide(struck(evidence, [20.0]), views=views).chosen == NAMES[:1]


@pytest.mark.parametrize(("strongest", "word"), [(10.0, "not_decidable"), (30.0, "unknown_physics")])
def test_a_change_without_a_pattern_is_faint_or_unknown(strongest: float, word: str) -> None:
    made = screen([1.0, 0.5], strongest=strongest, misfit=0.5, p_lines=0.5 if word == "not_decidable" else CLEAR_P)
    assert decide(made, views=9).word == word


def test_groups_of_features_alone_claim_no_unknown_physics() -> None:
    """However glaring they are: sound machines that change their regime reach 1e-6 by them, and no line shows it."""
    quiet = decide(screen([1.0, 0.5], strongest=30.0, p_any=1e-6, p_lines=2 * CLEAR_P), views=9)
    assert (quiet.word, quiet.reasons) == ("not_decidable", (LINES_QUIET,))
    left = screen([2.6, 2.2], strongest=30.0, p_any=1e-6, p_lines=0.13, rest=Rest(unmet=1.3, kept=-0.14, rough=False))
    assert decide(left, views=9).reasons == (LINES_QUIET,), "what is left of lines that are usual (h034 of the proof)"
    assert decide(replace(left, rest=replace(left.rest, unmet=2.1), p_lines=CLEAR_P), views=9).word == "unknown_physics"
    unasked = screen([1.0, 0.5], strongest=30.0, p_any=1e-6, lines_asked=False)
    assert decide(unasked, views=9).word == "unknown_physics", "lines that do not repeat are no witness"
    odd = screen([1.0, 0.5], strongest=30.0, misfit=STRANGE + 0.005, p_lines=1.0)
    assert decide(odd, views=9).word == "unknown_physics", "fits worse than simulated effects do"
