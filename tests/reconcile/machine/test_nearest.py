"""Which atlas draws tell the size: those nearest to the observation, where they explain some of it."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.judge.screen import judge
from reconcile.judge.space import fit_space
from reconcile.machine.library import Catalogued
from reconcile.machine.search import nearest_effects, nearest_terms
from reconcile.machine.setting import Found
from sim.core.spec import TermSpec
from tests.reconcile.judge.made import DRAWS, EFFECTS, changes, library, world

MADE = world()


def found_in(observed: np.ndarray) -> tuple[Found, tuple[TermSpec, ...]]:
    known = library(MADE)
    fitted = fit_space(changes(MADE, observed), known, seed=1)
    terms = tuple(
        TermSpec(term="rub", site="gear", parameters={"stiffness": float(k)}) for k in range(known.shares.size)
    )
    made = Catalogued(library=known, terms=terms)
    return Found(known=made, fitted=fitted, screen=judge((fitted,), observed, {}, 1.0)), terms


@pytest.mark.slow
def test_the_nearest_draw_of_the_right_effect_has_about_its_size() -> None:
    away = []
    for seed in range(12):
        rng = np.random.default_rng([6, seed])
        share = float(rng.uniform(0.1, 0.9))
        observed = MADE.effect(2, share, rng) + MADE.noise(rng)
        found, terms = found_in(observed)
        rows = found.known.library.groups[EFFECTS[2]]
        chosen = [k for k in rows if id(terms[k]) in nearest_terms(found, observed)]
        assert len(chosen) == 1
        away.append(abs(found.known.library.shares[chosen[0]] - share))
    assert np.median(away) < 2.0 / DRAWS


def test_where_no_draw_explains_anything_no_size_is_known() -> None:
    observed = MADE.noise(np.random.default_rng(3))
    found, _ = found_in(observed)
    assert nearest_terms(found, observed) == set()


@pytest.mark.slow
def test_the_effect_whose_draw_explains_most_comes_first() -> None:
    first = 0
    for seed in range(8):
        rng = np.random.default_rng([7, seed])
        observed = MADE.effect(1, float(rng.uniform(0.2, 0.9)), rng) + MADE.noise(rng)
        names = nearest_effects(found_in(observed)[0], observed)
        assert len(names) <= 2
        first += names[:1] == (EFFECTS[1],)
    assert first >= 7
    quiet = MADE.noise(np.random.default_rng(3))
    assert nearest_effects(found_in(quiet)[0], quiet) == ()
