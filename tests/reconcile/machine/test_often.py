"""Nothing is named that sound machines show too often."""

from __future__ import annotations

from reconcile.machine.decide import NAME_P, OFTEN, decide
from reconcile.machine.words import sentence
from tests.reconcile.machine.screens import screen


def test_nothing_is_named_that_sound_machines_show_too_often() -> None:
    """A sound machine whose motion across the load had set in was told as a loose pedestal (33 of evidence)."""
    often = screen([30.0, 2.0], p_any=1.3e-3, p_best=1.3e-3)
    told = decide(often, views=9)
    assert (told.word, told.chosen) == ("not_decidable", ("outer_spall@bearing1",))
    assert told.p > NAME_P and told.reasons == (OFTEN,)
    said = sentence(told, None, None)
    assert said.startswith("Whether anything is missing is not decided: the change is unusual (p = 0.0052), but sound")
    assert decide(screen([30.0, 2.0], p_any=2e-4, p_best=2e-4), views=9).word == "explained"
    both = decide(screen([30.0, 29.5], p_any=1.3e-3, p_best=1.3e-3), views=9)
    assert both.word == "ambiguous", "a set says less than a name"
