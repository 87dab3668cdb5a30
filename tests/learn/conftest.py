import numpy as np
import pytest

from learn.orders import of_ratio


@pytest.fixture
def bearing():
    """Nine balls, d/D 0.2034: BPFO 3.585, BPFI 5.415."""
    return of_ratio(9, 0.2034)


@pytest.fixture
def impacts():
    """Impulses at `order`, optionally weighted by the turning shaft, ringing at 3 kHz in noise."""

    def make(order, *, turns=40.0, speed=25.0, rate=20_000.0, noise=0.3, weight=0.0, seed=0):
        rng = np.random.default_rng(seed)
        n = int(turns / speed * rate)
        x = np.zeros(n)
        times = np.arange(0, turns, 1 / order) if order else np.zeros(0)
        at = np.minimum((times / speed * rate).astype(int), n - 1)
        x[at] = 1.0 + weight * np.cos(2 * np.pi * times)
        t = np.arange(200) / rate
        ring = np.exp(-t * 800) * np.sin(2 * np.pi * 3000 * t)
        return np.convolve(x, ring)[:n] + noise * 0.3 * rng.standard_normal(n)

    return make
