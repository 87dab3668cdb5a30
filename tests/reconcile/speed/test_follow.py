"""The angle is followed from the lines of the teeth, on all channels together, and only where it helps others."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.speed import followed_angle

RATE_HZ, SPEED_HZ, TEETH, SECONDS = 20_000.0, 30.0, 23, 1.2
ORDERS = [float(TEETH * k) for k in range(1, 9)]


def wandering(rms: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Time and the shaft's turns: three slow sines around the mean speed."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(RATE_HZ * SECONDS)) / RATE_HZ
    turns = SPEED_HZ * 1.003 * t
    for f in (0.4, 1.7, 4.2):
        size = rms * np.sqrt(2.0 / 3.0) * SPEED_HZ / (2 * np.pi * f)
        turns += size * np.cos(2 * np.pi * f * t + rng.uniform(0, 2 * np.pi))
    return t, turns


def recorded(turns: np.ndarray, *, noise: float, seed: int, orders: list[float]) -> np.ndarray:
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(3):
        parts = [rng.uniform(0.2, 1.0) * np.cos(2 * np.pi * k * turns + rng.uniform(0, 6.3)) for k in orders]
        rows.append(np.sum(parts, axis=0) + noise * rng.normal(size=turns.size))
    return np.array(rows)


@pytest.mark.slow
@pytest.mark.parametrize("rms", [0.001, 0.005])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_wander_is_found_to_two_hundredths_of_a_tooth(rms: float, seed: int) -> None:
    _, turns = wandering(rms, seed)
    samples = recorded(turns, noise=0.5, seed=seed, orders=ORDERS)
    angle = followed_angle(samples, RATE_HZ, SPEED_HZ, orders=ORDERS, slowest=TEETH / 81)
    assert angle is not None
    away = angle / (2 * np.pi) - turns
    away -= away.mean()
    assert np.sqrt(np.mean(away**2)) * TEETH < 0.02
    even = SPEED_HZ * np.arange(turns.size) / RATE_HZ - turns
    assert np.sqrt(np.mean((even - even.mean()) ** 2)) * TEETH > 0.1, "there was something to follow"


@pytest.mark.slow
def test_noise_is_not_followed() -> None:
    noise = np.random.default_rng(5).normal(size=(3, 24_000))
    assert followed_angle(noise, RATE_HZ, SPEED_HZ, orders=ORDERS, slowest=0.3) is None


@pytest.mark.slow
def test_a_line_foreign_to_the_shaft_does_not_bend_the_angle() -> None:
    """All orders but one are quiet; that one is a hum fixed in Hz: what follows it makes no other line sharper."""
    t, _ = wandering(0.002, 4)
    samples = np.sin(2 * np.pi * 700.0 * t) + 0.1 * np.random.default_rng(6).normal(size=(2, t.size))
    assert followed_angle(samples, RATE_HZ, SPEED_HZ, orders=ORDERS, slowest=0.3) is None


def test_what_a_turn_of_the_slowest_shaft_does_stays() -> None:
    """Run-out of the slow shaft turns the phase once a revolution: it must not be taken for wander."""
    t = np.arange(int(RATE_HZ * SECONDS)) / RATE_HZ
    slow = TEETH / 81
    turns = SPEED_HZ * t + 0.002 * np.sin(2 * np.pi * slow * SPEED_HZ * t)
    samples = recorded(turns, noise=0.1, seed=7, orders=ORDERS)
    angle = followed_angle(samples, RATE_HZ, SPEED_HZ, orders=ORDERS, slowest=slow)
    followed = np.zeros(t.size) if angle is None else angle / (2 * np.pi) - SPEED_HZ * t
    taken = abs(np.mean((followed - followed.mean()) * np.exp(-2j * np.pi * slow * SPEED_HZ * t)))
    assert taken < 0.3 * 0.001


def test_too_few_orders_below_the_bandwidth_say_nothing() -> None:
    assert followed_angle(np.ones((1, 4000)), 4000.0, SPEED_HZ, orders=[60.0], slowest=1.0) is None
