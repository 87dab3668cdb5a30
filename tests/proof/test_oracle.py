"""What can be told at all: closed forms of the discriminant, and the tests it is taught with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from proof.case import another_test, instruments_of, with_noise
from proof.machine import hidden_machine
from proof.oracle import LEAST_BINS, WIDTH, band_edges, discriminant, drifts, farthest, levels, separation
from proof.others import cases_of

SIZE, NUMBERS, TESTS = 3000, 12, 20


def made(distance: float, seed: int = 0, others: int = 0) -> tuple[np.ndarray, ...]:
    """Tests without and with an effect so many deviations away, what drifts, and by how much it has; `others` more
    patterns vary from test to test that nobody knows."""
    rng = np.random.default_rng(seed)
    drift = 3.0 * rng.normal(size=(NUMBERS, SIZE))
    moved = rng.normal(size=(TESTS, NUMBERS)) @ drift
    unknown = rng.normal(size=(TESTS, others)) @ (3.0 * rng.normal(size=(others, SIZE)))
    without = rng.normal(size=(TESTS, SIZE)) + moved + unknown
    effect = np.zeros(SIZE)
    effect[:100] = distance / 10.0
    return without, without + effect, drift, moved


@pytest.mark.parametrize("distance", [1.0, 3.0, 6.0])
def test_white_noise_beside_known_drift_gives_the_distance_that_was_put_in_from_both_sides(
    distance: float,
) -> None:
    """Drift of 12 numbers takes 12 of 3000 directions away, a thousandth of the distance."""
    found = np.array([separation(*made(distance, seed)) for seed in range(6)])
    assert found[:, 0].mean() == pytest.approx(distance, rel=0.25)
    assert np.sum((found[:, 1] <= distance) & (distance <= found[:, 2])) >= 4, "its interval holds it mostly"
    without, with_it, drift, _ = made(distance)
    assert farthest((with_it - without)[0], drift, np.ones(SIZE)) == pytest.approx(distance, rel=0.02)


def test_what_varies_and_is_not_known_makes_the_taught_one_worse_and_never_better_than_the_bound() -> None:
    """So it is a bound from below: 20 tests do not teach what 10 patterns do."""
    found = np.mean([separation(*made(4.0, seed, others=10))[0] for seed in range(4)])
    assert 0.5 < found < 3.0
    without, with_it, drift, _ = made(4.0, others=10)
    assert farthest((with_it - without)[0], drift, np.ones(SIZE)) > 3.9


def test_nothing_cannot_be_told_and_neither_can_what_drift_does() -> None:
    assert separation(*made(0.0))[0] == 0.0
    without, _, drift, moved = made(0.0)
    assert separation(without, without + 2.0 * drift[0], drift, moved)[0] == pytest.approx(2.0, rel=0.5)
    assert farthest(2.0 * drift[0], drift, np.ones(SIZE)) == pytest.approx(2.0, rel=0.01), "two deviations are two"


def test_the_discriminant_solves_its_equation() -> None:
    rng = np.random.default_rng(3)
    apart, rows, diagonal = rng.normal(size=30), rng.normal(size=(9, 30)), rng.uniform(0.5, 2.0, 30)
    along = np.linalg.solve(rows.T @ rows + np.diag(diagonal), apart)
    np.testing.assert_allclose(discriminant(apart, rows, diagonal), along / (apart @ along), rtol=1e-9)
    assert farthest(apart, rows, diagonal) == pytest.approx(np.sqrt(apart @ along))


def test_bands_follow_each_other_and_widen_with_their_order() -> None:
    edges = band_edges(12001)
    widths = np.diff(edges)
    assert edges[0] == LEAST_BINS and edges[-1] <= 12001 and widths.min() == LEAST_BINS
    assert np.all(np.abs(widths[300:] / edges[300:-1] - WIDTH) <= 0.5001 / edges[300:-1])


def test_neither_a_wandering_nor_another_speed_moves_a_line_to_another_band() -> None:
    """A line of the 20th order keeps its level and its band when the speed swings by 2 %, or is 0.5 % off."""
    t = np.arange(24000) / 20000.0
    steady, slow = 2.0 * np.pi * 30.0 * t, 2.0 * np.pi * 29.85 * t
    swung = 2.0 * np.pi * 30.0 * (t + 0.02 * np.sin(2.0 * np.pi * 3.0 * t) / 19.0)
    one, *others = (levels(np.array([angle, np.sin(20.0 * angle)]), 35) for angle in (steady, slow, swung))
    for other in others:
        assert np.argmax(one) == np.argmax(other)
        assert one.max() == pytest.approx(other.max(), abs=0.1)
    blurred = levels(np.array([steady, np.sin(20.0 * swung)]), 35)
    assert blurred.max() < one.max() - 0.2, "without its own angle it smears"


@pytest.mark.slow
def test_tests_of_another_time_are_of_the_same_machine_and_say_what_differs() -> None:
    case = replace(next(c for c in cases_of("held") if c.name == "h071"), speeds_hz=(30.0,))
    base, (ways, noises) = hidden_machine(case.rng(1)), instruments_of(case)

    def heard(number: int, hidden=base, effects=()):  # type: ignore[no-untyped-def]
        return another_test(case, number, hidden, effects, ways)[0]

    first = heard(1)
    assert first.shape == (1 + len(case.sensors), 24000)
    noisy = with_noise(case, [first], noises, 1)[0]
    np.testing.assert_array_equal(noisy[0], first[0])
    share = (noisy - first)[1:].std(axis=1) / first[1:].std(axis=1)
    assert np.all((share > 0.07) & (share < 0.14)), "20 dB of the sound machine's"
    assert not np.allclose(with_noise(case, [first], noises, 2)[0], noisy)
    pitted = heard(1, effects=case.effects)
    np.testing.assert_array_equal(pitted[0], first[0], "the same turn of the shaft")
    assert np.abs(levels(pitted, 35) - levels(first, 35)).max() > 6.0, "a pit of 1.5 mm"
    few = replace(base, factors={"kp": base.factors["kp"]})
    again = []

    def moved(hidden):  # type: ignore[no-untyped-def]
        again.append(heard(1, replace(base, factors={**base.factors, **hidden.factors})))
        return levels(again[-1], 35)

    found = drifts(few, moved)
    np.testing.assert_array_equal(again[0], first, "the same machine at the same time")
    assert found.shape == (1, levels(first, 35).size) and 0.01 < np.abs(found).max() < 10.0
