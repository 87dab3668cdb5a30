"""The screen on a made library: right names, honest p-values, unknown patterns told by their misfit."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from reconcile.judge.pooled import Pooling
from reconcile.judge.screen import Screen, judge, together
from reconcile.judge.space import Fitted, Library, fit_space
from reconcile.machine.decide import DETECT_P, chance
from tests.reconcile.judge.made import EFFECTS, FAMILIES, FEATURES, MEMBERS, changes, library, world

MADE = world()


@cache
def space() -> Fitted:
    return fit_space(changes(MADE, np.zeros(FEATURES)), library(MADE), seed=1)


def screened(observed: np.ndarray) -> Screen:
    return judge((space(),), observed)


@pytest.mark.slow
@pytest.mark.parametrize("c", range(len(EFFECTS)))
def test_a_known_effect_is_named_and_known_to_be(c: int) -> None:
    right = 0
    for seed in range(20):
        rng = np.random.default_rng([seed, c])
        found = screened(MADE.effect(c, float(rng.uniform(0.2, 1.0)), rng) + MADE.noise(rng))
        right += found.names[int(np.argmax(found.weights))] == EFFECTS[c]
        assert found.p_best <= DETECT_P
        assert found.weights.sum() == pytest.approx(1.0)
        assert np.argmax(found.evidence) == np.argmax(found.weights)
    assert right >= 19


@pytest.mark.slow
def test_p_values_of_sound_machines_are_no_smaller_than_they_say() -> None:
    n = 400
    found = [screened(MADE.noise(np.random.default_rng([7, k]))) for k in range(n)]
    for name in ("p_any", "p_best"):
        values = np.sort([getattr(s, name) for s in found])
        for level in (0.05, 0.2, 0.5):
            share = float(np.mean(values <= level))
            assert abs(share - level) < 0.05 + 3 * np.sqrt(level * (1 - level) / n), (name, level, share)
    alarms = sum(chance(s) <= DETECT_P for s in found)
    assert alarms <= 0.01 * n + 3 * np.sqrt(0.01 * n), alarms


@pytest.mark.slow
def test_a_pattern_of_no_known_effect_fits_worse_than_known_ones_do() -> None:
    strange, known = [], []
    for seed in range(20):
        rng = np.random.default_rng([11, seed])
        alien = np.zeros(FAMILIES)
        alien[[2, 7, 10, 11]] = [-12.0, -12.0, 14.0, 14.0]
        strange.append(screened(np.repeat(alien, MEMBERS) + MADE.noise(rng)).misfit)
        known.append(screened(MADE.effect(seed % 4, float(rng.uniform(0.2, 1.0)), rng) + MADE.noise(rng)).misfit)
    assert np.min(strange) > 0.9
    assert np.mean(np.array(known) > 0.9) <= 0.25


def test_the_strongest_group_is_the_changed_one_and_grows_with_the_change() -> None:
    rng = np.random.default_rng(13)
    base = MADE.noise(rng)
    sizes = [screened(base + k * np.repeat(MADE.patterns[2], MEMBERS)).strongest for k in (0.0, 0.5, 1.0, 2.0)]
    assert sizes == sorted(sizes) and sizes[-1] > 15.0


FEW = np.arange(FEATURES) % (2 * MEMBERS) == 0
"""One line in ten, which a small effect moves; pooled with the others they are hidden."""
SIGNS = np.where(np.arange(FEATURES // (2 * MEMBERS)) % 2, 1.0, -1.0)
COARSE = Pooling(family=np.arange(FEATURES) * 2 // FEATURES, names=("f", "g"), points=1, channels=1)


def _moved(rest: np.ndarray, rise: float) -> np.ndarray:
    moved = rest.copy()
    moved[FEW] += rise * SIGNS
    return moved


def of_three_views(rise: float, rng: np.random.Generator) -> Screen:
    """An effect moves a few lines only; the second view sees other lines, the third these."""
    here = changes(MADE, _moved(MADE.noise(rng), rise))
    here = replace(here, pooling=COARSE)
    other = replace(here.single, chosen=np.arange(FEATURES) % MEMBERS == 1)
    these = replace(here.single, chosen=FEW)
    made = library(MADE)
    small = made.changes[: len(made.groups[EFFECTS[0]])].copy()
    small[:] = MADE.healthy(rng, small.shape[0])
    small[:, FEW] += np.linspace(2.0, 9.0, small.shape[0])[:, None] * SIGNS
    rows = tuple(range(made.changes.shape[0], made.changes.shape[0] + small.shape[0]))
    known = Library(
        changes=np.concatenate([made.changes, small]),
        groups={**made.groups, "few@a": rows},
        shares=np.concatenate([made.shares, np.linspace(0.0, 1.0, small.shape[0])]),
    )
    views = [fit_space(here, known, seed=1)]
    views += [fit_space(here, known, seed=1, view=view, least=4.0) for view in (other, these)]
    return judge(views, here.observed)


@pytest.mark.slow
def test_the_view_that_sees_an_effect_speaks_for_it() -> None:
    for seed in range(8):
        found = of_three_views(6.0, np.random.default_rng([23, seed]))
        best = int(np.argmax(found.evidence))
        assert found.names[best] == "few@a" and found.by[best] == 2
        assert found.p_lines < 1e-3 and chance(found) <= DETECT_P
        assert found.rest.unmet == 0.0 and found.rest.kept > 0.8


@pytest.mark.slow
def test_a_third_look_makes_no_alarm_of_nothing() -> None:
    n = 60
    found = [of_three_views(0.0, np.random.default_rng([29, k])) for k in range(n)]
    small = sum(s.p_lines <= 0.05 for s in found)
    assert small <= 0.05 * n + 3.0 * np.sqrt(0.05 * n)
    assert sum(chance(s) <= DETECT_P for s in found) <= 3


def test_what_was_not_measured_is_left_out() -> None:
    rng = np.random.default_rng(17)
    observed = MADE.effect(2, 0.8, rng) + MADE.noise(rng)
    observed[:3] = np.nan
    fitted = fit_space(changes(MADE, observed), library(MADE), seed=1)
    assert np.isinf(fitted.whiten.sigma[:3]).all()
    found = judge((fitted,), observed)
    assert np.isfinite(found.evidence).all() and found.names[int(np.argmax(found.weights))] == EFFECTS[2]


def test_the_same_seed_gives_the_same_space() -> None:
    again = fit_space(changes(MADE, np.zeros(FEATURES)), library(MADE), seed=1)
    np.testing.assert_array_equal(again.null, space().null)
    assert again.overdispersion == space().overdispersion


@pytest.mark.slow
def test_views_with_phases_speak_and_levels_say_what_is_left() -> None:
    """Two views of levels and the same again where phases would be: nothing changes but what the looks cost."""
    rng = np.random.default_rng(3)
    observed = MADE.effect(2, 0.6, rng) + MADE.noise(rng)
    here = changes(MADE, observed)
    lines = [fit_space(here, library(MADE), seed=1, view=view, least=4.0) for view in (here.single, here.sides)]
    blind = fit_space(here, library(MADE), seed=1, view=replace(here.sides, chosen=np.arange(FEATURES) < 1), least=4.0)
    before, again = judge((space(), *lines), observed), judge((space(), *lines, *lines), observed)
    np.testing.assert_allclose(again.evidence, before.evidence)
    assert (again.rest, again.p_lines) == (before.rest, pytest.approx(2 * before.p_lines))
    assert set(again.by) <= {0, 1, 2}
    spoken = judge((space(), blind, blind, *lines), observed)
    assert int(spoken.by[int(np.argmax(spoken.evidence))]) in {0, 3, 4}
    assert spoken.rest.kept == judge((space(), blind, blind), observed).rest.kept


@pytest.mark.slow
def test_lines_that_sound_machines_do_not_repeat_give_no_alarm_without_a_pattern_and_the_same_names() -> None:
    observed = MADE.effect(2, 0.6, np.random.default_rng(3)) + MADE.noise(np.random.default_rng(4))
    here = changes(MADE, observed)

    def judged(*, repeats: bool) -> Screen:
        views = [replace(view, repeats=repeats) for view in (here.single, here.sides)]
        return judge((space(), *(fit_space(here, library(MADE), seed=1, view=v, least=4.0) for v in views)), observed)

    steady, rattling = judged(repeats=True), judged(repeats=False)
    assert steady.p_lines < 1.0 == rattling.p_lines
    assert steady.lines_asked and not rattling.lines_asked and not judge((space(),), observed).lines_asked
    np.testing.assert_array_equal(steady.evidence, rattling.evidence)
    assert steady.p_best == rattling.p_best


@pytest.mark.parametrize(("both", "first"), [(6.5, 0), (6.8, 1), (10.0, 1)])
def test_what_two_views_tell_outdoes_what_one_tells_by_half_of_the_fainter(both: float, first: int) -> None:
    """One effect has ten by one view and nothing by the other: two thirds of that by both are as much."""
    one, other = np.array([10.0, both]), np.array([0.0, both])
    for views in ([one, other], [other, one], [one, other - 1.0, other], [one, other, other, other]):
        assert int(np.argmax(together(views))) == first
    assert np.array_equal(together([one]), one)
