"""At one operating point a second needs a first that is decided."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest

from reconcile.machine import left_pairs
from reconcile.machine.left_pairs import at_one_point
from tests.reconcile.machine.rubs import RIGHT, WRONG, asked_of_the_made, found_in
from tests.reconcile.machine.test_left_pairs import EXPLAINED, SMALLER, THIRD, pairs_in
from tests.reconcile.machine.test_leftover import seen

OPEN = replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, WRONG))


def test_nothing_stands_beside_an_open_first(monkeypatch: pytest.MonkeyPatch) -> None:
    made = asked_of_the_made(monkeypatch, THIRD)
    setting, _ = found_in(seen(SMALLER))
    assert at_one_point(setting)  # type: ignore[arg-type]
    for points in (0, 2, 3):
        assert not at_one_point(SimpleNamespace(data=(0,) * points))  # type: ignore[arg-type]
    assert pairs_in(seen(SMALLER), OPEN) is None and not made, "nor is it simulated"
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is not None, "beside a first that is decided"
    monkeypatch.setattr(left_pairs, "at_one_point", lambda _: False)
    told = pairs_in(seen(SMALLER), OPEN)
    assert told is not None and told.best is not None, "at several points"
