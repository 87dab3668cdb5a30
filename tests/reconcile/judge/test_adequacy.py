"""What the best effect leaves, in spaces that are made for it."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.adequacy import Rest, rest_of
from reconcile.judge.paths import build_paths

SIZE = 30


def space(scatter: float) -> SimpleNamespace:
    """Two effects that grow along two directions, eight draws each that scatter by so much in every direction."""
    rng = np.random.default_rng(7)
    shares = np.tile((np.arange(8) + 0.5) / 8, 2)
    axis = np.repeat([0, 1], 8)
    points = rng.normal(0.0, scatter, (16, SIZE))
    points[np.arange(16), axis] += 4.0 + 10.0 * shares
    groups = {"rub@gear": tuple(range(8)), "rub@pinion": tuple(range(8, 16))}
    paths = build_paths(points, groups, shares)
    apart = np.full(16, SIZE * scatter**2 * 1.5)
    return SimpleNamespace(
        place=lambda x: x, paths=paths, points=points, truth=axis, apart=apart, null=rng.normal(0.0, 1.0, (400, SIZE))
    )


def seen(gear: float, other: float) -> np.ndarray:
    place = np.random.default_rng(3).normal(0.0, 1.0, SIZE)
    place[0] += gear
    place[5] += other
    return place


def test_the_right_effect_leaves_what_its_own_draws_leave() -> None:
    assert rest_of(space(1.0), seen(9.0, 0.0), "rub@gear").unmet < 1.6  # type: ignore[arg-type]


def test_another_direction_stays() -> None:
    half = rest_of(space(0.1), seen(9.0, 9.0), "rub@gear")  # type: ignore[arg-type]
    assert half.kept == pytest.approx(0.5, abs=0.2)
    assert rest_of(space(1.0), seen(9.0, 12.0), "rub@gear").unmet > 3.0  # type: ignore[arg-type]
    assert rest_of(space(1.0), seen(9.0, 0.0), "rub@pinion").unmet > 1.6  # type: ignore[arg-type]


def test_what_healthy_machines_show_is_nothing_left() -> None:
    exact = space(1.0)
    assert rest_of(exact, exact.points[4], "rub@gear") == Rest(unmet=0.0, kept=pytest.approx(1.0))  # type: ignore[arg-type]


def test_draws_that_lie_far_apart_forgive_more() -> None:
    lone, wide = (rest_of(space(s), seen(9.0, 12.0), "rub@gear").unmet for s in (1.0, 3.0))  # type: ignore[arg-type]
    assert lone > 2.0 * wide


@pytest.mark.parametrize("effect", ["rub@gear", "rub@pinion"])
def test_without_own_distances_nothing_can_be_said(effect: str) -> None:
    blind = space(1.0)
    blind.apart = np.full(16, np.inf)
    assert rest_of(blind, seen(9.0, 12.0), effect).unmet == 0.0  # type: ignore[arg-type]
