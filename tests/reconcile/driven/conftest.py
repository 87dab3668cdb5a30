"""Recordings of made oscillators that several files take."""

from __future__ import annotations

import pytest

from signals.recording import Recording
from tests.reconcile.driven.made import STIFFNESS, recording


@pytest.fixture(scope="module")
def linear() -> Recording:
    return recording(None, seed=3, noise=0.005)


@pytest.fixture(scope="module")
def sound() -> Recording:
    return recording(None, seed=9, noise=0.005)


@pytest.fixture(scope="module")
def stiffening() -> Recording:
    return recording(lambda x, _v: 0.3 * STIFFNESS * x**3 / 1e-6, seed=3, n=5000, noise=0.005)
