"""Liftering: a filter on the log spectrum. The edited amplitude keeps the signal's own phase: a signal comes back.

R. B. Randall and N. Sawalhi, "A new method for separating discrete components from a signal", Sound and Vibration 45
(2011) 6-9 (cepstrum editing procedure); the long-pass and short-pass lifters are those of Bogert et al. (1963).
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
from scipy import fft

from signals.cepstrum.cepstrum import log_amplitude
from signals.series import BoolArray, FloatArray, Series
from sim.core.errors import Problem, SpecError

LifterKind = Literal["short", "long"]


def lifter(series: Series, *, keep: LifterKind, cut_s: float) -> Series:
    """The signal with only the quefrencies below (`short`) or above (`long`) `cut_s`.

    Short keeps the smooth course of the spectrum: transfer paths and resonances. Long keeps its families of lines, on a
    levelled spectrum. Quefrency 0, the level, is always kept.
    """
    quefrency = _quefrency(series)
    if not (np.isfinite(cut_s) and 0 < cut_s < quefrency.max()):
        allowed = f"above 0, below {quefrency.max():.6g}"
        problem = Problem(
            field="cut_s", message="is no quefrency of this signal", given=cut_s, allowed=allowed, unit="s"
        )
        raise SpecError(problem)
    kept = quefrency < cut_s if keep == "short" else quefrency >= cut_s
    return _edited(series, kept)


def remove_rahmonics(series: Series, *, spacing_hz: float, half_width_s: float | None = None) -> Series:
    """The signal without its family of lines `spacing_hz` apart: the notches lie at every rahmonic.

    `half_width_s` of a notch (default: 2 samples, at most a quarter of the period) allows for a speed that varies; wide
    notches take from single lines too, whose logarithm lies in all quefrencies.
    """
    quefrency = _quefrency(series)
    period = 1 / spacing_hz if spacing_hz > 0 else np.inf
    step = 1 / series.sampling_rate_hz
    if not 2 * step < period < quefrency.max():
        raise SpecError(
            Problem(
                field="spacing_hz",
                message="is no spacing of lines in this signal",
                given=spacing_hz,
                allowed=f"{1 / quefrency.max():.6g} to {series.sampling_rate_hz / 2:.6g}",
                unit="Hz",
            )
        )
    multiple = np.maximum(np.rint(quefrency / period), 1.0)
    width = 2 * step if half_width_s is None else half_width_s
    return _edited(series, np.abs(quefrency - multiple * period) > min(width, period / 4))


def _quefrency(series: Series) -> FloatArray:
    """Quefrency of each sample of the whole cepstrum, (n,), s; the second half mirrors the first."""
    n = series.samples.size
    index = np.arange(n)
    return np.asarray(np.minimum(index, n - index) / series.sampling_rate_hz, dtype=np.float64)


def _edited(series: Series, kept: BoolArray) -> Series:
    """Log amplitude with only the `kept` quefrencies, (n,), the phase as it was. The mean of the signal is kept."""
    n = series.samples.size
    mean = float(np.mean(series.samples))
    transform = fft.rfft(series.samples - mean)
    amplitude = np.abs(transform)
    real_cepstrum = fft.irfft(log_amplitude(amplitude), n=n)
    kept = kept.copy()
    kept[0] = True
    edited = np.exp(fft.rfft(np.where(kept, real_cepstrum, 0.0)).real)
    phase = np.where(amplitude > 0, transform / np.where(amplitude > 0, amplitude, 1.0), 0.0)
    phase[0] = 0.0
    return replace(series, samples=np.asarray(fft.irfft(edited * phase, n=n) + mean, dtype=np.float64))
