"""Another filter of the recorder is told from a machine, and what it cut off is not compared."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, sosfilt

from reconcile.gate import inspect_measurement
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.response import Channel

RATE_HZ = 20000.0
TIME = np.arange(30000) / RATE_HZ
CHANNELS = tuple(Channel(name=n, quantity="acceleration", unit="m/s^2", location=n) for n in ("bearing1", "bearing2"))


def recorded(speed_hz: float, seed: int) -> Recording:
    rng = np.random.default_rng(seed)
    lines = sum(np.sin(2 * np.pi * 20 * k * speed_hz * TIME + k) for k in range(1, 14))
    samples = np.array([[1.0], [0.5]]) * lines + rng.normal(size=(2, TIME.size)) * np.array([[0.5], [0.3]])
    operating = Operating(shaft="input", speed_hz=speed_hz)
    return Recording(sampling_rate_hz=RATE_HZ, channels=CHANNELS, samples=samples, operating=operating)


def judged(change: Callable[[FloatArray], FloatArray], rows: tuple[int, ...] = (0, 1)):  # type: ignore[no-untyped-def]
    tests = []
    for k, hz in enumerate((22.5, 30.0)):
        one = recorded(hz, 10 + k)
        samples = one.samples.copy()
        for row in rows:
            samples[row] = change(samples[row])
        tests.append(replace(one, samples=samples))
    return inspect_measurement([recorded(hz, k) for k, hz in enumerate((22.5, 30.0))], tests, mesh_orders=(20.0,))


def lowpass(corner_hz: float) -> Callable[[FloatArray], FloatArray]:
    return lambda x: np.asarray(sosfilt(butter(4, corner_hz, fs=RATE_HZ, output="sos"), x))


@pytest.mark.slow
@pytest.mark.parametrize("corner_hz", [2500.0, 4000.0])
def test_a_filter_on_all_channels_is_found_and_nothing_above_it_compared(corner_hz: float) -> None:
    gate = judged(lowpass(corner_hz))
    assert gate.fault is not None and gate.fault.kind == "filter_change" and gate.fault.channel == ""
    rates = {r.sampling_rate_hz for r in (*gate.tests, *gate.baselines)}
    assert len(rates) == 1
    assert 0.5 * corner_hz < 0.42 * rates.pop() < 1.1 * corner_hz
    again = inspect_measurement(gate.baselines, gate.tests, mesh_orders=(20.0,))
    assert again.fault is None, "below the corner test and baseline are alike"


@pytest.mark.slow
def test_what_differs_between_channels_or_has_no_corner_is_no_filter() -> None:
    assert all(f.kind != "filter_change" for f in judged(lowpass(3000.0), rows=(0,)).findings)
    assert all(f.kind != "filter_change" for f in judged(lambda x: 0.2 * x).findings)
    assert all(f.kind != "filter_change" for f in judged(lambda x: x).findings)


@pytest.mark.slow
def test_a_resonance_that_all_sensors_hear_is_no_filter() -> None:
    band = butter(2, [2500.0, 3500.0], "band", fs=RATE_HZ, output="sos")
    gate = judged(lambda x: x + 4.0 * np.asarray(sosfilt(band, x)))
    assert all(f.kind != "filter_change" for f in gate.findings)
