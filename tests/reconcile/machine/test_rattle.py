"""A loose ring is simulated again about the likeliest of its near draws, any other effect about its nearest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.judge.nulls import squared_distances
from reconcile.machine import rattle
from reconcile.machine.leftover import over_nothing
from reconcile.machine.rattle import AROUND, draws_around
from reconcile.machine.refine import best_draws
from reconcile.machine.setting import Found
from tests.reconcile.machine.rubs import FEATURES, MADE, RIGHT, found_in

OBSERVED = MADE.change(RIGHT, np.array([0.06, -0.05, 0.03]), 2e7) + np.random.default_rng(8).normal(0, 1, FEATURES)


def evidence(found: Found) -> np.ndarray:
    """Of each draw in the view that speaks for the effect, up to a constant."""
    view = found.view(RIGHT)
    changes = found.known.library.changes[list(found.known.library.groups[RIGHT])]
    away = squared_distances(view.metric(view.view(view.whiten(changes))), view.place(OBSERVED)[None])[:, 0]
    return np.asarray(-away / (2.0 * view.overdispersion))


def test_a_ring_goes_on_about_the_likeliest_of_its_near_draws(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(OBSERVED)
    assert draws_around(setting, found, RIGHT) == best_draws(found.view(RIGHT), found.known, RIGHT, OBSERVED)  # type: ignore[arg-type]
    told = evidence(found)
    as_near = float(told.max() - np.sort(told)[-10])
    near = np.flatnonzero(told >= told.max() - as_near)
    monkeypatch.setattr(rattle, "COSTLY", ("rub",))
    monkeypatch.setattr(rattle, "AS_NEAR", as_near)
    rows = np.array(found.known.library.groups[RIGHT])[near]
    likely = over_nothing(setting.changes, found.known.library.changes[rows])
    expected = [found.known.terms[rows[k]] for k in np.argsort(-likely)[:AROUND]]
    assert draws_around(setting, found, RIGHT) == expected  # type: ignore[arg-type]
    assert expected != [found.known.terms[k] for k in np.argsort(-told)[:AROUND]], "the nearest are others"


def test_and_about_the_nearest_that_there_are_where_few_come_near(monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(OBSERVED)
    monkeypatch.setattr(rattle, "COSTLY", ("rub",))
    monkeypatch.setattr(rattle, "AS_NEAR", 0.0)
    chosen = draws_around(setting, found, RIGHT)  # type: ignore[arg-type]
    assert chosen == [found.known.terms[k] for k in np.argsort(-evidence(found))[:AROUND]]


@pytest.mark.parametrize("count", [1, 2, 5])
def test_so_many_as_are_asked_for(count: int, monkeypatch: pytest.MonkeyPatch) -> None:
    setting, found = found_in(OBSERVED)
    for costly in ((), ("rub",)):
        monkeypatch.setattr(rattle, "COSTLY", costly)
        assert len(draws_around(setting, found, RIGHT, count)) == count  # type: ignore[arg-type]
    assert AROUND == 3


def test_the_likelihood_over_no_change_is_nothing_for_no_change() -> None:
    setting, _ = found_in(OBSERVED)
    drawn = np.array([np.zeros(FEATURES), OBSERVED])
    nothing, met = over_nothing(setting.changes, drawn)
    assert nothing == pytest.approx(0.0) and met > 10.0
    far = replace(setting.changes, observed=np.zeros(FEATURES))
    assert over_nothing(far, drawn)[1] < -10.0
