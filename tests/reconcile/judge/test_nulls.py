"""Chances of healthy machines whose drift the metric has not seen: as rare as they say they are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.judge.changes import Changes
from reconcile.judge.nulls import FEWEST_COPIES, FOLDS, MOST_COPIES, NULLS, copies_of
from reconcile.judge.screen import judge, looked
from reconcile.judge.space import Fitted, Library, fit_space, with_draws
from reconcile.tail import tail_chance
from tests.reconcile.judge.chosen import LINES, PAIRS, chances, single_lines

EFFECTS, DRAWS = 8, 8
WORLDS, EACH = 40, 16
"""Kinds of machine, and machines of each that are asked about: to compare with takes long, to ask does not."""


def _effect_of(rng: np.random.Generator, drift_db: float) -> np.ndarray:
    return rng.normal(size=(60, LINES)) / np.sqrt(60) * drift_db


def _drifted(rng: np.random.Generator, effect_of: np.ndarray, count: int) -> np.ndarray:
    return rng.uniform(-(3**0.5), 3**0.5, (count, 60)) @ effect_of


def _more(seed: int, drift_db: float) -> np.ndarray:
    """Observations (machines, lines) of more machines that drift as those of the world of that seed."""
    effect_of = _effect_of(np.random.default_rng([seed, 1]), drift_db)
    rng = np.random.default_rng([seed, 2])
    return _drifted(rng, effect_of, EACH) + rng.normal(size=(EACH, LINES))


def _world(seed: int, drift_db: float) -> tuple[Changes, Library, np.random.Generator]:
    """Sixty numbers of the machine drift and move all lines; effects move them in directions of their own."""
    rng = np.random.default_rng([seed, 1])
    effect_of = _effect_of(rng, drift_db)
    made = single_lines(_drifted(rng, effect_of, 1)[0] + rng.normal(size=LINES), _drifted(rng, effect_of, PAIRS))
    sizes = (np.arange(DRAWS) + 0.5) / DRAWS
    patterns = rng.normal(0.0, 6.0, (EFFECTS, LINES))
    rows = np.concatenate([np.outer(sizes + 0.2, p) + rng.normal(0.0, 2.0, (DRAWS, LINES)) for p in patterns])
    groups = {f"rub@gear{k}": tuple(range(k * DRAWS, (k + 1) * DRAWS)) for k in range(EFFECTS)}
    return made, Library(changes=rows, groups=groups, shares=np.tile(sizes, EFFECTS)), rng


def _space(made: Changes, library: Library) -> Fitted:
    return fit_space(made, library, seed=3, view=made.single, least=4.0)


@pytest.mark.slow
@pytest.mark.parametrize(("drift_db", "kind"), [(1.0, 0), (4.0, 0), (4.0, 48)])
def test_a_machine_that_drifted_as_the_others_is_no_more_unusual(drift_db: float, kind: int) -> None:
    """Of 1600 machines of a hundred kinds 3 to 6 % came to 0.05 or less, 0.6 to 2.1 % to 0.01."""
    lengths, patterns = [], []
    for seed in range(WORLDS):
        made, library, rng = _world(seed, drift_db)
        made = replace(made, kind=rng.normal(0.0, drift_db, (kind, LINES)))
        space = _space(made, library)
        for observed in _more(seed, drift_db):
            look = looked(space, observed)
            lengths.append(tail_chance(space.null, look.length))
            patterns.append(tail_chance(look.null.max(axis=1), float(look.evidence.max())))
    for found in (np.array(lengths), np.array(patterns)):
        assert np.mean(found <= 0.05) <= 0.09
        assert np.mean(found <= 0.01) <= 0.04
        assert np.median(found) > 0.3


@pytest.mark.slow
def test_the_best_of_effects_that_a_machine_chose_is_one_of_all() -> None:
    found = [chances(5000 + seed, 4.0) for seed in range(60)]
    chosen, corrected = (np.array([getattr(one, name) for one in found]) for name in ("chosen", "corrected"))
    assert np.mean(chosen <= 0.05) > 0.1, "ranked against the chosen few alone it would come too often"
    assert np.mean(corrected <= 0.05) <= 0.12 and np.mean(corrected <= 0.01) <= 0.05


@pytest.mark.slow
def test_groups_of_features_of_machines_that_drift_by_different_amounts() -> None:
    """Few nulls reach what an observation of the same kind does, unless each is measured by the others."""
    chances = []
    for seed in range(60):
        made, library, rng = _world(seed, 4.0)
        sizes = np.exp(0.8 * rng.normal(size=PAIRS + 1) - 0.32)
        own = sizes[0] * rng.choice([-1.0, 1.0]) * made.null[int(rng.integers(PAIRS))] + rng.normal(size=LINES)
        fresh = _world(seed + 1000, 4.0)[0].null
        made = replace(made, observed=own, null=sizes[1:, None] * fresh, groups=np.arange(LINES) // 6)
        chances.append(judge((_space(made, library),), made.observed).p_any)
    found = np.array(chances)
    assert np.mean(found <= 0.05) <= 0.05 and np.mean(found <= 0.01) <= 0.02


def test_every_null_is_placed_once_by_a_metric_without_its_pair() -> None:
    made, library, _ = _world(1, 4.0)
    space = _space(made, library)
    rows = np.concatenate([f.rows for f in space.folds])
    assert sorted(rows.tolist()) == list(range(PAIRS * copies_of(PAIRS)))
    for fold in space.folds:
        assert set(fold.rows // copies_of(PAIRS)) == set(range(int(fold.rows[0]) // copies_of(PAIRS), PAIRS, FOLDS))
        assert np.array_equal(space.null[fold.rows], np.sum(fold.null**2, axis=1))


def test_a_bank_that_the_metric_knows_would_look_smaller() -> None:
    made, library, rng = _world(2, 4.0)
    space = _space(made, library)
    own = np.repeat(made.null, copies_of(PAIRS), axis=0) + rng.normal(size=(PAIRS * copies_of(PAIRS), LINES))
    known = np.sum(space.metric(space.view(space.whiten(own))) ** 2, axis=1)
    assert np.median(known) < 0.7 * np.median(space.null)


def test_draws_that_are_led_come_nearer_to_the_nulls_too() -> None:
    made, library, rng = _world(4, 2.0)
    space = _space(made, library)
    led = rng.normal(0.0, 0.5, (3, LINES))
    more = with_draws(space, Library(changes=led, groups={"rub@gear2": (0, 1, 2)}, shares=np.full(3, 0.5)))
    assert np.all(more.near <= space.near)
    assert np.all(more.near[:, 2].mean() < space.near[:, 2].mean())
    assert np.array_equal(np.delete(more.near, 2, axis=1), np.delete(space.near, 2, axis=1))


def test_two_pairs_are_enough_to_compare_with() -> None:
    made, library, _ = _world(5, 1.0)
    few = single_lines(made.observed, made.null[:2])
    space = _space(few, library)
    assert space.null.size == 2 * copies_of(2)
    assert np.isfinite(space.near).all()


def test_many_pairs_have_fewer_copies_and_no_bank_is_less_than_its_pairs_allow() -> None:
    assert copies_of(24) == copies_of(48) == MOST_COPIES and copies_of(144) == FEWEST_COPIES
    counts = [pairs * copies_of(pairs) for pairs in range(1, 300)]
    assert all(count >= min(NULLS, MOST_COPIES * pairs) for pairs, count in enumerate(counts, start=1))
