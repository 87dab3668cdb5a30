"""Chances beyond the controls."""

import numpy as np
import pytest

from reconcile.tail import tail_chance


def test_tail_chance_follows_an_exponential_tail() -> None:
    controls = np.random.default_rng(4).exponential(size=300)
    for value in (1.0, 4.0, 8.0):
        assert np.log(tail_chance(controls, value)) == pytest.approx(-value, abs=0.35 + 0.12 * value)
    assert tail_chance(controls, 1e3) == 1e-6


@pytest.mark.parametrize("level", [0.06, 0.1, 0.2, 0.5, 0.9])
def test_one_of_many_alike_is_no_rarer_than_its_rank(level: float) -> None:
    """Any of a hundred might have been the one that is asked about, so of them just so many are as rare."""
    alike = np.random.default_rng(5).normal(size=100)
    found = [tail_chance(np.delete(alike, k), float(alike[k])) for k in range(alike.size)]
    assert np.sum(np.array(found) <= level + 1e-9) == round(level * alike.size)


def test_the_tail_is_that_of_the_top_tenth_whatever_lies_below() -> None:
    """Nine in ten are small and tell nothing of what is large."""
    beyond = -3.0 * np.log((np.arange(30) + 0.5) / 30)
    controls = np.concatenate([np.linspace(0.0, 1.0, 270), 1.0 + beyond])
    for value in (6.0, 10.0, 20.0):
        assert np.log(tail_chance(controls, value)) == pytest.approx(np.log(0.1) - (value - 1.0) / 3.0, abs=0.3)


def test_a_few_controls_that_stand_apart_are_not_the_tail() -> None:
    """Five of three hundred that went astray: the thirty largest say that what lies farther still is rare."""
    usual = -np.log((np.arange(295) + 0.5) / 295)
    assert 1e-6 < tail_chance(usual, 12.0) < 2e-5
    assert tail_chance(np.concatenate([usual, np.full(5, 12.0)]), 20.0) < 2e-4
