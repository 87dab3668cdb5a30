"""Speeds of made signals come back; noise gives no speed; mains lines and wrong labels do not mislead."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.speed import estimate_speed, shaft_angle
from reconcile.speed.excess import power_over_floor
from signals.recording import Operating, Recording, Tacho
from signals.spectra.angle import tacho_angle
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE_HZ = 8000.0


def recorded(samples, stated_hz: float | None, tacho: Tacho | None = None) -> Recording:  # type: ignore[no-untyped-def]
    rows = np.atleast_2d(samples)
    names = [f"a{i}" for i in range(rows.shape[0])]
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=tuple(Channel(name=n, quantity="acceleration", unit="g", location="", axis="") for n in names),
        samples=rows,
        operating=None if stated_hz is None else Operating(shaft="shaft", speed_hz=stated_hz),
        tacho=tacho,
    )


def comb(angle, orders, seed: int, noise: float = 1.0):  # type: ignore[no-untyped-def]
    rng = np.random.default_rng(seed)
    lines = sum(rng.uniform(0.3, 1.0) * np.cos(k * angle + rng.uniform(0, 6)) for k in orders)
    return lines + noise * rng.standard_normal(angle.size)


@pytest.mark.parametrize("error", [-0.07, -0.03, 0.0, 0.02, 0.07])
@pytest.mark.parametrize("true_hz", [11.3, 24.6])
def test_a_wrong_label_is_put_right(error: float, true_hz: float) -> None:
    angle = 2 * np.pi * true_hz * np.arange(int(6 * RATE_HZ)) / RATE_HZ
    found = estimate_speed(recorded(comb(angle, (1, 2, 3, 4, 6), 1), true_hz * (1 + error)))
    assert found.method == "harmonics"
    assert found.speed_hz == pytest.approx(true_hz, rel=1e-3)
    assert found.low_hz <= true_hz <= found.high_hz


def test_teeth_alone_give_the_speed() -> None:
    angle = 2 * np.pi * 17.2 * np.arange(int(6 * RATE_HZ)) / RATE_HZ
    found = estimate_speed(recorded(comb(angle, (31, 62, 93), 2), 16.5), orders=(31.0, 62.0, 93.0))
    assert found.speed_hz == pytest.approx(17.2, rel=1e-4)


def test_a_line_near_the_shafts_own_does_not_lead_away_from_the_teeth() -> None:
    """Short records resolve 0.8 Hz: a foreign line so near to the first harmonic of the shaft is within reach of it."""
    time = np.arange(int(1.2 * RATE_HZ)) / RATE_HZ
    teeth = comb(2 * np.pi * 30.05 * time, (23, 46, 69), 2, noise=0.3)
    found = estimate_speed(recorded(teeth + 2.0 * np.cos(2 * np.pi * 30.85 * time), 30.0), orders=(23.0, 46.0))
    assert found.speed_hz == pytest.approx(30.05, rel=3e-4)
    assert found.high_hz - found.low_hz < 0.2


@pytest.mark.parametrize("error", [-0.03, 0.0, 0.02])
@pytest.mark.parametrize("true_hz", [14.7, 23.1, 33.5])
def test_a_single_line_gives_the_speed_to_half_a_bin(true_hz: float, error: float) -> None:
    """Two seconds resolve half a hertz: several per cent of a slow shaft, in all of which its line is within reach."""
    angle = 2 * np.pi * true_hz * np.arange(int(2 * RATE_HZ)) / RATE_HZ
    found = estimate_speed(recorded(comb(angle, (1,), 6), true_hz * (1 + error)))
    assert found.method == "harmonics"
    assert found.speed_hz == pytest.approx(true_hz, abs=0.25)
    assert found.low_hz <= true_hz <= found.high_hz


@pytest.mark.slow
def test_a_bearings_lines_seldom_lead_away_from_a_single_line() -> None:
    """Of races whose lines come near a multiple of the shaft's that multiple is all there is."""
    rng = np.random.default_rng(8)
    time = np.arange(int(2 * RATE_HZ)) / RATE_HZ
    away = 0
    for i in range(30):
        true_hz, order = rng.uniform(20.0, 40.0), rng.choice([2.4, 3.57, 4.42, 5.58])
        rows = comb(2 * np.pi * true_hz * time, (1, order, 2 * order), i)
        found = estimate_speed(recorded(rows, true_hz))
        away += found.method == "harmonics" and abs(found.speed_hz / true_hz - 1) > 0.25 / true_hz
    assert away <= 3


