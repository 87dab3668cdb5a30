"""Levels of a vibration in fixed bands: octaves, and the velocity that standards of severity are written for."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from signals.series import FloatArray, Series
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.types import Spectrum

OCTAVES: Mapping[str, float] = {
    name: 1000.0 * 10 ** (0.3 * k)
    for k, name in enumerate(
        ("16", "31.5", "63", "125", "250", "500", "1000", "2000", "4000", "8000", "16000", "31500"), start=-6
    )
}
"""Nominal and exact mid-band frequencies, Hz: base ten of IEC 61260-1:2014, section 5.2; edges 10**0.15 beside them."""
EDGE = 10**0.15
TOP_SHARE = 0.9
"""Of half the sampling rate: above it anti-alias filters fall off."""
LEAST_BINS = 8
VELOCITY_HZ = (10.0, 1000.0)
"""Of the velocity of ISO 20816-1:2016 and ISO 10816-3:2009 for machines above 600 rpm."""
VELOCITY_LEAST_S = 1.0


def octave_levels(series: Series) -> dict[str, float]:
    """RMS in each octave that lies within the axis and is resolved by 8 bins, by nominal mid-band frequency.

    In the unit of the series. From one Hann-windowed transform of the whole series; its lines' power adds up to the
    mean square (the window's noise bandwidth is divided out), so a sine reads amplitude over sqrt(2).
    """
    spectrum = amplitude_spectrum(series, amplitude="rms")
    found = {}
    for name, middle in OCTAVES.items():
        low, high = middle / EDGE, middle * EDGE
        if high > TOP_SHARE * series.sampling_rate_hz / 2 or high - low < LEAST_BINS * spectrum.resolution_hz:
            continue
        found[name] = _rms(spectrum, low, high)
    return found


def velocity_rms(series: Series) -> float | None:
    """RMS velocity from 10 Hz to 1 kHz, m/s, of a velocity or an acceleration (divided by 2 pi f line by line).

    None for other quantities, for less than a second, and where half the sampling rate does not reach the band.
    """
    integrated = {"m/s": 0, "m/s^2": 1}.get(series.unit)
    reaches = TOP_SHARE * series.sampling_rate_hz / 2 >= VELOCITY_HZ[1] and series.duration_s >= VELOCITY_LEAST_S
    if integrated is None or not reaches:
        return None
    spectrum = amplitude_spectrum(series, amplitude="rms")
    frequency = np.maximum(spectrum.frequency_hz, spectrum.resolution_hz)
    return _rms(spectrum, *VELOCITY_HZ, weight=(2 * np.pi * frequency) ** -float(integrated))


def _rms(spectrum: Spectrum, low_hz: float, high_hz: float, weight: FloatArray | float = 1.0) -> float:
    """Root of the power of the lines from `low_hz` up to `high_hz`."""
    inside = (spectrum.frequency_hz >= low_hz) & (spectrum.frequency_hz < high_hz)
    power = float(np.sum((spectrum.values * weight)[inside] ** 2))
    return float(np.sqrt(power * spectrum.resolution_hz / spectrum.noise_bandwidth_hz))
