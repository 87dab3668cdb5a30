"""Laws that leave far more of the part held out than where they were fitted say so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import cast

from reconcile.driven.answer import _not_all
from reconcile.driven.forced import Analysis
from reconcile.driven.judge import leaves_more, lost


def analysis(after: float, fitted: float, *, led: bool = False, laws: int = 1, unsure: bool = False) -> Analysis:
    """What the rules look at."""
    held = SimpleNamespace(after=after, led=led, diverged=False, held="recording 2")
    final = SimpleNamespace(model=SimpleNamespace(laws=(None,) * laws))
    found = SimpleNamespace(validations=(held,), final=final, laws_leave=fitted, unsure=unsure)
    return cast(Analysis, found)


def test_more_than_where_it_was_fitted_is_said_with_both_shares() -> None:
    found = analysis(0.31, 0.047)
    assert leaves_more(found) == "the laws leave 31 % on recording 2, 4.7 % where they were fitted"
    assert lost(found)
    assert "at the mercy" not in _not_all(found)[0]
    assert "at the mercy" in _not_all(analysis(0.31, 0.047, unsure=True))[0]


def test_a_limit_is_no_caveat_of_the_sentence() -> None:
    found = analysis(0.08, 0.007)
    assert _not_all(found)
    assert not lost(found)


def test_noise_alike_little_and_led_runs_are_quiet() -> None:
    for found in (
        analysis(0.3, 0.2),
        analysis(0.04, 0.004),
        analysis(0.4, 0.01, led=True),
        analysis(0.4, 0.01, laws=0),
    ):
        assert _not_all(found) == ()
        assert not lost(found)
