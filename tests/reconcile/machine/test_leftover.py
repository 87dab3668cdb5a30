"""What a fitted effect leaves: likelihoods, the features it does not move, and who is asked to stand beside it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reconcile.machine.leftover import LARGE, NEAREST, OWN_SHARE, Leftover, leftover, ranked_seconds
from reconcile.machine.pairs import evidence_in
from reconcile.observe.phases import HALF_TURN_DB
from tests.reconcile.machine.rubs import FEATURES, MADE, RIGHT, WRONG, found_in

TRUE = np.array([0.06, -0.05, 0.03])


def seen(second: float | None = None) -> np.ndarray:
    """A rub at the gear; one of so many N/m at the pinion beside it."""
    noise = np.random.default_rng(8).normal(0, 1, FEATURES)
    both = MADE.change(RIGHT, TRUE, 2e7) + noise
    return both if second is None else both + MADE.change(WRONG, TRUE, second)


def left_of(observed: np.ndarray) -> Leftover:
    setting, found = found_in(observed)
    rows = list(found.known.library.groups[RIGHT])
    return leftover(setting, found, RIGHT, evidence_in(found.fitted, found.known.library.changes[rows], observed))  # type: ignore[arg-type]


def test_the_nearest_draws_speak_and_what_they_do_not_move_is_quiet() -> None:
    left = left_of(seen())
    assert left.members.shape == (NEAREST, FEATURES) and left.used.all()
    assert not left.quiet[:30].any() and left.quiet[30:].all()
    assert left.base == left.level(left.members) >= float(np.median(left.likelihood(left.members)))


def test_the_tolerance_is_the_observations_whatever_is_supposed() -> None:
    observed = seen()
    left = left_of(observed)
    assert np.all(left.variance >= 1.0 + (OWN_SHARE * observed) ** 2)
    far = np.array([observed + 100.0])
    assert left.likelihood(np.array([observed]))[0] == 0.0, "met to the last feature"
    assert left.likelihood(far)[0] < -0.5 * FEATURES * LARGE**2


@given(st.floats(0.1, 50.0), st.floats(0.1, 50.0))
def test_what_is_farther_off_is_less_likely_and_counts_by_its_logarithm(near: float, more: float) -> None:
    every = np.ones(4, dtype=bool)
    left = Leftover(
        observed=np.zeros(4), members=np.zeros((2, 4)), variance=np.ones(4), used=every, quiet=every, turns=~every
    )
    a, b = left.likelihood(np.full((1, 4), near))[0], left.likelihood(np.full((1, 4), near + more))[0]
    assert b < a <= 0.0
    assert a == pytest.approx(-2.0 * (LARGE * np.log1p(near / LARGE)) ** 2)
    assert a >= -0.5 * 4 * near**2 - 1e-9


def test_phases_are_known_up_to_whole_turns() -> None:
    observed = seen()
    setting, found = found_in(observed)
    setting.changes = replace(setting.changes, phases=5)
    rows = list(found.known.library.groups[RIGHT])
    told = evidence_in(found.fitted, found.known.library.changes[rows], observed)
    left = leftover(setting, found, RIGHT, told)  # type: ignore[arg-type]
    channel = setting.changes.single.chosen.size
    assert np.array_equal(np.flatnonzero(left.turns), np.flatnonzero(np.arange(FEATURES) % channel >= channel - 5))
    turned = np.array([observed])
    turned[:, left.turns] += 2.0 * HALF_TURN_DB
    assert left.likelihood(turned)[0] == pytest.approx(0.0, abs=1e-9)
    turned[:, ~left.turns] += 2.0 * HALF_TURN_DB
    assert left.likelihood(turned)[0] < -100.0
    either = found.known.library.changes.copy()
    either[np.ix_(rows[::2], np.flatnonzero(left.turns))] += 2.0 * HALF_TURN_DB
    found = replace(found, known=replace(found.known, library=replace(found.known.library, changes=either)))
    again = leftover(setting, found, RIGHT, told)  # type: ignore[arg-type]
    assert again.variance == pytest.approx(left.variance) and again.base == pytest.approx(left.base)


def test_measurement_drift_and_the_draws_spread_are_tolerated() -> None:
    observed = seen()
    setting, found = found_in(observed)
    rows = list(found.known.library.groups[RIGHT])
    told = evidence_in(found.fitted, found.known.library.changes[rows], observed)
    changes = setting.changes
    least = 1.0 + (OWN_SHARE * observed) ** 2
    spread = left_of(observed).members.std(axis=0) ** 2
    setting.changes = replace(changes, null=0.0 * changes.null, measured=np.full(FEATURES, 2.0))
    left = leftover(setting, found, RIGHT, told)  # type: ignore[arg-type]
    assert left.variance == pytest.approx(least + 4.0 + spread)
    setting.changes = replace(changes, measured=np.zeros(FEATURES))
    left = leftover(setting, found, RIGHT, told)  # type: ignore[arg-type]
    assert left.variance == pytest.approx(least + changes.null.std(axis=0) ** 2 + spread)


def test_what_is_not_known_is_left_out() -> None:
    observed = seen()
    observed[:10] = np.nan
    left = left_of(observed)
    assert not left.used[:10].any() and np.isfinite(left.base)
    changes = np.zeros((1, FEATURES))
    changes[0, 10:20] = np.nan
    assert np.isfinite(left.likelihood(changes)[0])


def test_a_second_that_is_there_adds_and_one_that_is_not_adds_nothing() -> None:
    for second, least, most in ((5e6, 12.0, np.inf), (None, -np.inf, 2.0)):
        observed = seen(second)
        setting, found = found_in(observed)
        ((name, gain, rows),) = ranked_seconds(left_of(observed), setting.changes, found.known, [WRONG])
        assert name == WRONG and least < gain < most
        assert set(rows) == set(found.known.library.groups[WRONG])
        gains = left_of(observed).by_sums(setting.changes, found.known.library.changes[list(rows)])
        assert np.all(np.diff(gains) <= 0.0) and gains[0] == gain, "the best rows first"


def test_what_is_added_at_each_operating_point_makes_the_whole() -> None:
    left = left_of(seen(5e6))
    shown = left.members + MADE.change(WRONG, TRUE, 5e6)
    parts = left.by_point(shown, 2)
    assert parts.shape == (2,) and parts.sum() == pytest.approx(left.level(shown) - left.base)
    assert abs(parts[0]) < 1e-9 and parts[1] > 12.0, "the second moves the second half of the features alone"
    assert left.by_point(left.members, 3) == pytest.approx([0.0, 0.0, 0.0])


def test_quiet_features_tell_where_sums_err_on_the_others() -> None:
    observed = seen(5e6)
    setting, _ = found_in(observed)
    left = left_of(observed)
    second = MADE.change(WRONG, TRUE, 5e6)
    spoilt = second.copy()
    spoilt[:30] = -40.0
    whole = replace(left, quiet=left.used)
    assert left.by_sums(setting.changes, spoilt[None])[0] > 12.0 > whole.by_sums(setting.changes, spoilt[None])[0]
