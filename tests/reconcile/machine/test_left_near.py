"""Seconds that by their sums come as near as the best does simulated are simulated too, before they open it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine import left_pairs
from reconcile.machine.decide import Decision
from reconcile.machine.left_pairs import best_left_pair
from tests.reconcile.machine.rubs import RIGHT, WRONG, asked_of_the_made, found_in
from tests.reconcile.machine.test_leftover import seen


def test_what_comes_as_near_as_the_best_does_simulated_is_simulated_too(monkeypatch: pytest.MonkeyPatch) -> None:
    """A pit and a loose ring (tw045 of the proof, with fewer rings simulated): the ring added 14.4 by sums and 12.3
    simulated, a foot 6.7 by sums, more than half of the latter and less than half of the former."""
    fitted = {"half": SimpleNamespace(gain=5.0), "late": None}
    monkeypatch.setattr(left_pairs, "_fitted", lambda _asked, name, _rows: fitted[name])
    asked = SimpleNamespace(least=7.5)
    made = {"best": SimpleNamespace(gain=12.3), "next": None}
    others = [("half", 6.7, ()), ("late", 6.3, ()), ("far", 6.1, ())]
    near = left_pairs._as_near
    assert near(asked, made, others, 6) == fitted  # type: ignore[arg-type]
    assert near(asked, made, others, 3) == {"half": fitted["half"]}, "while there may be so many"  # type: ignore[arg-type]
    assert near(asked, made, others, 2) == {}  # type: ignore[arg-type]
    none = {"best": SimpleNamespace(gain=7.4), "next": None}
    assert near(asked, none, others, 6) == {}, "nothing stands that these could open"  # type: ignore[arg-type]


def test_they_are_asked_for_after_the_others_and_count(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(left_pairs, "at_one_point", lambda _: False)
    asked_of_the_made(monkeypatch, "rub@wheel")
    explained = Decision(word="explained", chosen=(RIGHT,), p=1e-6, reasons=())
    setting, found = found_in(seen(5e6))
    heard: list[tuple[list[str], list[str], int]] = []

    def near(_asked, fitted, others, most):  # type: ignore[no-untyped-def]
        heard.append((list(fitted), [name for name, _, _ in others], most))
        return {WRONG: None}

    monkeypatch.setattr(left_pairs, "_as_near", near)
    told = best_left_pair(setting, found, explained, found.known, 8, 2, map)  # type: ignore[arg-type]
    assert heard == [([WRONG], [], 2)]
    assert told is not None and told.best is None, "what it gives counts"
