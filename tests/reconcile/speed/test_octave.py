"""A stated speed wrong by a factor of two has harmonics that fit: it is said, and only then."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.speed import estimate_speed
from tests.reconcile.speed.test_speed import RATE_HZ, comb, recorded

TRUE_HZ = 24.3
ANGLE = 2 * np.pi * TRUE_HZ * np.arange(int(6 * RATE_HZ)) / RATE_HZ


@pytest.mark.parametrize(("factor", "rival"), [(0.5, TRUE_HZ), (2.0, TRUE_HZ), (1.0, None)])
def test_a_factor_of_two_leaves_a_rival(factor: float, rival: float | None) -> None:
    found = estimate_speed(recorded(comb(ANGLE, (1, 2, 3, 4, 6), 1), factor * TRUE_HZ))
    assert found.method == "harmonics"
    assert found.rival_hz == (None if rival is None else pytest.approx(rival, rel=1e-3))


def test_one_odd_line_is_enough() -> None:
    found = estimate_speed(recorded(comb(ANGLE, (2, 3, 4, 6), 1), TRUE_HZ))
    assert (found.method, found.rival_hz) == ("harmonics", None)


def test_a_half_order_or_two_beside_all_harmonics_are_a_rub() -> None:
    rub = comb(ANGLE, (1, 2, 3, 4, 5, 6, 7, 8), 1) + 0.02 * comb(ANGLE, (0.5, 1.5), 2, noise=0.0)
    assert estimate_speed(recorded(rub, TRUE_HZ)).rival_hz is None


def test_teeth_decide() -> None:
    """A line of 23 teeth is none at twice the speed: a shaft without odd harmonics is not in doubt."""
    rows = comb(ANGLE, (2, 4, 6), 1) + comb(ANGLE, (23, 46), 2, noise=0.0)
    assert estimate_speed(recorded(rows, TRUE_HZ), orders=(23.0, 46.0)).rival_hz is None
    assert estimate_speed(recorded(rows, TRUE_HZ)).rival_hz == pytest.approx(2 * TRUE_HZ, rel=1e-3)
