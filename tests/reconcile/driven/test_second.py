"""The response of two resonances, also where a fit runs off."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.driven.second import _both

OMEGA = np.linspace(0.0, 3000.0, 301)


def test_each_resonance_adds_its_own_response() -> None:
    first, other = [np.log(400.0), 0.02, 1e-6], [np.log(900.0), 0.03, 2e-7]
    found = _both(np.array([*first, *other]), OMEGA, 0)
    assert found[0] == pytest.approx(1.2e-6), "the static gains add"
    assert np.abs(found[40]) == pytest.approx(1e-6 / 0.04, rel=0.02), "a gain over twice the damping ratio"
    assert np.allclose(_both(np.array([*other, *first]), OMEGA, 1), 1j * OMEGA * found)


@pytest.mark.parametrize("away", [-567246.0, 567246.0])
def test_a_frequency_that_runs_off_stays_a_number(away: float) -> None:
    found = _both(np.array([np.log(400.0), 0.02, 1e-6, away, 0.02, 1e-7]), OMEGA, 0)
    assert np.all(np.isfinite(found))
