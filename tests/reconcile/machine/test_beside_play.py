"""The place of a pit beside a play of its own bearing must be told by what the play leaves."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import beside_play
from reconcile.machine.beside_play import placed_beside_play
from reconcile.machine.decide import Decision
from reconcile.report.action import PLACE_OPEN

PIT, TWIN, INNER, PLAY = "outer_spall@b1", "outer_spall@b2", "inner_spall@b2", "fit_clearance_series@b1"
NAMES = (PIT, TWIN, INNER, PLAY)
NAMED = Decision(word="explained", chosen=(PIT,), p=1e-6, reasons=())


def answered(  # type: ignore[no-untyped-def]
    monkeypatch: pytest.MonkeyPatch, left: tuple[float, ...], *, heard=(25.0, 25.0, 0.0), second=PLAY, decision=NAMED
):
    monkeypatch.setattr(
        beside_play, "fitted_change", lambda _found, name, _observed: np.array([np.nan, float(len(name))])
    )
    taken: list[np.ndarray] = []
    monkeypatch.setattr(beside_play, "looked", lambda _fitted, change: SimpleNamespace(evidence=np.array(left)))
    changes = SimpleNamespace(observed=np.zeros(2), left=lambda change: taken.append(change) or change)
    evidence = dict(zip(NAMES, heard, strict=False))
    setting = SimpleNamespace(changes=changes, direct=SimpleNamespace(evidence=evidence))
    found = SimpleNamespace(screen=SimpleNamespace(names=NAMES), fitted=None)
    other = SimpleNamespace(names=(second,))
    told = placed_beside_play(setting, found, decision, other)  # type: ignore[arg-type]
    assert all(np.all(np.isfinite(change)) for change in taken)
    return told, other


def test_a_place_that_the_play_explains_is_not_decided(monkeypatch: pytest.MonkeyPatch) -> None:
    (decision, other), _ = answered(monkeypatch, (-1.9, -3.1, -9.0, 0.0))
    assert (decision.word, decision.chosen, other) == ("ambiguous", (PIT, TWIN), None)
    assert decision.reasons[0] == PLACE_OPEN and decision.reasons[1].startswith(PLAY)


@pytest.mark.parametrize(
    "how",
    [
        {"left": (9.0, 3.0, 8.5, 0.0)},
        {"left": (-1.9, -3.1, -9.0, 0.0), "heard": (25.0, 3.0, 0.0)},
        {"left": (-1.9, -3.1, -9.0, 0.0), "second": "fit_clearance_series@b2"},
        {"left": (-1.9, -3.1, -9.0, 0.0), "second": "unbalance@b1"},
        {"left": (-1.9, -3.1, -9.0, 0.0), "decision": Decision(word="ambiguous", chosen=(PIT,), p=0.0, reasons=())},
    ],
    ids=["told by what is left", "not heard there", "play elsewhere", "no play", "a set already"],
)
def test_else_the_name_stays(monkeypatch: pytest.MonkeyPatch, how: dict[str, object]) -> None:
    (decision, other), given = answered(monkeypatch, **how)  # type: ignore[arg-type]
    assert decision is how.get("decision", NAMED) and other is given


def test_without_a_second_nothing_is_asked() -> None:
    assert placed_beside_play(None, None, NAMED, None) == (NAMED, None)  # type: ignore[arg-type]
