"""Which sensors a map over a shaft's turn shows: those in which something stands out."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.report.figures.maps import varying

ANGLE = np.arange(72) * 5.0


def row(height: float, noise: float, seed: int = 1) -> list[float]:
    burst = height * np.exp(-(((ANGLE - 150.0) / 12.0) ** 2))
    return [float(v) for v in burst + noise * np.random.default_rng(seed).standard_normal(ANGLE.size)]


@pytest.mark.parametrize(
    ("values", "shown"),
    [
        (row(0.5, 0.02), True),
        (row(2.0, 0.1), True),
        (row(0.0, 0.3), False),
        (row(0.05, 0.002), False),  # too little to be of use, however even the rest
        (row(0.0, 1.0), True),  # much, wherever it is
    ],
)
def test_a_burst_is_shown_and_noise_is_not(values: list[float], shown: bool) -> None:
    kept, flat = varying({"angle_deg": ANGLE.tolist(), "rows": ["a"], "value": [values]})
    assert (kept["rows"] == ["a"], flat) == (shown, 0 if shown else 1)


@pytest.mark.parametrize("seed", range(20))
def test_noise_of_any_draw_is_not(seed: int) -> None:
    assert varying({"rows": ["a"], "value": [row(0.0, 0.2, seed)]})[1] == 1
