"""Scalar features of a series, and the amplitudes of chosen lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from signals.peaks import refine
from signals.series import Series
from signals.spectra.types import Spectrum
from sim.core.errors import UnknownName


@dataclass(frozen=True, kw_only=True)
class Features:
    """Time-domain features. `mean`, `rms`, `standard_deviation`, `peak`, `peak_to_peak` are in `unit`.

    `rms` includes the mean. `peak` is the largest |x - mean| and `crest_factor` peak over standard deviation,
    so that a static deflection does not hide impacts. `kurtosis` is Pearson's (3 for a Gaussian, 1.5 for a
    sine); it, `skewness` and `crest_factor` are dimensionless and None for a signal that does not move.
    """

    unit: str
    mean: float
    rms: float
    standard_deviation: float
    peak: float
    peak_to_peak: float
    kurtosis: float | None
    skewness: float | None
    crest_factor: float | None


@dataclass(frozen=True, kw_only=True)
class LineAmplitude:
    """Amplitude at a multiple of a base frequency; `scaling` peak or RMS as the spectrum."""

    label: str
    frequency_hz: float
    amplitude: float
    unit: str
    scaling: str


def features(series: Series) -> Features:
    """Features of the whole series."""
    x = series.samples
    mean = float(np.mean(x))
    y = x - mean
    deviation = float(np.sqrt(np.mean(y**2)))
    # Rounding of a constant leaves a deviation of about 1e-16 of its level; that is not motion.
    moving = deviation > 1e-14 * max(float(np.max(np.abs(x))), 1e-300)
    peak = float(np.max(np.abs(y)))
    z = y / deviation if moving else y
    square = z**2  # products below: a power of three or four costs fifty times as much
    return Features(
        unit=series.unit,
        mean=mean,
        rms=float(np.sqrt(np.mean(x**2))),
        standard_deviation=deviation,
        peak=peak,
        peak_to_peak=float(np.max(x) - np.min(x)),
        kurtosis=float(np.mean(square * square)) if moving else None,
        skewness=float(np.mean(square * z)) if moving else None,
        crest_factor=peak / deviation if moving else None,
    )


def line_amplitudes(
    spectrum: Spectrum, bases_hz: Mapping[str, float], base: str, multiples: Sequence[int], *, tolerance_hz: float = 0.0
) -> tuple[LineAmplitude, ...]:
    """Amplitudes at `multiples` of a base (`f_m`, `f_o1`): the largest bin within `tolerance_hz` plus one bin,
    interpolated between bins. Multiples beyond the spectrum are left out.
    """
    if base not in bases_hz:
        raise UnknownName("base frequency", base, tuple(bases_hz))
    spectrum.amplitude_factor("peak")  # refuses densities
    found = []
    for k in multiples:
        predicted = k * bases_hz[base]
        reach = tolerance_hz + spectrum.resolution_hz
        low = max(1, int(np.ceil((predicted - reach) / spectrum.resolution_hz)))
        high = int(np.floor((predicted + reach) / spectrum.resolution_hz))
        if high >= spectrum.values.size - 1 or high < low:
            continue
        index = low + int(np.argmax(spectrum.values[low : high + 1]))
        frequency, amplitude = refine(spectrum, np.array([index]))
        found.append(
            LineAmplitude(
                label=f"{k}*{base}",
                frequency_hz=float(frequency[0]),
                amplitude=float(amplitude[0]),
                unit=spectrum.unit,
                scaling=spectrum.scaling,
            )
        )
    return tuple(found)
