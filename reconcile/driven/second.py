"""Does what is left follow the force? Then the machine is linear, and has more than one mass on one spring.

The frequency response from the force to what the model leaves, by averaged spectra, is fitted by a second resonance
beside the first, and both are held against a part that no fit saw.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray
from scipy import fft
from scipy.optimize import least_squares

from reconcile.driven.channels import FloatArray
from reconcile.driven.model import Model, Run, counted, errors
from reconcile.driven.noise import response

ComplexArray = NDArray[np.complex128]

LONGEST, SEGMENTS = 4096, 12
LEAST_FOLLOWS = 0.15
"""Share of the error that must follow the force: it was 0.02 at most on made sound recordings with noise, 0.05 on those
with a law of the motion, 0.3 and more on those with a second resonance."""
FARTHEST = 30.0
"""Logarithm of an angular frequency beyond which a fit that runs off is held."""
STARTS = 4
"""Strongest places of the response at which a second resonance is begun."""
APART = 0.05
"""Least distance of two places, over the frequency."""
START_DAMPING = 0.02
MOST_DAMPING = 0.25
"""Damping ratio from which a second resonance is no line of a mass on a spring: what it explains may be anything smooth
in frequency, as the force of a damper whose other end moves."""
DRIVES = 3e-3
"""Power of the force at a line, over its mean power within the band that holds most of it, from which the force drives
there: of a made drive with a noise of a tenth of its size beside its band it is 0.0016."""
MOST_OF_IT = 0.9


@dataclass(frozen=True, kw_only=True)
class Second:
    """A linear model of two resonances, and what it leaves of the motion; shares are of the error's power."""

    first_hz: float
    second_hz: float
    damping_ratio: float
    follows: float
    """Share of the error that follows the force linearly, on the part that was fitted."""
    share: float
    """Share of the error on the part held out that the second resonance explains."""
    before: FloatArray
    after: FloatArray
    """What is left of the part held out, (n - skip,)."""


def _followed(
    drive: FloatArray, error: FloatArray, step_s: float
) -> tuple[FloatArray, ComplexArray, FloatArray, float]:
    """Angular frequency, response and power of the force; share of the error that follows it."""
    n, rate = min(LONGEST, error.size // SEGMENTS * 2), 1.0 / step_s
    frequency, cross = scipy.signal.csd(drive, error, rate, nperseg=n)
    pushed, left = (scipy.signal.welch(x, rate, nperseg=n)[1] for x in (drive, error))
    coherence = np.abs(cross) ** 2 / np.maximum(pushed * left, 1e-300)
    count = 0.53 * (2.0 * error.size / n - 1.0)  # of segments half over one another under Hann's window
    free = np.clip((coherence * count - 1.0) / (count - 1.0), 0.0, 1.0)
    share = float(np.sum(free * left) / max(float(left.sum()), 1e-300))
    kept = slice(1, None)
    return 2.0 * math.pi * frequency[kept], (cross / np.maximum(pushed, 1e-300))[kept], pushed[kept], share


def driven_band(omega: FloatArray, pushed: FloatArray) -> tuple[float, float]:
    """Lowest and highest angular frequency at which the force drives: no resonance can be seen elsewhere."""
    total = np.cumsum(pushed) / max(float(pushed.sum()), 1e-300)
    beside = (1.0 - MOST_OF_IT) / 2.0
    held = (total >= beside) & (np.concatenate([[0.0], total[:-1]]) <= 1.0 - beside)
    there = omega[pushed >= DRIVES * float(pushed[held].mean())]
    return float(there[0]), float(there[-1])


def _both(x: FloatArray, omega: FloatArray, order: int) -> ComplexArray:
    """Response of two resonances: logarithm of angular frequency, damping ratio and gain of each."""
    total = np.zeros(omega.size, dtype=np.complex128)
    for own, ratio, gain in (x[:3], x[3:]):
        w = math.exp(min(max(float(own), -FARTHEST), FARTHEST))  # a fit may run off
        total = total + gain * w * w / (w * w - omega**2 + 2j * ratio * w * omega)
    return np.asarray((1j * omega) ** order * total)


def _starts(model: Model, omega: FloatArray, extra: ComplexArray, pushed: FloatArray) -> list[FloatArray]:
    own = math.sqrt(model.stiffness)
    first = [math.log(own), model.damping / (2.0 * own), model.gain / model.stiffness]
    found: list[FloatArray] = []
    for k in np.argsort(-(np.abs(extra) ** 2) * pushed):
        w = float(omega[k])
        if all(abs(w / math.exp(float(s[3])) - 1.0) > APART for s in found):
            found.append(np.array([*first, math.log(w), START_DAMPING, 0.1 * first[2]]))
        if len(found) == STARTS:
            break
    return found


def followed(drive: FloatArray, error: FloatArray, step_s: float) -> float:
    """Share of an error's power that follows the force linearly."""
    return _followed(drive, error, step_s)[3]


def second(model: Model, run: Run, held: Run) -> Second | None:
    """The second resonance that explains most of what the linear model leaves; None where that follows no force."""
    error, order, step = errors(model, run), run.data.order, run.data.step_s
    omega, extra, pushed, follows = _followed(run.data.drive[run.skip :], error, step)
    if follows < LEAST_FOLLOWS:
        return None
    total = extra + response(model, omega, order)
    weight = np.sqrt(pushed)
    scale = float(np.sqrt(np.sum(np.abs(total * weight) ** 2)))

    def residual(x: FloatArray) -> FloatArray:
        off = (_both(x, omega, order) - total) * weight / scale
        return np.concatenate([off.real, off.imag])

    best = min(
        (least_squares(residual, s, x_scale="jac", max_nfev=200) for s in _starts(model, omega, extra, pushed)),
        key=lambda found: float(found.cost),
    ).x
    best = _polished(best, run)
    parts = sorted((best[:3], best[3:]), key=lambda p: abs(math.exp(float(p[0])) - math.sqrt(model.stiffness)))
    (first, _, _), (further, ratio, _) = parts
    if abs(float(first - further)) < APART or abs(float(ratio)) > MOST_DAMPING:
        return None
    low, high = driven_band(omega, pushed)
    if not low <= math.exp(float(further)) <= high:
        return None
    before = errors(model, held)
    after = _left(best, held)
    return Second(
        first_hz=math.exp(float(parts[0][0])) / (2.0 * math.pi),
        second_hz=math.exp(float(parts[1][0])) / (2.0 * math.pi),
        damping_ratio=abs(float(parts[1][1])),
        follows=follows,
        share=1.0 - float(after @ after) / max(float(before @ before), 1e-300),
        before=before,
        after=after,
    )


def _polished(x: FloatArray, run: Run) -> FloatArray:
    """By the motion itself: averaged spectra blur what is narrow."""

    def residual(at: FloatArray) -> FloatArray:
        return np.asarray(_left(at, run) / run.spread)

    found = least_squares(residual, x, x_scale="jac", max_nfev=30)
    return np.asarray(found.x)


def _left(x: FloatArray, held: Run) -> FloatArray:
    """What two resonances leave of a part, its mean apart."""
    n = held.data.answer.size
    omega = np.asarray(2.0 * np.pi * np.fft.rfftfreq(2 * n, held.data.step_s), dtype=np.float64)
    drive = held.data.drive - held.data.drive.mean()
    found = fft.irfft(fft.rfft(drive, 2 * n) * _both(x, omega, held.data.order), 2 * n)[:n]
    left = (held.data.answer - found)[held.skip :]
    return counted(np.asarray(left - left.mean()), held)
