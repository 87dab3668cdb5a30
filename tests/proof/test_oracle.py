"""What can be told at all: closed forms of the discriminant, and the tests it is taught with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from proof.case import another_test, instruments_of
from proof.machine import hidden_machine
from proof.oracle import LEAST_BINS, WIDTH, band_edges, discriminant, drifts, levels, separation
from proof.others import cases_of

SIZE, NUMBERS, TESTS = 3000, 12, 20


def made(distance: float, seed: int = 0) -> tuple[np.ndarray, ...]:
    """Tests without and with an effect so many deviations away, what drifts, and by how much it has."""
    rng = np.random.default_rng(seed)
    drift = 3.0 * rng.normal(size=(NUMBERS, SIZE))
    moved = rng.normal(size=(TESTS, NUMBERS)) @ drift
    without = rng.normal(size=(TESTS, SIZE)) + moved
    effect = np.zeros(SIZE)
    effect[:100] = distance / 10.0
    return without, without + effect, drift, moved


@pytest.mark.parametrize("distance", [1.0, 3.0, 6.0])
def test_white_noise_beside_any_drift_gives_the_distance_that_was_put_in(distance: float) -> None:
    """Drift of 12 numbers takes 12 of 3000 directions away, a thousandth of the distance."""
    found = np.mean([separation(*made(distance, seed)) for seed in range(4)])
    assert found == pytest.approx(distance, rel=0.25)


def test_nothing_cannot_be_told_and_neither_can_what_drift_does() -> None:
    assert separation(*made(0.0)) == 0.0
    without, _, drift, moved = made(0.0)
    assert separation(without, without + 2.0 * drift[0], drift, moved) == pytest.approx(2.0, rel=0.5)
    apart = separation(without, without + 2.0 * drift[0], drift[:0], np.zeros_like(moved))
    assert apart < 4.0, "two deviations of drift are two, whether it is known or not"


def test_the_discriminant_solves_its_equation() -> None:
    rng = np.random.default_rng(3)
    apart, rest, drift = rng.normal(size=30), rng.normal(size=(9, 30)), rng.normal(size=(4, 30))
    own = rest - rest.mean(axis=0)
    whole = drift.T @ drift + 0.7 * own.T @ own / 9 + 0.3 * np.diag(own.var(axis=0))
    along = np.linalg.solve(whole, apart)
    np.testing.assert_allclose(discriminant(apart, rest, drift), along / (apart @ along), rtol=1e-9)


def test_bands_follow_each_other_and_widen_with_their_order() -> None:
    edges = band_edges(12001)
    widths = np.diff(edges)
    assert edges[0] == LEAST_BINS and edges[-1] <= 12001 and widths.min() == LEAST_BINS
    assert np.all(np.abs(widths[300:] / edges[300:-1] - WIDTH) <= 0.5001 / edges[300:-1])


def test_a_wandering_speed_smears_no_line() -> None:
    """A line of the 20th order keeps its level and its bands when the speed swings by 2 %."""
    t = np.arange(24000) / 20000.0
    steady, swung = 2.0 * np.pi * 30.0 * t, 2.0 * np.pi * 30.0 * (t + 0.02 * np.sin(2.0 * np.pi * 3.0 * t) / 19.0)
    one, other = (levels(np.array([angle, np.sin(20.0 * angle)])) for angle in (steady, swung))
    assert np.argmax(one) == np.argmax(other)
    assert one.max() == pytest.approx(other.max(), abs=0.1)
    blurred = levels(np.array([steady, np.sin(20.0 * swung)]))
    assert blurred.max() < one.max() - 0.2, "without its own angle it smears"


@pytest.mark.slow
def test_tests_of_another_time_are_of_the_same_machine_and_say_what_differs() -> None:
    case = replace(next(c for c in cases_of("held") if c.name == "h071"), speeds_hz=(30.0,))
    base, instruments = hidden_machine(case.rng(1)), instruments_of(case)

    def heard(number: int, hidden=base, effects=()):  # type: ignore[no-untyped-def]
        return another_test(case, number, hidden, effects, instruments)[0]

    first, again, other = heard(1), heard(1), heard(2)
    np.testing.assert_array_equal(first, again)
    assert first.shape == (1 + len(case.sensors), 24000) and not np.allclose(first[1:], other[1:])
    pitted = heard(1, effects=case.effects)
    np.testing.assert_array_equal(pitted[0], first[0], "the same turn of the shaft")
    assert np.abs(levels(pitted) - levels(first)).max() > 6.0, "a pit of 1.5 mm"
    few = replace(base, factors={name: base.factors[name] for name in ("kp", "em")})
    moved = drifts(few, lambda hidden: levels(heard(1, replace(base, factors={**base.factors, **hidden.factors}))))
    assert moved.shape == (2, levels(first).size) and 0.01 < np.abs(moved).max(axis=1).min() < 10.0
