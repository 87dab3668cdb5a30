"""Chances beyond the controls."""

import numpy as np
import pytest

from reconcile.tail import tail_chance


def test_tail_chance_follows_an_exponential_tail() -> None:
    controls = np.random.default_rng(4).exponential(size=300)
    for value in (1.0, 4.0, 8.0):
        assert np.log(tail_chance(controls, value)) == pytest.approx(-value, abs=0.35 + 0.12 * value)
    assert tail_chance(controls, 1e3) == 1e-6
