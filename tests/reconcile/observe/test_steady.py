"""The peak of a channel around a frequency."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.observe.steady import Steady, steady
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ, N = 8192.0, 8192


@pytest.fixture(scope="module")
def heard() -> Steady:
    """Two channels: a line at 431.5 Hz beside a faint one at 428, and one at 100 Hz."""
    t = np.arange(N) / RATE_HZ
    rows = [np.sin(2 * np.pi * 431.5 * t) + 0.01 * np.sin(2 * np.pi * 428.0 * t), np.sin(2 * np.pi * 100.0 * t)]
    channels = tuple(Channel(name=n, quantity="acceleration", unit="m/s^2", location=n) for n in "ab")
    operating = Operating(shaft="input", speed_hz=30.0)
    recording = Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows), operating=operating)
    return steady(recording, orders=(1.0, 2.0))


def test_the_peak_within_reach_is_where_the_line_stands(heard: Steady) -> None:
    step = heard.rate_hz / heard.samples.shape[1]
    assert heard.peak_hz(0, 429.0, 4.0) == pytest.approx(431.5, abs=step)
    assert heard.peak_hz(1, 101.0, 3.0) == pytest.approx(100.0, abs=step)


def test_what_is_out_of_reach_stays_where_it_was_looked_for(heard: Steady) -> None:
    step = heard.rate_hz / heard.samples.shape[1]
    assert heard.peak_hz(0, 428.0, 1.0) == pytest.approx(428.0, abs=1.0 + step)
    assert heard.peak_hz(0, 9000.0, 1.0) == 9000.0
