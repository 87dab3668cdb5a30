"""At one operating point a second needs a first that is decided."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.machine.left_pairs import at_one_point
from reconcile.machine.pairs import LEAST_GAIN
from tests.reconcile.machine.rubs import RIGHT, WRONG, asked_of_the_made, found_in
from tests.reconcile.machine.test_left_pairs import EXPLAINED, SMALLER, THIRD, pairs_in
from tests.reconcile.machine.test_leftover import seen


def test_nothing_stands_beside_an_open_first(monkeypatch: pytest.MonkeyPatch) -> None:
    made = asked_of_the_made(monkeypatch, THIRD)
    assert at_one_point(found_in(seen(SMALLER))[0])  # type: ignore[arg-type]
    told = pairs_in(seen(SMALLER), replace(EXPLAINED, word="ambiguous", chosen=(RIGHT, WRONG)))
    assert told is not None and told.best is None and made
    assert (told.tried[0][2] or 0.0) > LEAST_GAIN, "it adds enough"
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is not None, "beside a first that is decided"
