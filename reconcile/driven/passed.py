"""What a mass on a moved base passes on: the measured transfer between two motions, with a gain and a delay of its own.

Seen from the ground a mass on a spring follows slow motions of its base as they are, whatever its numbers. So two
sensors of such a pair calibrate each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.optimize import least_squares

from reconcile.driven.channels import Driven, FloatArray

ComplexArray = NDArray[np.complex128]

LONGEST, SEGMENTS, LEAST_SEGMENTS = 4096, 8, 4
COHERENT = 0.5
"""Least coherence of a line that counts."""
LEAST_LINES = 12
FLOOR = 0.01
"""Share of the transfer below which a line is not held to be known: windows blur what is narrow."""
PERIODS, A_PERIOD = 1.5, 16
"""Longest delay in natural periods, and delays that are tried in one."""
FILE_OFF, TOP = 4.0, 4.0
"""How much lower than the file's a natural frequency may be, and delays that are tried in a period of the top line."""
TRIED, MOST = 3, 1e4
"""Starts that are fitted, and what a line counts at most before."""
DAMPED = (1e-3, 3.0)
"""Range of the share of critical damping."""


@dataclass(frozen=True, kw_only=True)
class Transfer:
    """Lines of the response from one motion to the other, with what each may be off, over its size: angular frequency,
    response and scatter, (n,) each, and the time between samples."""

    omega: FloatArray
    ratio: ComplexArray
    off: FloatArray
    step_s: float


@dataclass(frozen=True, kw_only=True)
class Passed:
    """A transfer as a mass on a spring has it, times `gain`, late by `delay_s`; `left`: mean square of what it misses a
    line by, over what the line may be off."""

    gain: float
    delay_s: float
    stiffness: float
    damping: float
    left: float


def transfer(data: Driven) -> Transfer | None:
    """From the drive to the answer, by segments without spoiled samples; None where too little is coherent."""
    one, other = data.drive, data.answer
    n = min(LONGEST, one.size // SEGMENTS)
    bad = np.zeros(one.size, dtype=np.bool_)
    for part in (data.bad_drive, data.bad_answer):
        bad |= part if part is not None else False
    first = [i for i in range(0, one.size - n + 1, n // 2) if not np.any(bad[i : i + n])]
    if len(first) < LEAST_SEGMENTS:
        return None
    window = np.hanning(n)
    x, y = (np.stack([fft.rfft((v[i : i + n] - v[i : i + n].mean()) * window) for i in first]) for v in (one, other))
    cross = np.mean(np.conj(x) * y, axis=0)
    pushed, moved = (np.mean(np.abs(v) ** 2, axis=0) for v in (x, y))
    coherence = np.abs(cross) ** 2 / np.maximum(pushed * moved, 1e-300)
    kept = coherence > COHERENT
    kept[:2] = False
    kept[int(0.95 * kept.size) :] = False
    if int(kept.sum()) < LEAST_LINES:
        return None
    count = 0.53 * (len(first) + 1)
    off = np.sqrt((1.0 / coherence[kept] - 1.0) / (2.0 * count) + FLOOR**2)
    omega = 2.0 * math.pi * np.fft.rfftfreq(n, data.step_s)[kept]
    return Transfer(omega=omega, ratio=(cross / np.maximum(pushed, 1e-300))[kept], off=off, step_s=data.step_s)


def passed(seen: Transfer, own: float, *, gain: bool = False, delay: bool = False, ground: bool = False) -> Passed:
    """The best fit; `own`: a natural angular frequency to begin with. What is not free is a gain of 1, no delay, and no
    spring or damper from the mass to the ground."""
    starts = [s for late in _delays(seen, own, delay) for s in _starts(seen, own, late, gain)]
    free = np.array([True, True, gain, delay, ground, ground, ground])

    def residual(part: FloatArray, start: FloatArray) -> FloatArray:
        full = start.copy()
        full[free] = part
        return _missed(full, seen)

    best, least = starts[0], math.inf
    for start in sorted(starts, key=lambda x: float(np.sum(np.minimum(_missed(x, seen) ** 2, MOST))))[:TRIED]:
        found = least_squares(residual, start[free], args=(start,), x_scale="jac", max_nfev=60, loss="soft_l1")
        if found.cost < least:
            best, least = start.copy(), float(found.cost)
            best[free] = found.x
    w, ratio = _held(best)
    return Passed(
        gain=float(best[2]),
        delay_s=float(best[3]) * seen.step_s,
        stiffness=w * w,
        damping=2.0 * w * ratio,
        left=2.0 * least / seen.omega.size,
    )


def _held(x: FloatArray) -> tuple[float, float]:
    """Angular frequency and damping ratio: a fit may run off."""
    w, ratio = (math.exp(float(np.clip(v, -20.0, 20.0))) for v in x[:2])
    return w, ratio


def _missed(x: FloatArray, seen: Transfer) -> FloatArray:
    """(log angular frequency, log damping ratio, gain, delay in samples, spring and damper to the ground) -> what is
    missed of each line, over what it may be off."""
    omega = seen.omega
    w, ratio = _held(x)
    up = w * w * (1.0 + 1j * x[6]) + 2j * ratio * w * omega
    held = w * w * x[4] + 2j * x[5] * w * omega
    model = x[2] * np.exp(-1j * omega * x[3] * seen.step_s) * up / (up + held - omega**2)
    off = (seen.ratio - model) / (np.abs(seen.ratio) * seen.off)
    return np.concatenate([off.real, off.imag])


def _delays(seen: Transfer, own: float, delay: bool) -> FloatArray:
    """Delays to begin with, in samples."""
    if not delay:
        return np.zeros(1)
    peak = float(seen.omega[np.argmax(np.abs(seen.ratio))])  # a delay leaves it where it is
    longest = PERIODS / min(own, max(peak, own / FILE_OFF))
    count = math.ceil(longest * max(A_PERIOD * own, TOP * float(seen.omega[-1])))
    return np.asarray(2.0 * math.pi * longest / seen.step_s / count * np.arange(-count, count + 1), dtype=np.float64)


def _starts(seen: Transfer, own: float, late: float, gain: bool) -> list[FloatArray]:
    """The numbers at hand, and those that solve the lines' equations, weighted anew (Sanathanan & Koerner 1963)."""
    omega, ratio = seen.omega, seen.ratio * np.exp(1j * seen.omega * late * seen.step_s)
    found = [np.array([math.log(own), math.log(0.05), 1.0, late, 0.0, 0.0, 0.0])]
    weight = 1.0 / (np.abs(ratio) * seen.off)
    below = np.ones(omega.size)
    for _ in range(3):
        columns = [ratio, 1j * omega * ratio, -np.ones(omega.size), -1j * omega]
        if not gain:
            columns = [columns[0] + columns[2], columns[1] + columns[3]]
        a = np.stack(columns, axis=1) * (weight / below)[:, None]
        b = ratio * omega**2 * weight / below
        real, size = np.concatenate([a.real, a.imag]), np.linalg.norm(a, axis=0)
        x = np.linalg.lstsq(real / size, np.concatenate([b.real, b.imag]), rcond=None)[0] / size
        if x[0] <= 0.0:
            break
        w = math.sqrt(float(x[0]))
        damped = float(np.clip(0.5 * x[1] / w, *DAMPED))
        told = float(x[2] / x[0]) if gain else 1.0
        found.append(np.array([math.log(w), math.log(damped), told, late, 0.0, 0.0, 0.0]))
        below = np.abs(x[0] - omega**2 + 1j * omega * x[1])
    return found
