"""Lines beside a tone are asked for in compiled loops: the same as asked one by one."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.gate.tones import BESIDE_BINS, BESIDE_DB, COMB, NARROW_DB, Heard


def peak(heard: Heard, hz: float, bins: float, least_db: float, *, narrow: bool) -> float | None:
    """As `Heard.peak`, of arrays."""
    excess, step = heard.excess, heard.step_hz
    low, high = max(9, int(np.floor(hz / step - bins))), min(excess.size - 9, int(np.ceil(hz / step + bins)) + 1)
    if low >= high:
        return None
    top = low + int(np.argmax(excess[low:high]))
    level, about = excess[top], max(excess[top - 8 : top - 2].max(), excess[top + 3 : top + 9].max())
    if level < 10 ** (least_db / 10) or level < excess[top - 1 : top + 2].max():
        return None
    return None if narrow and level < about * 10 ** (NARROW_DB / 10) else top * step


@pytest.mark.parametrize("size", [5, 19, 20, 60, 3000])
def test_a_spectrum_is_asked_as_arrays_are(size: int) -> None:
    rng, met = np.random.default_rng(size), 0
    for spacing in (3, 11, 40):
        excess = rng.exponential(size=size)
        excess[spacing // 2 :: spacing] *= 300.0
        heard = Heard(excess, 0.5, 12.0, np.zeros(0))
        for _ in range(100):
            hz, bins = float(rng.uniform(-10.0, 0.55 * size)), float(rng.choice([0.0, 1.5, 3.0]))
            for narrow in (False, True):
                found = heard.peak(hz, bins, 15.0, narrow=narrow)
                assert found == peak(heard, hz, bins, 15.0, narrow=narrow)
                met += found is not None
            count, every = int(rng.integers(1, 12)), int(rng.choice([1, 2, 3, 5]))
            around = [k for k in range(-COMB, COMB + 1) if count + k > 0 and (k % every if every > 1 else k)]
            places = [peak(heard, hz * (count + k) / count, BESIDE_BINS, BESIDE_DB, narrow=False) for k in around]
            seen = sum(place is not None for place in places)
            assert heard._beside(hz, count, every, 0.75) == (seen >= 0.75 * len(places))
    assert met > 0 or size < 20
