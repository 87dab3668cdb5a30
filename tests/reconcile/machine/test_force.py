"""A force from what lines gained: closed forms, bounds that hold whatever the phases, and what cannot be told."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.machine.force import Heard, Squares, force_squares, mixed

LINES = 6
RESPONSE = 1e-4


def heard(
    test: np.ndarray, before: np.ndarray, *, share: float = 0.1, noise: float = 1e-8, response: np.ndarray | None = None
) -> Heard:
    """Channels by lines; one axis unless `response` (A, C, L) says otherwise."""
    known = np.full((1, *test.shape), RESPONSE) if response is None else response
    deviation = share * before + noise
    return Heard(test=test, before=before, deviation=deviation, response=known, spread_db=np.zeros(known.shape))


@pytest.mark.parametrize("force", [0.3, 3.0, 30.0])
def test_a_line_that_was_not_there_tells_the_force_in_closed_form(force: float) -> None:
    """Without anything to meet, power is F^2 R: the median is F, the band that of the response's error alone."""
    found = force_squares(heard(np.full((1, 1), force**2 * RESPONSE), np.zeros((1, 1))))
    assert np.sqrt(found.best[0]) == pytest.approx(force, rel=0.15)
    db = 10 * np.log10(np.array([found.low[0], found.high[0]]) / force**2)
    assert db == pytest.approx([-1.645 * 3.0, 1.645 * 3.0], abs=1.2)


def test_more_channels_tell_it_closer() -> None:
    def width(channels: int) -> float:
        one = force_squares(heard(np.full((channels, 1), 9.0 * RESPONSE), np.zeros((channels, 1))))
        assert np.sqrt(one.best[0]) == pytest.approx(3.0, rel=0.15)
        return float(one.high[0] / one.low[0])

    assert width(4) < 0.6 * width(1)


def test_what_did_not_change_may_be_nothing_and_has_an_upper_end() -> None:
    line = np.full((2, LINES), 1e-2)
    found = force_squares(heard(line, line))
    assert np.all(found.low == 0.0) and np.all(found.high > 0.0)
    assert np.all(np.sqrt(found.high) < 2.5 * np.sqrt(line[0] / RESPONSE))


def test_a_line_that_fell_tells_a_force_too() -> None:
    before = np.full((2, 1), 1e-2)
    found = force_squares(heard(0.01 * before, before))
    least = 0.9 * np.sqrt(before[0] / RESPONSE)
    assert found.low[0] > 0.0 and np.sqrt(found.low[0]) < least < np.sqrt(found.high[0])


@settings(deadline=None, max_examples=40)
@pytest.mark.slow
@given(seed=st.integers(0, 10**6), force=st.floats(0.1, 100.0), there=st.floats(0.0, 100.0))
def test_the_true_force_is_never_far_outside_the_band_whatever_the_phases(
    seed: int, force: float, there: float
) -> None:
    rng = np.random.default_rng(seed)
    before = RESPONSE * there**2 * rng.uniform(0.3, 3.0, (3, 1))
    phase = rng.uniform(0.0, 2 * np.pi, (3, 1))
    error = 10 ** (rng.normal(0.0, 2.0, (3, 1)) / 10)
    amplitude = np.sqrt(before) + force * np.sqrt(RESPONSE * error) * np.exp(1j * phase)
    found = force_squares(heard(np.abs(amplitude) ** 2, before))
    assert 0.25 * np.sqrt(found.low[0]) <= force <= 4.0 * np.sqrt(found.high[0])


@pytest.mark.slow
@given(scale=st.floats(1e-3, 1e3))
def test_it_goes_with_the_gain(scale: float) -> None:
    """Power of all channels times a gain, with the responses, leaves the force."""
    before, test = np.full((2, 2), 1e-3), np.array([[3e-3, 1e-3], [2e-3, 5e-4]])
    plain = force_squares(heard(test, before))
    more = force_squares(
        heard(scale * test, scale * before, noise=scale * 1e-8, response=np.full((1, 2, 2), scale * RESPONSE))
    )
    assert np.allclose(plain.best, more.best, rtol=1e-6) and np.allclose(plain.high, more.high, rtol=1e-6)


def test_axes_add_up_and_one_that_nobody_hears_counts_as_nothing() -> None:
    test, before = np.array([[4.0 * RESPONSE], [9.0 * RESPONSE]]), np.zeros((2, 1))
    response = np.array([[[RESPONSE], [np.nan]], [[np.nan], [RESPONSE]]])
    both = force_squares(heard(test, before, response=response))
    assert np.sqrt(both.best[0]) == pytest.approx(np.hypot(2.0, 3.0), rel=0.15)
    response[1] = np.nan
    assert np.sqrt(force_squares(heard(test, before, response=response)).best[0]) == pytest.approx(2.0, rel=0.15)
    response[0] = np.nan
    assert np.isnan(force_squares(heard(test, before, response=response)).best[0])


def test_channels_that_contradict_each_other_do_not_make_it_sure() -> None:
    alike = force_squares(heard(np.full((2, 1), 9.0 * RESPONSE), np.zeros((2, 1))))
    apart = force_squares(heard(np.array([[900.0 * RESPONSE], [0.09 * RESPONSE]]), np.zeros((2, 1))))
    assert apart.high[0] / max(apart.low[0], 1e-30) > 10 * alike.high[0] / alike.low[0]


def test_lines_far_below_the_strongest_may_be_its_mixing_products() -> None:
    squares = Squares(
        best=np.array([100.0, 0.5, np.nan]), low=np.array([50.0, 0.2, np.nan]), high=np.array([150.0, 1, 0])
    )
    assert mixed(squares).low[:2].tolist() == [50.0, 0.0] and np.isnan(mixed(squares).low[2])


def test_a_channel_without_any_signal_tells_nothing() -> None:
    silent = np.zeros((1, 2))
    found = force_squares(
        Heard(test=silent, before=silent, deviation=silent, response=np.ones((1, 1, 2)), spread_db=np.zeros((1, 1, 2)))
    )
    assert np.isnan(found.best).all()
