"""Saturation is told from smooth peaks."""

from __future__ import annotations

import numpy as np

from reconcile.driven.ceiling import ceilings


def test_a_clipped_sine_stands_at_both_ends() -> None:
    values = np.clip(np.sin(np.linspace(0, 40, 2000)), -0.6, 0.8)
    upper, lower = ceilings(values)
    assert (upper.level, upper.upper) == (0.8, True)
    assert (lower.level, lower.upper) == (-0.6, False)
    assert upper.samples > 300
    assert "0.8 V" in upper.words("V")


def test_smooth_slow_peaks_and_noise_do_not() -> None:
    assert ceilings(np.sin(np.linspace(0, 20, 20_000))) == ()
    assert ceilings(np.random.default_rng(0).normal(size=5000)) == ()
    assert ceilings(np.zeros(10)) == ()
