"""By what a second effect is looked for: what the first leaves, or the metric."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine import engine
from reconcile.machine.budget import QUICK
from reconcile.machine.decide import Decision

PIT, CRACK, LOOSE = "outer_spall@bearing1", "tooth_crack@pinion", "pedestal_looseness@bearing1"


@pytest.mark.parametrize(
    ("first", "word", "tell", "by"),
    [
        (LOOSE, "explained", False, "left"),
        (LOOSE, "unknown_physics", False, "left"),
        (PIT, "explained", True, "left"),
        (PIT, "ambiguous", True, "left"),
        (PIT, "unknown_physics", True, "metric"),
        (PIT, "explained", False, "metric"),
        (CRACK, "explained", False, "metric"),
        ("", "nothing_missing", True, "metric"),
    ],
)
def test_beside_a_sure_pit_the_teeth_tell(
    first: str, word: str, tell: bool, by: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    chosen = (first,) if first else ()
    decision = Decision(word=word, chosen=chosen, p=1e-6, reasons=())  # type: ignore[arg-type]
    monkeypatch.setattr(engine, "decided", lambda *_: decision)
    monkeypatch.setattr(engine, "second_effect", lambda *_: None)
    monkeypatch.setattr(engine, "teeth_tell", lambda *_: tell)
    monkeypatch.setattr(engine, "best_left_pair", lambda *_: "left")
    monkeypatch.setattr(engine, "best_pair", lambda *_: "metric")
    asked = (SimpleNamespace(screen=SimpleNamespace(by_turns=False)),) * 3
    assert engine._paired(*asked, QUICK, None) == by  # type: ignore[arg-type]
    alone = (SimpleNamespace(screen=SimpleNamespace(by_turns=True)),) * 3
    assert engine._paired(*alone, QUICK, None) is None, "nothing but sidebands is unusual"  # type: ignore[arg-type]
    monkeypatch.setattr(engine, "second_effect", lambda *_: "found by what single lines keep")
    assert engine._paired(*asked, QUICK, None) is None  # type: ignore[arg-type]
