"""Compiled loops of the speed give what the same arrays give, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.compiled.speeds import narrow_lines, read_at
from reconcile.speed.estimate import comb_score
from reconcile.speed.run_up import BESIDE, BLOCK, NARROW, STRONG


def narrow_by_arrays(power: np.ndarray, left_out: np.ndarray) -> int:
    blocks = power.size // BLOCK
    middle = np.median(power[: blocks * BLOCK].reshape(blocks, BLOCK), axis=1)
    strong = np.nonzero(power > STRONG * middle[np.minimum(np.arange(power.size) // BLOCK, blocks - 1)])[0]
    strong = strong[~left_out[strong]]
    near = power.take(strong[:, None] + np.arange(-NARROW, NARROW + 1), mode="clip")
    line = (power[strong] == near.max(axis=1)) & (power[strong] > BESIDE * np.maximum(near[:, 0], near[:, -1]))
    return int(np.count_nonzero(line & (strong >= 2 * NARROW) & (strong < power.size - NARROW)))


@pytest.mark.parametrize("size", [64, 65, 127, 128, 1000])
@pytest.mark.parametrize("kind", ["noise", "lines", "few", "flat", "nothing"])
def test_narrow_lines_are_counted_as_by_arrays(kind: str, size: int) -> None:
    rng, seen = np.random.default_rng(size), 0
    for _ in range(20):
        power = {"flat": np.ones(size), "nothing": np.zeros(size)}.get(kind, rng.exponential(size=size))
        if kind in ("lines", "few"):
            places = rng.integers(0, size, size // (9 if kind == "lines" else 40) + 1)
            power[places] *= 10.0 ** rng.uniform(0, 4, places.size)
            power[min(rng.integers(7, size - 3), size - 4)] = 1e3
        left_out = rng.random(size) < 0.2
        count = narrow_lines(power, left_out, BLOCK, STRONG, NARROW, BESIDE)
        assert count == narrow_by_arrays(power, left_out)
        seen += count
    assert (seen > 0) == (kind in ("lines", "few"))


@pytest.mark.parametrize("change", [-1.2, -0.3, 0.0, 0.7, 1.2])
@pytest.mark.parametrize("size", [2, 3, 700])
def test_samples_are_read_between_others_as_interpolated(size: int, change: float) -> None:
    rng = np.random.default_rng(size)
    parts, window, time = rng.normal(size=(3, size)), rng.random(size), np.arange(size) / 800.0
    given = time + change / 2 * (time**2 / (size / 800.0) - time)
    for shift in (0.0, 0.3 / 800.0, -2.0 / 800.0, 2.0):
        read = np.empty_like(parts)
        read_at(parts, time, given + shift, window, read)
        np.testing.assert_array_equal(read, [np.interp(time, given + shift, part) * window for part in parts])


@pytest.mark.parametrize("count", [0, 1, 300])
def test_a_comb_counts_nothing_beyond_the_spectrum(count: int) -> None:
    rng = np.random.default_rng(count)
    log, speeds, orders = rng.random(90), rng.uniform(0.0, 30.0, count), (1, 2.5, 3, 7)
    padded, total = np.append(log, np.zeros(1000)), np.zeros(count)
    for order in orders:
        total += padded[np.rint(order * speeds / 0.5).astype(np.int64)] / np.sqrt(order)
    np.testing.assert_array_equal(comb_score(log, 0.5, speeds, orders), total)
