"""A single steady line at the stated speed is that speed: neither its skirt nor its flanks lead to another."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from reconcile.speed import estimate_speed, line_logs
from reconcile.speed.estimate import LARGEST_LOG, narrowed
from reconcile.speed.excess import skirts
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ = 20_000.0
N = 55_500


def turning(speed_hz: float, stated_hz: float, *, line: float, others: dict[float, float], seed: int = 0) -> Recording:
    """A line at the speed and some at other frequencies over noise of deviation one, on three channels."""
    rng = np.random.default_rng(seed)
    t = np.arange(N) / RATE_HZ
    rows = []
    for _ in range(3):
        tones = [a * np.sin(2 * np.pi * (hz * t + rng.uniform())) for hz, a in ({speed_hz: line} | others).items()]
        rows.append(np.sum(tones, axis=0) + rng.standard_normal(N))
    channels = tuple(
        Channel(name=f"a{c}", quantity="acceleration", unit="m/s^2", location="bearing1") for c in range(3)
    )
    operating = Operating(shaft="input", speed_hz=stated_hz)
    return Recording(sampling_rate_hz=RATE_HZ, channels=channels, samples=np.stack(rows), operating=operating)


@given(speed_hz=st.floats(38.0, 42.0), seed=st.integers(0, 20))
def test_a_lone_line_is_the_speed(speed_hz: float, seed: int) -> None:
    found = estimate_speed(turning(speed_hz, 40.0, line=3.0, others={}, seed=seed))
    assert found.method == "harmonics"
    assert found.speed_hz == pytest.approx(speed_hz, abs=0.5 * RATE_HZ / N)


@pytest.mark.parametrize("line", [3.0, 1e2, 1e4])
@pytest.mark.parametrize("foreign_hz", [206.75, 123.9, 165.4])
def test_foreign_lines_do_not_lead_away_from_it(line: float, foreign_hz: float) -> None:
    """Its flank and a foreign line, or its skirt and two, made 41.35 of 40 Hz and 31.27 of 30."""
    found = estimate_speed(turning(40.0, 40.0, line=line, others={foreign_hz: 0.2, 4 * 41.35: 0.2}))
    assert found.speed_hz == pytest.approx(40.0, abs=0.5 * RATE_HZ / N)


def test_a_skirt_is_no_line_and_a_line_beside_it_is() -> None:
    t = np.arange(N) / RATE_HZ
    strong = turning(40.1, 40.0, line=3e3, others={})
    log, resolution = line_logs(strong)[0]
    assert np.flatnonzero(log > 0.0) * resolution == pytest.approx(40.1, abs=1.01)
    beside = strong.samples + 30.0 * np.sin(2 * np.pi * 43.0 * t)
    power = np.abs(np.fft.rfft(beside[0] * np.hanning(N))) ** 2
    hidden = skirts(power / np.median(power))
    assert not hidden[round(43.0 * N / RATE_HZ)]
    assert hidden[round(37.0 * N / RATE_HZ)]


def test_of_a_steady_line_the_middle_counts_and_of_a_spread_one_all() -> None:
    steady, spread = np.zeros(30), np.zeros(30)
    steady[9:12] = LARGEST_LOG - 1.4, LARGEST_LOG, LARGEST_LOG - 1.4
    spread[8:14] = 6.0, 8.0, 9.0, 8.5, 8.0, 5.0
    assert np.flatnonzero(narrowed(steady)).tolist() == [10]
    assert np.array_equal(narrowed(spread), spread)
