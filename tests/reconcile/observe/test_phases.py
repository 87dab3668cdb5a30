"""Phases between sensors: their change knows neither the paths nor where a recording begins."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reconcile.observe.extract import extract
from reconcile.observe.phases import (
    DB_PER_RAD,
    FREE_DB,
    HALF_TURN_DB,
    between_sensors,
    mean_phases,
    phase_deviations,
    wrapped,
)
from signals.series import FloatArray

RATE_HZ = 8192.0
TIME_S = np.arange(8192) / RATE_HZ
LINES_HZ = np.array([200.0, 431.3])


def phases_of(samples: FloatArray, lines_hz: FloatArray = LINES_HZ) -> FloatArray:
    found = extract(
        samples,
        RATE_HZ,
        lines_hz=lines_hz,
        line_slack=np.full(lines_hz.size, 1e-3),
        modulations_hz=np.array([20.0]),
        modulation_slack=np.zeros(1),
        phased=range(lines_hz.size),
    )
    return found.phase


def heard(phases_rad: FloatArray, *, start_s: float = 0.0, wander_rad: float = 0.0) -> FloatArray:
    """Two lines on as many sensors as rows of `phases_rad` (C, 2), of unlike loudness; the angle may wander."""
    time = TIME_S + start_s
    angle = wander_rad * np.sin(2 * np.pi * 1.3 * time) / 200.0
    loud = np.array([1.0, 30.0, 0.02])[: len(phases_rad), None, None]
    turning = 2 * np.pi * LINES_HZ[None, :, None] * time + LINES_HZ[None, :, None] * angle
    return np.asarray(np.sum(loud * np.cos(turning + phases_rad[:, :, None]), axis=1))


angles = st.lists(st.floats(-3.1, 3.1), min_size=6, max_size=6).map(lambda x: np.array(x).reshape(3, 2))


@settings(max_examples=25, deadline=None)
@given(phases=angles, start_s=st.floats(0.0, 1.0))
def test_phases_between_sensors_do_not_depend_on_where_the_recording_begins(phases: FloatArray, start_s: float) -> None:
    found = between_sensors(phases_of(heard(phases, start_s=start_s)))
    expected = wrapped(DB_PER_RAD * (phases - np.roll(phases, -1, axis=0)))
    np.testing.assert_allclose(wrapped(found - expected), 0.0, atol=0.05)


@pytest.mark.parametrize("wander_rad", [0.5, 1.5])
def test_slow_wander_of_the_speed_smears_a_line_and_keeps_its_phases(wander_rad: float) -> None:
    phases = np.array([[0.3, -1.0], [2.0, 0.4], [-2.5, 1.1]])
    still, wandering = (between_sensors(phases_of(heard(phases, wander_rad=w))) for w in (0.0, wander_rad))
    np.testing.assert_allclose(wrapped(wandering - still), 0.0, atol=0.1)


def test_a_path_that_stays_drops_out_of_the_change() -> None:
    before, effect = np.array([[0.1, 0.2], [1.0, -2.0]]), np.array([[0.0, 0.0], [0.4, 0.0]])
    path = np.array([[2.9, -0.7], [-1.8, 3.0]])
    seen = [between_sensors(phases_of(heard(p + path))) for p in (before, before + effect)]
    np.testing.assert_allclose(wrapped(seen[1] - seen[0])[:, 0], [-0.4 * DB_PER_RAD, 0.4 * DB_PER_RAD], atol=0.05)
    np.testing.assert_allclose(wrapped(seen[1] - seen[0])[:, 1], 0.0, atol=0.05)


def test_one_sensor_has_no_phases_to_compare_and_lines_above_the_band_none() -> None:
    single = phases_of(heard(np.array([[1.0, 2.0]])), np.array([200.0, 3900.0]))
    np.testing.assert_allclose(between_sensors(single)[:, 0], 0.0)
    assert np.isnan(single[:, 1]).all()


def test_recordings_of_one_condition_are_averaged_whatever_phase_they_share() -> None:
    phases = np.array([[0.3, np.nan], [2.9, np.nan], [-2.9, np.nan]])
    several = [phases + shift for shift in (0.0, 2.0, -1.0)]
    found = mean_phases(several)
    np.testing.assert_allclose(wrapped(between_sensors(found) - between_sensors(phases))[:, 0], 0.0, atol=1e-9)
    assert np.isnan(found[:, 1]).all()
    assert mean_phases(several[:1]) is several[0]


@pytest.mark.slow
def test_the_deviation_in_noise_is_the_one_that_repeated_recordings_show() -> None:
    rng = np.random.default_rng(1)
    phases = np.array([[0.3, -1.0], [2.0, 0.4]])
    clean = heard(phases)
    sigma = np.array([[2.0], [20.0]])
    runs = [between_sensors(phases_of(clean + sigma * rng.standard_normal(clean.shape))) for _ in range(80)]
    spread = np.std([wrapped(r - runs[0]) for r in runs], axis=0)
    power = 0.5 * np.array([[1.0, 1.0], [900.0, 900.0]])
    lobe = 2.0 * sigma**2 / RATE_HZ * 5.0 * np.ones((2, 2))
    np.testing.assert_allclose(phase_deviations(power, lobe) / spread, 1.0, atol=0.2)


def test_of_a_line_in_the_noise_nothing_is_known() -> None:
    assert phase_deviations(np.zeros((2, 1)), np.ones((2, 1))) == pytest.approx(FREE_DB)
    assert pytest.approx(FREE_DB * np.sqrt(3.0)) == HALF_TURN_DB
