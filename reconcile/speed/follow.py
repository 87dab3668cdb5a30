"""Slow wander of a shaft's speed from lines it surely makes, all channels and orders together.

The angle is that of a constant speed plus a sum of few slow functions. Along the right angle every line is one number
and the rest of its band is noise: the likelihood of K lines with unknown amplitudes and noise is -sum log(1 - captured
share of the band's energy), maximised over the slow functions, first with the lowest orders, whose phase wanders least
(the idea of phase demodulation in F. Bonnardot et al., Mech. Syst. Signal Process. 19 (2005)
766-785, with maximum likelihood instead of a phase to unwrap).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import fft
from scipy.optimize import minimize

from signals.series import ComplexArray, FloatArray

ALL_LINES = 10
"""Orders used at most."""
FIRST_ORDERS = (1, 2, 4)
"""So many of the lowest orders in the first rounds; then all."""
SLOWEST_SHARE = 0.85
"""Wander is followed up to this share of the slowest shaft's speed: what a turn of a shaft does stays in the signal."""
FASTEST_HZ = 8.0
HALF_WIDTH_HZ = 12.0
SPEED_SHARE = 0.012
"""Half the band of a line beside `HALF_WIDTH_HZ`, as a share of its frequency."""
MIN_GAIN = 0.15
"""Mean gain of log likelihood per line, on lines left out, from which the angle is taken."""
MOST_FUNCTIONS = 400
STARTS = 4


@dataclass(frozen=True, kw_only=True)
class Lines:
    """Bands around lines moved to 0 Hz: `values` (lines, n), their orders (lines,) and the functions (m, n)."""

    values: ComplexArray
    orders: FloatArray
    functions: FloatArray

    @cached_property
    def energies(self) -> FloatArray:
        """Mean square of each, (lines,)."""
        return np.asarray(np.mean(np.abs(self.values) ** 2, axis=1))

    @cached_property
    def distinct(self) -> tuple[FloatArray, np.ndarray]:
        """The orders without repetition, and which of them each line has: channels share the turning of an order."""
        found, place = np.unique(self.orders, return_inverse=True)
        return found, place

    def part(self, rows: np.ndarray) -> Lines:
        """Some of the lines."""
        return Lines(values=self.values[rows], orders=self.orders[rows], functions=self.functions)


def followed_angle(
    samples: FloatArray, rate_hz: float, speed_hz: float, *, orders: Sequence[float], slowest: float
) -> FloatArray | None:
    """Angle (n,) of the shaft, rad, from `samples` (C, n); None where lines left out do not gain by it.

    `orders`: cycles a revolution, the strongest families' lowest first. `slowest`: turns of the slowest shaft a turn.
    """
    n = samples.shape[1]
    seconds = n / rate_hz
    top_hz = min(SLOWEST_SHARE * slowest * speed_hz, FASTEST_HZ)
    count = int(2.0 * top_hz * seconds) + 1
    usable = [k for k in orders if k * speed_hz * 1.02 + HALF_WIDTH_HZ < 0.42 * rate_hz][:ALL_LINES]
    if len(usable) < 2 or not 1 <= count <= MOST_FUNCTIONS:
        return None
    lines = _bands(samples, rate_hz, speed_hz, usable, count)
    ranks = np.searchsorted(np.array(sorted(usable)), lines.orders)
    even, odd = np.flatnonzero(ranks % 2 == 0), np.flatnonzero(ranks % 2 == 1)
    if not any(_gain(lines.part(used), lines.part(held)) >= MIN_GAIN for used, held in ((even, odd), (odd, even))):
        return None
    wander = _fitted(lines) @ _functions(n, count)
    return np.asarray(2.0 * np.pi * speed_hz * np.arange(n) / rate_hz + wander)


def _gain(used: Lines, held: Lines) -> float:
    """Mean gain of log likelihood of the `held` lines by the angle that others give."""
    coefficients = _fitted(used)
    return float(np.mean(_likelihoods(held, coefficients) - _likelihoods(held, np.zeros(coefficients.size))))


def _functions(n: int, count: int) -> FloatArray:
    """Integrals of a speed made of half cosines over the record, the constant first, (count, n)."""
    x = (np.arange(n) + 0.5) / n
    return np.array([(x - 0.5) if j == 0 else np.sin(np.pi * j * x) / (np.pi * j) for j in range(count)])


