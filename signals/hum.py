"""Mains hum: lines of the electric supply, which no mechanism of the machine explains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from signals.floor import FloorSettings, noise_floor
from signals.peaks import find_peaks
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum

MAINS_HZ = (50.0, 60.0)
HARMONICS = (1, 2, 3, 5)
"""Supply lines that dominate: the fundamental, the magnetic pull at twice, and odd harmonics of the current."""
TOLERANCE = 0.002
"""Supply grids keep within 0.2 Hz of 50 Hz in normal operation (EN 50160:2010, 4.2.1: +-1 % for 99.5 % of a year)."""


@dataclass(frozen=True, kw_only=True)
class Hum:
    """A line at a multiple of the mains frequency that is not at an expected frequency."""

    channel: str
    mains_hz: float
    harmonic: int
    frequency_hz: float
    amplitude_peak: float
    unit: str
    db_over_floor: float


def find_hum(series: Series, expected_hz: Sequence[float] = ()) -> tuple[Hum, ...]:
    """Lines at multiples of 50 or 60 Hz, but for those within two bins of `expected_hz` (shaft harmonics ...)."""
    spectrum = amplitude_spectrum(series)
    found = find_peaks(spectrum, noise_floor(spectrum, FloorSettings()))
    expected = np.asarray(expected_hz, dtype=np.float64)
    foreign = [
        i for i, hz in enumerate(found.frequency_hz) if np.all(np.abs(expected - hz) > 2 * spectrum.resolution_hz)
    ]
    return tuple(
        Hum(
            channel=series.name,
            mains_hz=mains,
            harmonic=harmonic,
            frequency_hz=float(found.frequency_hz[i]),
            amplitude_peak=float(found.amplitude[i]),
            unit=series.unit,
            db_over_floor=float(found.db_over_floor[i]),
        )
        for mains in MAINS_HZ
        for harmonic in HARMONICS
        for i in foreign
        if abs(found.frequency_hz[i] - mains * harmonic) <= TOLERANCE * mains * harmonic + spectrum.resolution_hz
    )
