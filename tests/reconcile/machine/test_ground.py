"""What is added to a recorded baseline: read at its rate, through the sensors' gains, over its floors."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.run import RATE_HZ
from reconcile.calibrate.chain import band_centres_hz
from reconcile.machine.ground import Ground, ground_of
from reconcile.observe.steady import Steady

COUNT = round(RATE_HZ)
TONE = np.sin(2 * np.pi * 1000.0 * np.arange(COUNT) / RATE_HZ)


def test_a_motion_at_the_simulations_rate_is_read_at_the_recordings() -> None:
    at = Ground(white=np.zeros((1, 1)), factor=np.ones((1, 1)), count=12000, rate_hz=12800.0)
    found = np.abs(at.on_grid(TONE))
    assert found.size == 6001 and np.argmax(found) * 12800.0 / 12000 == pytest.approx(1000.0, abs=1.1)
    assert found.max() == pytest.approx(6000.0, rel=0.4)


def recorded(seed: int, size: float, rate_hz: float = 20000.0) -> Steady:
    samples = size * np.random.default_rng(seed).normal(size=(2, round(rate_hz)))
    return Steady(samples=samples, rate_hz=rate_hz, speed_hz=30.0, estimate=None)  # type: ignore[arg-type]


def test_test_and_added_motion_stand_over_the_floors_of_the_baseline() -> None:
    gain_db = np.stack([np.full(band_centres_hz().size, gain) for gain in (0.0, 20.0)])
    setting = SimpleNamespace(
        data=(SimpleNamespace(spectra=(recorded(1, 6.0), recorded(2, 2.0))),),
        seen_through=(SimpleNamespace(chain=SimpleNamespace(gain_db=gain_db)),),
    )
    ground, heard = ground_of(setting, 0)  # type: ignore[arg-type]
    assert ground.white.shape == heard.shape and ground.seconds == pytest.approx(ground.count / 20000.0)
    power = [np.mean(np.abs(rows[:, 1000:9000]) ** 2) for rows in (ground.white, heard)]
    assert power[1] / power[0] == pytest.approx(9.0, rel=0.1), "three times as large as the baseline"
    added = np.abs(ground.added(np.stack([TONE, TONE]))).max(axis=1)
    assert added[1] / added[0] == pytest.approx(10.0, rel=0.1), "twenty decibels more gain"


def test_nothing_is_added_to_no_baseline() -> None:
    setting = SimpleNamespace(data=(SimpleNamespace(spectra=(recorded(1, 1.0), None)),))
    with pytest.raises(ValueError, match="baseline"):
        ground_of(setting, 0)  # type: ignore[arg-type]
