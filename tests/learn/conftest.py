import numpy as np
import pytest

from learn.orders import of_ratio

GEARED_HZ, GEARED_TURNS_HZ = 12_800.0, 25.0


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


@pytest.fixture
def stage():
    """A stage of 23 and 57 teeth at 25 Hz, modulated as sound ones are; a tooth of gear 0 or 1 rings at 2.1 kHz."""

    def make(*, tooth=None, turns=60.0, size=0.5, noise=0.1, wander=0.0, teeth=(23, 57), seed=0):
        rng = np.random.default_rng(seed)
        n = int(turns / GEARED_TURNS_HZ * GEARED_HZ)
        t = np.arange(n) / GEARED_HZ
        angle = 2 * np.pi * GEARED_TURNS_HZ * t + 2 * np.pi * GEARED_TURNS_HZ * wander * np.sin(2 * np.pi * 0.4 * t) / (
            2 * np.pi * 0.4
        )
        gain = 1 + 0.4 * np.cos(angle + 1) + 0.3 * np.cos(3 * angle) + 0.3 * np.cos(angle * teeth[0] / teeth[1])
        x = gain * sum(a * np.cos(k * teeth[0] * angle + k) for k, a in ((1, 1.0), (2, 0.6), (3, 0.3)))
        if tooth is not None:
            own = angle / (2 * np.pi) * (teeth[0] / teeth[tooth])
            hits = np.flatnonzero(np.diff(np.floor(own + 0.7)) > 0)
            train = np.zeros(n)
            train[hits] = size
            ring = np.exp(-np.arange(60) / 12) * np.sin(2 * np.pi * 2100 * np.arange(60) / GEARED_HZ)
            x = x + np.convolve(train, ring)[:n]
        return x + noise * rng.standard_normal(n), angle

    return make
