"""A smooth sensor path is recovered from statistics; noise is told from the machine's own floor."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.calibrate.chain import Chain, Healthy, band_centres_hz, calibrate_chain
from reconcile.observe.statistics import SHAPE_BANDS_HZ, Statistics

CENTRES = band_centres_hz()
LINES_HZ = np.geomspace(40.0, 6000.0, 90)
RESOLUTION_HZ = 1.0
NOISE = 1e-6


def smooth_db(level: float, height: float, octaves: float, hz: np.ndarray) -> np.ndarray:
    return level + height * np.sin(2 * np.pi * np.log2(hz / 40.0) / octaves)


def statistics(line: np.ndarray, floor: np.ndarray) -> Statistics:
    shapes = np.ones((1, len(SHAPE_BANDS_HZ)))
    return Statistics(
        line=line[None],
        floor=floor[None],
        total=floor[None] * 0.2 * CENTRES,
        band=shapes,
        depth=np.zeros((1, len(SHAPE_BANDS_HZ), 1)),
        turn=np.zeros((1, len(SHAPE_BANDS_HZ), 1)),
        kurtosis=0 * shapes,
        skewness=0 * shapes,
        phase=0 * line[None],
        resolution_hz=RESOLUTION_HZ,
        duration_s=3.0,
    )


def healthy(seed: int) -> Healthy:
    power = 10 ** np.random.default_rng(seed).uniform(-1.0, 0.0, LINES_HZ.size)
    return Healthy(
        line=power[None], line_spread_db=np.full((1, LINES_HZ.size), 1.0), floor=np.full((1, CENTRES.size), 1e-15)
    )


def recorded(model: Healthy, gain_db: np.ndarray, seed: int, off_db: float = 1.0) -> Statistics:
    off = np.random.default_rng(seed).normal(0.0, off_db, LINES_HZ.size)
    line = model.line[0] * 10 ** ((gain_db + off) / 10) + NOISE * RESOLUTION_HZ
    return statistics(line, np.full(CENTRES.size, NOISE))


@settings(max_examples=25)
@given(
    level=st.floats(-20.0, 30.0), height=st.floats(0.0, 5.0), octaves=st.floats(4.0, 12.0), seed=st.integers(0, 10**6)
)
def test_a_smooth_gain_is_recovered(level: float, height: float, octaves: float, seed: int) -> None:
    model = healthy(seed)
    (chain,) = calibrate_chain(
        [recorded(model, smooth_db(level, height, octaves, LINES_HZ), seed + 1)], [model], [LINES_HZ]
    )
    inside = (CENTRES > 60.0) & (CENTRES < 4000.0)
    away = chain.gain_db[0] - smooth_db(level, height, octaves, CENTRES)
    assert np.abs(away[inside]).max() < 2.0
    np.testing.assert_allclose(chain.noise, NOISE, rtol=0.1)


def test_points_share_one_gain_and_keep_their_noise() -> None:
    models = [healthy(1), healthy(2)]
    gain_db = smooth_db(6.0, 3.0, 6.0, LINES_HZ)
    quiet = recorded(models[0], gain_db, 3)
    loud = statistics(recorded(models[1], gain_db, 4).line[0], np.full(CENTRES.size, 50 * NOISE))
    one, two = calibrate_chain([quiet, loud], models, [LINES_HZ, LINES_HZ])
    np.testing.assert_array_equal(one.gain_db, two.gain_db)
    np.testing.assert_allclose(two.noise / one.noise, 50.0, rtol=0.01)


def test_buried_lines_say_nothing_about_the_gain() -> None:
    model = healthy(5)
    buried = statistics(np.full(LINES_HZ.size, NOISE), np.full(CENTRES.size, NOISE))
    (chain,) = calibrate_chain([buried], [model], [LINES_HZ])
    np.testing.assert_array_equal(chain.gain_db, 0.0)


def test_one_wild_resonance_is_bounded() -> None:
    model = healthy(6)
    gain_db = np.where((LINES_HZ > 900) & (LINES_HZ < 1500), 60.0, 0.0)
    (chain,) = calibrate_chain([recorded(model, gain_db, 7)], [model], [LINES_HZ])
    assert np.ptp(chain.gain_db) <= 40.0 + 1e-9


def test_the_machines_own_floor_is_no_sensor_noise() -> None:
    model = Healthy(
        line=healthy(8).line,
        line_spread_db=np.ones((1, LINES_HZ.size)),
        floor=np.full((1, CENTRES.size), 0.7 * NOISE),
    )
    (chain,) = calibrate_chain([recorded(model, np.zeros(LINES_HZ.size), 9, off_db=0.0)], [model], [LINES_HZ])
    np.testing.assert_allclose(chain.noise, 0.3 * NOISE, rtol=0.05)


def test_a_recording_without_any_noise_stays_finite() -> None:
    model = healthy(10)
    silent = statistics(model.line[0], np.zeros(CENTRES.size))
    (chain,) = calibrate_chain([silent], [model], [LINES_HZ])
    assert np.all(chain.noise > 0) and np.all(np.isfinite(np.log(chain.noise)))


def test_gain_and_noise_between_the_bands() -> None:
    chain = Chain(gain_db=CENTRES[None] * 0 + 3.0, noise=np.full((1, CENTRES.size), 2.0))
    assert chain.line_gain(np.array([1.0, 500.0, 1e5])) == pytest.approx(10**0.3)
    assert chain.line_noise(np.array([77.0])) == pytest.approx(2.0)
    widths = [high - low for low, high in SHAPE_BANDS_HZ]
    np.testing.assert_allclose(chain.shape_noise()[0], 2.0 * np.array(widths))
    np.testing.assert_allclose(chain.shape_gain()[0], 10**0.3)
