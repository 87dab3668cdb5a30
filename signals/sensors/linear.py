"""Linear stages as the analogue transfer functions they are: applied in the frequency domain, so nothing is warped."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import scipy
from numpy.typing import NDArray
from scipy import fft

from signals.series import FloatArray

ComplexArray = NDArray[np.complex128]
Transfer = Callable[[FloatArray], ComplexArray]
"""Complex gain at frequencies in Hz, shape (lines,)."""

SETTLED = 16.0
"""Time constants after which a tail is gone: e^-16 = 1e-7."""
MAX_SETTLE_S = 20.0
"""Longest tail that is followed; a resonance that rings longer is refused where it is specified."""


def settle_s(frequency_hz: float, damping_ratio: float) -> float:
    """Time in which the free vibration of a second-order system dies out, s."""
    slow = damping_ratio - math.sqrt(max(damping_ratio**2 - 1.0, 0.0))
    return SETTLED / (2.0 * math.pi * frequency_hz * slow)


def resonance(frequency_hz: FloatArray, natural_hz: float, damping_ratio: float) -> ComplexArray:
    """1 / (1 - r^2 + 2 i zeta r), r = f / f_n: deflection of a damped mass on a spring, of unit static gain."""
    r = frequency_hz / natural_hz
    return np.asarray(1.0 / (1.0 - r**2 + 2j * damping_ratio * r), dtype=np.complex128)


def butterworth(frequency_hz: FloatArray, cutoff_hz: float, order: int) -> ComplexArray:
    """Analogue Butterworth low-pass, |H|^2 = 1 / (1 + (f / f_c)^(2 n)).

    S. Butterworth, "On the theory of filter amplifiers", Experimental Wireless 7 (1930): poles evenly on a half circle.
    """
    s = 1j * frequency_hz / cutoff_hz
    gain = np.ones(s.shape, dtype=np.complex128)
    for k in range(order):
        pole = np.exp(1j * math.pi * (2 * k + order + 1) / (2 * order))
        gain *= -pole / (s - pole)
    return gain


def butterworth_settle_s(cutoff_hz: float, order: int) -> float:
    """Time in which the slowest pole of the filter dies out, s."""
    return SETTLED / (2.0 * math.pi * cutoff_hz * math.sin(math.pi / (2 * order)))


def filtered(
    samples: FloatArray, rate_hz: float, transfer: Transfer, settling_s: float, *, held: bool = False
) -> FloatArray:
    """`samples` (n,) through a causal transfer function, (n,).

    Before the first sample there was rest (zero), or with `held` the first value. Beyond the Nyquist frequency of
    `rate_hz` nothing exists here: what a filter does there is not part of the result.
    """
    before = float(samples[0]) if held else 0.0
    n = samples.size
    length = fft.next_fast_len(n + math.ceil(min(settling_s, MAX_SETTLE_S) * rate_hz) + 1, real=True)
    lines = fft.rfft(samples - before, length) * transfer(fft.rfftfreq(length, 1.0 / rate_hz))
    static = float(transfer(np.zeros(1))[0].real) if held else 0.0
    result: FloatArray = fft.irfft(lines, length)[:n] + before * static
    return result


def high_pass(samples: FloatArray, rate_hz: float, corner_hz: float, order: int) -> FloatArray:
    """Butterworth high-pass of order 1 or 2 from rest, (n,): a charge amplifier or the coupling of a supply.

    Bilinear transform with its corner at `corner_hz` exactly; such corners lie so far below the sampling rate that
    the rest of the curve is the analogue one within (pi f / rate)^2 / 3. Its memory of seconds costs no padding.
    """
    warped = 2.0 * rate_hz * math.tan(math.pi * corner_hz / rate_hz)
    numerator, denominator = scipy.signal.bilinear(
        *scipy.signal.butter(order, warped, btype="highpass", analog=True), fs=rate_hz
    )
    result: FloatArray = scipy.signal.lfilter(numerator, denominator, samples)
    return result