def test_mains_lines_are_no_shaft() -> None:
    t = np.arange(int(8 * RATE_HZ)) / RATE_HZ
    mains = sum(3 * np.cos(2 * np.pi * 50 * k * t) for k in (1, 2, 3, 4))
    found = estimate_speed(recorded(comb(2 * np.pi * 17.3 * t, (1, 2, 4, 5), 3) + mains, 50 / 3))
    assert found.speed_hz == pytest.approx(17.3, rel=1e-3)


@pytest.mark.slow
def test_noise_seldom_passes_for_a_speed() -> None:
    rng = np.random.default_rng(4)
    hits = 0
    for i in range(40):
        found = estimate_speed(recorded(rng.standard_normal(int(3 * RATE_HZ)), 20.0), seed=i)
        hits += found.method != "stated"
    assert hits <= 14  # confidence 0.8 is passed by one in five; two standard deviations more


def test_pulses_come_first() -> None:
    pulses = np.arange(60) / 13.0
    recording = recorded(
        np.random.default_rng(0).standard_normal(int(5 * RATE_HZ)), 12.0, Tacho(shaft="shaft", pulse_times_s=pulses)
    )
    found = estimate_speed(recording)
    assert (found.method, found.speed_hz) == ("tacho", pytest.approx(13.0))
    angle = shaft_angle(recording, found)
    known = np.isfinite(angle)
    assert np.allclose(np.diff(angle[known]), 2 * np.pi * 13.0 / RATE_HZ)


@pytest.mark.slow
def test_a_wandering_speed_is_followed() -> None:
    t = np.arange(int(8 * RATE_HZ)) / RATE_HZ
    angle = 2 * np.pi * 21.0 * (t + 0.004 * np.sin(2 * np.pi * 0.3 * t) / (2 * np.pi * 0.3))
    orders = (1, 2, 3, 4, 5, 6, 25, 50)
    recording = recorded(comb(angle, orders, 5, 0.3), 21.2)
    found = estimate_speed(recording, orders=(25.0, 50.0))
    track = shaft_angle(recording, found, orders=(25.0, 50.0))
    known = np.isfinite(track)
    error = track[known] - angle[known]
    assert np.std(error) < 0.02


def test_without_any_speed_it_is_refused() -> None:
    with pytest.raises(SpecError, match="speed_hz"):
        estimate_speed(recorded(np.random.default_rng(0).standard_normal(8000), None))
    with pytest.raises(SpecError, match=r"too short .*given '0.1 s, 2 turns'.* 0.2 s at 20 Hz"):
        estimate_speed(recorded(np.random.default_rng(0).standard_normal(800), 20.0))


def test_power_over_floor_of_noise_is_exponential() -> None:
    power = np.random.default_rng(1).exponential(size=50_000) * np.linspace(1, 100, 50_000)
    ratio = power_over_floor(power)
    assert np.mean(ratio) == pytest.approx(1.0, abs=0.03)
    assert np.mean(ratio > 5) == pytest.approx(np.exp(-5), rel=0.15)


def test_few_pulses_known_to_a_sample_do_not_shake_the_angle() -> None:
    rate, time = 20_000.0, np.arange(60_000) / 20_000.0
    turns = 30.0 * (time + 1e-3 / (2 * np.pi * 0.7) * np.sin(2 * np.pi * 0.7 * time))
    times = np.flatnonzero(np.diff(np.floor(turns)) > 0) / rate
    tacho = Tacho(shaft="shaft", pulse_times_s=times, pulses_per_revolution=1)
    made = Recording(
        sampling_rate_hz=rate,
        channels=(Channel(name="a", quantity="acceleration", unit="g", location="", axis=""),),
        samples=np.zeros((1, time.size)),
        operating=Operating(shaft="shaft", speed_hz=30.0),
        tacho=tacho,
    )
    angle = shaft_angle(made, estimate_speed(made))
    known = np.isfinite(angle)

    def shake(found: np.ndarray) -> float:
        """Deviation from the true angle but for its start, rad of the fifth harmonic of 21 teeth."""
        off = 5 * 21 * (found[known] - 2 * np.pi * turns[known])
        return float(np.std(off))

    rough = tacho_angle(made.series("a"), tacho)
    assert shake(angle) < 0.75 * shake(rough)


def test_pulses_of_a_few_turns_are_no_recording_to_judge() -> None:
    rows = np.random.default_rng(3).normal(size=int(0.1 * RATE_HZ))
    pulses = Tacho(shaft="shaft", pulse_times_s=np.arange(0.0, 0.1, 1 / 30.0), pulses_per_revolution=1)
    with pytest.raises(SpecError, match="too short"):
        estimate_speed(recorded(rows, 30.0, pulses))
