"""How large is the noise, told by something else than the error that it is to account for?

Noise on the motion stands beyond the band in which the model answers at all too; noise on the force stands between
and beyond the lines that drive, and comes through the oscillator; and a baseline shows what its own model leaves.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft

from reconcile.driven.channels import FloatArray
from reconcile.driven.measured import Look
from reconcile.driven.model import Model, Run, simulated

SMOOTHING = 33
"""Lines over which spectra are averaged."""
QUIET, LEAST_QUIET = 1e-3, 0.1
"""Power of the model's answer over its strongest below which a line is beyond the band; the share of lines there must
be, else the quietest count."""
FLOOR_QUANTILE, FLOOR_SHARE, EVEN = 0.1, 0.1, 2.0
"""Of the force's lines, those that are its noise; over the mean line above which they are its drive; and half of all
lines must be as even as this: a drive that fades with frequency has no floor."""
SPREADS = 2.0
"""Standard deviations by which the power of noise through the oscillator may exceed its mean: of a narrow resonance few
draws make it (its noise bandwidth, a quarter of the damping rate, times the duration)."""
BESIDE = 16
"""Part of the band from which the noise on either side of a line is taken."""
MEDIAN = 0.69
"""Of lines of noise, over their mean."""
HIGHEST = 0.9
"""Share of the band up to half the sampling rate that is looked at: filters against aliases begin there."""


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Shares of the output's standard deviation: what the model leaves, and what noise accounts for."""

    left: float
    motion: float
    """Noise on the motion."""
    force: float
    """Noise on the force, through the oscillator, at most."""
    baseline: float | None
    """What is left of the baselines by their own models, at most; None: there are none that a linear model fits."""

    @property
    def known(self) -> float:
        """The noise there is by all that tells of it."""
        return max(math.hypot(self.motion, self.force), self.baseline or 0.0)

    @property
    def beyond(self) -> float:
        """Share of the error's power that no noise accounts for."""
        return max(1.0 - (self.known / self.left) ** 2, 0.0) if self.left > 0.0 else 0.0

    @property
    def unexplained(self) -> float:
        """The same as a share of the output."""
        return self.left * math.sqrt(self.beyond)


def power_lines(values: FloatArray) -> FloatArray:
    """Mean square by line, (n // 2 + 1,), under a Hann window: its sum is that of the values."""
    window = np.hanning(values.size)
    found = np.abs(fft.rfft((values - values.mean()) * window)) ** 2
    return np.asarray(found * (2.0 / (values.size * float(np.sum(window**2)))))


def smoothed(power: FloatArray) -> FloatArray:
    """Mean over `SMOOTHING` lines."""
    half = SMOOTHING // 2
    return np.convolve(np.pad(power, half, mode="edge"), np.ones(SMOOTHING) / SMOOTHING, mode="valid")


def response(model: Model, omega: FloatArray, order: int) -> NDArray[np.complex128]:
    """Motion over force of the linear part, (n,)."""
    below = model.stiffness - omega**2 + 1j * omega * model.damping
    return np.asarray(model.gain * (1j * omega) ** order / below)


def _floor_of_force(drive: FloatArray) -> float:
    """Mean square a line of a noise on the force; 0 where it cannot be told from what drives."""
    power = smoothed(power_lines(drive))
    floor, middle = np.quantile(power, (FLOOR_QUANTILE, 0.5))
    if floor > FLOOR_SHARE * power.mean() or middle > EVEN * floor:
        return 0.0
    return float(np.mean(power[power < EVEN * floor]))


def _noise_of_motion(error: FloatArray, answered: FloatArray) -> float:
    """Mean square of the error that goes on beyond the band of the answer: there as it is, within it as beside it."""
    left, answer = power_lines(error), smoothed(power_lines(answered))
    quiet = answer < QUIET * float(answer.max())
    looked = np.arange(left.size) < HIGHEST * left.size
    if np.mean(quiet & looked) < LEAST_QUIET:
        quiet = answer <= np.quantile(answer[looked], LEAST_QUIET)
    half = max(left.size // BESIDE, SMOOTHING)
    there = np.asarray(quiet & looked, dtype=np.float64)
    counted, total = _sums(there, half), _sums(np.asarray(left * there), half)
    place, seen = np.arange(left.size), counted >= SMOOTHING // 2
    if not np.any(seen):
        return float(np.median(left[quiet]) / MEDIAN * left.size)
    beside = np.interp(place, place[seen], total[seen] / counted[seen])
    return float(np.sum(np.where(quiet, left, beside)))


def _sums(values: FloatArray, half: int) -> FloatArray:
    """Sums over lines at most `half` away."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    place = np.arange(values.size)
    return np.asarray(total[np.minimum(place + half + 1, values.size)] - total[np.maximum(place - half, 0)])


def noise_of(model: Model, run: Run, error: FloatArray, baselines: Sequence[Look] = ()) -> Noise:
    """Of a stretch and what a model leaves of it, (n - skip,)."""
    spread = float(run.compared.std()) or 1.0
    drive, answered = run.data.drive[run.skip :], simulated(model, run)[run.skip :]
    omega = np.asarray(2.0 * np.pi * np.fft.rfftfreq(drive.size, run.data.step_s), dtype=np.float64)
    through = float(np.sum(np.abs(response(model, omega[1:], run.data.order)) ** 2))
    scatter = SPREADS / math.sqrt(max(model.damping / 4.0 * drive.size * run.data.step_s, 1.0))
    force = math.sqrt(_floor_of_force(drive) * through * (1.0 + scatter))
    motion = math.sqrt(_noise_of_motion(error, answered))
    rested = [max(b.left, b.left * float(b.data.answer.std()) / spread) for b in baselines if b.left < 1.0]
    return Noise(
        left=float(np.sqrt(np.mean(error**2))) / spread,
        motion=motion / spread,
        force=force / spread,
        baseline=max(rested, default=None),
    )
