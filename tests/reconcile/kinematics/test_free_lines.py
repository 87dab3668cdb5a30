"""The black box is as good as its numbers allow: lines and humps that are there are found again, and it loses to a comb
only what a comb knows."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.kinematics.combs import MAIN_LOBE, PARAMETERS, Stretch, Train, comb_power, fitted, predicted, rescaled
from reconcile.kinematics.families import Family
from reconcile.kinematics.free_lines import black_boxes

ORDERS = np.linspace(0.25, 30.0, 900)
SLOPE = -0.08 * ORDERS


def made(lines: list[tuple[float, float, float]], seed: int = 0) -> Stretch:
    """Power of bins, heights and widths over a slope, with a little scatter."""
    power = np.exp(SLOPE)
    bins = np.arange(ORDERS.size)
    for place, height, width in lines:
        power = power + height * np.exp(-0.5 * ((bins - place) / width) ** 2)
    scatter = 0.02 * np.random.default_rng(seed).standard_normal(ORDERS.size)
    return Stretch(log_power=np.log(power) + scatter, orders=ORDERS)


def left(stretch: Stretch, model: np.ndarray) -> float:
    return float(np.sqrt(np.mean((model - stretch.log_power) ** 2)))


def test_three_lines_are_found_again() -> None:
    on = made([(100, 40.0, MAIN_LOBE), (340, 25.0, MAIN_LOBE), (700, 9.0, MAIN_LOBE)])
    lines, _ = black_boxes(on, np.zeros(ORDERS.size))
    assert left(on, lines) < 0.03 < left(on, rescaled(on, np.zeros(ORDERS.size))[0])


@pytest.mark.parametrize("width", [12.0, 40.0])
def test_two_humps_are_found_again(width: float) -> None:
    on = made([(200, 30.0, width), (600, 12.0, 2 * width)])
    lines, humps = black_boxes(on, np.zeros(ORDERS.size))
    assert left(on, humps) < 0.03 < left(on, lines)


def test_no_line_is_no_gain() -> None:
    on, other = made([], 1), made([], 2)
    for box in black_boxes(on, SLOPE):
        assert left(other, box) < 1.1 * left(other, rescaled(on, SLOPE)[0])


def test_a_comb_of_more_lines_than_numbers_is_beyond_it() -> None:
    family = Family(kind="outer", site="b", order=3.585, spacing=0.0, sidebands=0, slip=0.0)
    bins = [(k * 3.585 - 0.25) / (ORDERS[1] - ORDERS[0]) for k in range(1, 9)]
    on = made([(place, 30.0 / (k + 1), MAIN_LOBE) for k, place in enumerate(bins)])
    train = Train(family=family, order=3.585)
    before = np.asarray(SLOPE)
    comb = predicted(train, on, before, fitted(train, on, before))
    assert len(bins) > PARAMETERS // 2
    assert left(on, comb) < 0.5 * min(left(on, box) for box in black_boxes(on, before))


def test_the_comb_has_the_spectrum_of_uneven_impulses_at_a_turning_load() -> None:
    """Against a made train: harmonics alike, sidebands of the turn around each, the turn itself as high as one of
    them, and what is uneven from one impulse to the next a floor of var / T at all orders."""
    rng = np.random.default_rng(4)
    per_turn, every, turns, segments, depth, uneven = 100, 20, 40, 60, 0.8, 0.5
    size = per_turn * turns
    t = np.arange(size)
    power = np.zeros(size // 2 + 1)
    for _ in range(segments):
        strength = (1 + depth * np.cos(2 * np.pi * t / per_turn)) * (1 + uneven * rng.standard_normal(size))
        power += np.abs(np.fft.rfft(np.where(t % every == 0, strength, 0.0))) ** 2 / segments
    orders = np.arange(power.size) / turns
    rate = per_turn // every
    family = Family(kind="inner", site="b", order=float(rate), spacing=1.0, sidebands=1, slip=0.0)
    line = (size / every) ** 2
    ratio, floor = (depth / 2) ** 2, size / every * uneven**2 * (1 + depth**2 / 2)
    keep = (orders >= 0.5) & (orders <= 4 * rate + 2)
    on = Stretch(log_power=np.log(power[keep]), orders=orders[keep])
    area = MAIN_LOBE * np.sqrt(2 * np.pi)
    shape = [np.log(line * MAIN_LOBE / area), 0.0, np.log(ratio), -4.0, 0.0, 0.0, np.log(floor)]
    made = comb_power(Train(family=family, order=float(rate)), on, np.array(shape))
    for order in (1.0, rate - 1.0, float(rate), rate + 1.0, 3.0 * rate):
        near = np.abs(on.orders - order) < 0.2
        assert np.sum(made[near]) == pytest.approx(np.sum(power[keep][near]), rel=0.2), order
    away = np.min(
        np.abs(on.orders[:, None] - np.array([1, *(k * rate + m for k in range(1, 5) for m in (-1, 0, 1))])), 1
    )
    assert np.median(made[away > 0.4]) == pytest.approx(float(np.mean(power[keep][away > 0.4])), rel=0.1)
