"""Beside a sure driving effect that leaves too much a second is looked for, and both must be adequate."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.machine import left_pairs
from reconcile.machine.pairs import named_pair
from tests.reconcile.machine.rubs import WRONG, asked_of_the_made
from tests.reconcile.machine.test_left_pairs import EXPLAINED, SMALLER, THIRD, pairs_in
from tests.reconcile.machine.test_leftover import seen


def test_beside_a_driving_effect_that_leaves_too_much_a_second_is_looked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    strange = replace(EXPLAINED, word="unknown_physics")
    asked_of_the_made(monkeypatch, THIRD)
    monkeypatch.setattr(left_pairs, "at_one_point", lambda _: False)
    monkeypatch.setattr(left_pairs, "shaken", lambda _found, decision: decision.word == "unknown_physics")
    told = pairs_in(seen(SMALLER), strange)
    assert told is not None and told.best is not None and told.best.beside.names == (WRONG,)
    assert named_pair(strange, None, told)[0].word == "explained"
    monkeypatch.setattr(left_pairs, "inadequate", lambda _pair: True)
    told = pairs_in(seen(SMALLER), strange)
    assert told is not None and told.best is None, "two that leave too much are as unknown as one"
    assert pairs_in(seen(SMALLER), replace(strange, chosen=())) is None
    monkeypatch.setattr(left_pairs, "at_one_point", lambda _: True)
    assert pairs_in(seen(SMALLER), strange) is None
