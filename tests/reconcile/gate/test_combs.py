"""Multiples of a supply's frequency among tones, and all that repeats with it taken out."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.gate.combs import supply_comb, without_comb
from signals.recording import Recording
from sim.core.response import Channel

STEP_HZ = 0.5
NUMBERS = (2, 4, 10, 18, 22, 30, 46)


@pytest.mark.parametrize("base", [49.97, 60.03])
def test_tones_at_multiples_of_a_supply_are_a_comb(base: float) -> None:
    tones = [round(n * base / STEP_HZ) * STEP_HZ for n in NUMBERS]
    assert supply_comb(tones, STEP_HZ) == pytest.approx(2 * base, rel=2e-4), "all numbers are even"
    assert supply_comb([*tones, 331.0], STEP_HZ) is not None, "one tone of another source is no matter"
    assert supply_comb(tones[:5], STEP_HZ) is None, "too few"


@pytest.mark.parametrize("base", [47.3, 55.0, 33.3])
def test_multiples_of_another_frequency_are_none(base: float) -> None:
    assert supply_comb([n * base for n in NUMBERS], STEP_HZ) is None


def test_tones_anywhere_are_none() -> None:
    rng = np.random.default_rng(1)
    assert all(supply_comb(sorted(rng.uniform(50, 6000, 12)), STEP_HZ) is None for _ in range(200))


def test_what_repeats_is_taken_out_and_other_lines_stay() -> None:
    time = np.arange(24000) / 12000
    train = np.exp(-(((np.mod(time, 1 / 99.983) - 5e-3) / 3e-4) ** 2))  # nothing of it is folded back
    rest = np.sin(2 * np.pi * 1234.5 * time) + 0.01 * np.random.default_rng(2).standard_normal(time.size)
    channel = Channel(name="a", quantity="acceleration", unit="m/s^2", location="bearing1")
    recording = Recording(sampling_rate_hz=12000.0, channels=(channel,), samples=(5 * train + rest)[None])
    left = without_comb(recording, "a", 99.98).samples[0] - rest
    assert np.std(left) < 0.01 * np.std(5 * train)
