"""A second effect that adds at one operating point alone, and takes at the others: neither named nor a rival."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.machine import left_pairs
from reconcile.machine.left_pairs import best_left_pair
from tests.reconcile.machine.rubs import MADE, WRONG, Asked, asked_of_the_made, found_in
from tests.reconcile.machine.test_left_pairs import EXPLAINED, SMALLER, THIRD, alike, pairs_in, with_third
from tests.reconcile.machine.test_leftover import TRUE, seen


@pytest.fixture
def simulated(monkeypatch: pytest.MonkeyPatch) -> Asked:
    """Simulating is asking the made world; what was asked for."""
    return asked_of_the_made(monkeypatch, THIRD)


@pytest.mark.parametrize(
    ("parts", "stands"),
    [
        ((124.0, -28.0, -38.0), False),
        ((60.0, 25.0, -16.0), True),
        ((100.0, -19.9), True),
        ((100.0, -20.1), False),
        ((50.0, -9.9), False),  # with little to spare
        ((50.0, 10.0), True),
    ],
)
def test_a_second_must_not_be_one_operating_points_alone(
    parts: tuple[float, ...], stands: bool, simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(left_pairs, "_parts", lambda *_: parts)
    monkeypatch.setattr(left_pairs, "_fairly", lambda _, made: made)
    told = pairs_in(seen(SMALLER))
    assert told is not None and (told.best is not None) == stands and simulated
    assert told.tried[0][2] is not None, "it is told that it was tried"


@pytest.mark.parametrize(("again", "gain", "parts"), [(7.0, 43.0, (14.0, 29.0)), (-7.0, 50.0, (20.0, 30.0))])
def test_what_the_first_alone_gains_once_more_is_taken_off_at_each_operating_point(
    again: float, gain: float, parts: tuple[float, ...], simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = pairs_in(seen(SMALLER))
    assert told is not None and told.best is not None and simulated
    library = SimpleNamespace(known=SimpleNamespace(library=SimpleNamespace(changes=None)))
    for name, made in {"start_of": None, "led_again": library, "_parts": (6.0, 1.0)}.items():
        monkeypatch.setattr(left_pairs, name, lambda *_, made=made: made)
    asked = SimpleNamespace(least=30.0, left=SimpleNamespace(level=lambda _: again, base=0.0))
    one = replace(told.best, gain=50.0, parts=(20.0, 30.0))
    fair = left_pairs._fairly(asked, {WRONG: one, THIRD: None})  # type: ignore[arg-type]
    left = fair[WRONG]
    assert left is not None and (left.gain, left.parts, fair[THIRD]) == (gain, parts, None)


@pytest.mark.parametrize(("twins", "others"), [(False, ()), (True, (WRONG, THIRD))])
def test_a_second_of_one_operating_point_alone_is_no_rival_by_its_sum_but_as_a_bow_of_an_unbalance(
    twins: bool, others: tuple[str, ...], simulated: Asked, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Two that may not be told apart at all stay together, whichever of them the rule keeps by a little."""
    setting, found = found_in(seen(SMALLER))
    twin = with_third(found, MADE.change(WRONG, TRUE, SMALLER))
    made = alike(WRONG, behind=1.0)

    def fitted(asked, name, rows):  # type: ignore[no-untyped-def]
        return replace(made(asked, name, rows), parts=(40.0, 40.0 if name == WRONG else -40.0))

    monkeypatch.setattr(left_pairs, "alike", lambda *_: twins)
    monkeypatch.setattr(left_pairs, "_fitted", fitted)
    monkeypatch.setattr(left_pairs, "_fairly", lambda _, made: made)
    monkeypatch.setattr(left_pairs, "_alone", lambda *_: -np.inf)
    told = best_left_pair(setting, twin, EXPLAINED, found.known, 8, 3, map)  # type: ignore[arg-type]
    assert told is not None and told.best is not None and simulated
    assert (told.best.beside.names, told.best.others) == ((WRONG,), others)
    assert {name for name, _, gain in told.tried if gain is not None} == {WRONG, THIRD}, "both are simulated"
