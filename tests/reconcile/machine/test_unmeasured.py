"""Without a baseline what no known effect explains may be the machine file's error."""

from __future__ import annotations

from reconcile.machine.decide import STRANGE, UNMEASURED, decide
from reconcile.machine.words import sentence
from tests.reconcile.machine.test_decide import screen


def test_without_a_baseline_unknown_physics_may_be_the_file() -> None:
    shown = screen([20.0, 9.0], misfit=STRANGE + 0.01)
    found = decide(shown, views=9, measured=False)
    assert (found.word, found.reasons) == ("not_decidable", (UNMEASURED,))
    said = sentence(found, None, None)
    assert "no known effect explains" in said and "without a baseline" in said
    named = screen([20.0, 9.0])
    assert decide(named, views=9, measured=False) == decide(named, views=9)