def _bands(samples: FloatArray, rate_hz: float, speed_hz: float, orders: Sequence[float], count: int) -> Lines:
    """All bands at a common low rate."""
    n = samples.shape[1]
    bin_hz = rate_hz / n
    spectrum = fft.rfft(samples - samples.mean(axis=1, keepdims=True), axis=1)
    half = [int((HALF_WIDTH_HZ + SPEED_SHARE * k * speed_hz) / bin_hz) for k in orders]
    points = fft.next_fast_len(2 * max(half) + 2)
    t = np.arange(points) * (n / points) / rate_hz
    rows, which = [], []
    for k, reach in zip(orders, half, strict=True):
        middle = round(k * speed_hz / bin_hz)
        kept = np.zeros((samples.shape[0], points), dtype=complex)
        take = np.arange(-reach, reach + 1)
        kept[:, take % points] = spectrum[:, np.clip(middle + take, 0, spectrum.shape[1] - 1)]
        off = middle * bin_hz - k * speed_hz
        rows.append(fft.ifft(kept, axis=1) * np.exp(2j * np.pi * off * t))
        which += [k] * samples.shape[0]
    return Lines(values=np.concatenate(rows), orders=np.array(which), functions=_functions(points, count))


def _captured(lines: Lines, coefficients: FloatArray) -> tuple[ComplexArray, FloatArray, ComplexArray]:
    """Lines along the angle (K, n), their energies (K,) and amplitudes (K,)."""
    orders, place = lines.distinct
    phase = orders[:, None] * (coefficients @ lines.functions)
    turn = np.empty(phase.shape, dtype=complex)
    np.cos(phase, out=turn.real)
    np.sin(-phase, out=turn.imag)
    turned = lines.values * turn[place]
    return turned, lines.energies, turned.sum(axis=1) / turned.shape[1]


def _likelihoods(lines: Lines, coefficients: FloatArray) -> FloatArray:
    """-log of the share of each band's energy that is not the line."""
    _, energy, amplitude = _captured(lines, coefficients)
    return np.asarray(-np.log(np.maximum(1.0 - np.abs(amplitude) ** 2 / np.maximum(energy, 1e-300), 1e-9)))


def _cost(coefficients: FloatArray, lines: Lines) -> tuple[float, FloatArray]:
    turned, energy, amplitude = _captured(lines, coefficients)
    rest = np.maximum(energy - np.abs(amplitude) ** 2, 1e-9 * energy + 1e-300)
    # d|a|^2/dc_j = 2 Re(conj(a) mean(-i k f_j turned)) = 2 k mean(f_j Im(conj(a) turned))
    slope = ((np.conj(amplitude) * lines.orders / rest) @ turned).imag
    gradient = -2.0 * (lines.functions @ slope) / turned.shape[1]
    return float(np.log(rest).sum()), gradient


def _climbed(lines: Lines, start: FloatArray, free: int) -> FloatArray:
    """Local maximum over the first `free` functions."""
    few = Lines(values=lines.values, orders=lines.orders, functions=lines.functions[:free])
    # of one size each, however fast it changes: then a quarter of the steps is enough
    scale = 1.0 / (float(lines.orders.max()) * few.functions.std(axis=1))

    def cost(scaled: FloatArray) -> tuple[float, FloatArray]:
        value, gradient = _cost(scaled * scale, few)
        return value, gradient * scale

    found = minimize(cost, start[:free] / scale, jac=True, method="L-BFGS-B", options={"maxiter": 60})
    return np.concatenate([found.x * scale, start[free:]])


def _starts(lines: Lines) -> list[FloatArray]:
    """No wander, and the unwrapped phases of the clearest of the lowest lines."""
    count = lines.functions.shape[0]
    lowest = np.flatnonzero(lines.orders <= np.unique(lines.orders)[:2].max())
    size = np.abs(lines.values[lowest])
    steadiness = size.std(axis=1) / np.maximum(size.mean(axis=1), 1e-300)
    found = [np.zeros(count)]
    for row in lowest[np.argsort(steadiness)[: STARTS - 1]]:
        phase = np.unwrap(np.angle(lines.values[row])) / lines.orders[row]
        basis = np.concatenate([np.ones((1, phase.size)), lines.functions])
        weight = np.abs(lines.values[row])
        found.append(np.linalg.lstsq((basis * weight).T, phase * weight, rcond=None)[0][1:])
    return found


def _fitted(lines: Lines) -> FloatArray:
    """The best of several starts, each with more and more lines and functions."""
    count = lines.functions.shape[0]
    distinct = np.unique(lines.orders)
    best, chosen = np.inf, np.zeros(count)
    for start in _starts(lines):
        now = start
        for many in FIRST_ORDERS:
            few = lines.part(np.flatnonzero(lines.orders <= distinct[min(many, distinct.size) - 1]))
            free = min(count, 4) if many == 1 and not start.any() else count
            now = _climbed(few, now, free)
        now = _climbed(lines, now, count)
        value, _ = _cost(now, lines)
        if value < best:
            best, chosen = value, now
    return chosen
