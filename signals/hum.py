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
"""Supply grids keep within 0.1 Hz of 50 Hz nearly always (EN 50160:2010, 4.2.1: +-1 % for 99.5 % of a year)."""
LEAST_HARMONICS = 2
"""Without its fundamental, hum is believed from so many lines of one mains frequency on: one alone is a coincidence."""


@dataclass(frozen=True, kw_only=True)
class Hum:
    """A line at a multiple of the mains frequency; `shared`: the machine may have one there too."""

    channel: str
    mains_hz: float
    harmonic: int
    frequency_hz: float
    amplitude_peak: float
    unit: str
    db_over_floor: float
    shared: bool = False


def find_hum(series: Series, expected_hz: Sequence[float] = ()) -> tuple[Hum, ...]:
    """Lines at multiples of 50 or 60 Hz, where they show a supply: its fundamental, or two of its harmonics.

    Lines within two bins of `expected_hz` (shaft harmonics ...) are no evidence; where the rest is, they are `shared`.
    """
    spectrum = amplitude_spectrum(series)
    found = find_peaks(spectrum, noise_floor(spectrum, FloorSettings()))
    expected = np.asarray(expected_hz, dtype=np.float64)
    result: list[Hum] = []
    for mains in MAINS_HZ:
        lines = []
        for harmonic in HARMONICS:
            away = np.abs(found.frequency_hz - mains * harmonic)
            if away.size == 0 or away.min() > TOLERANCE * mains * harmonic + 0.5 * spectrum.resolution_hz:
                continue
            i = int(away.argmin())
            hz = float(found.frequency_hz[i])
            lines.append(
                Hum(
                    channel=series.name,
                    mains_hz=mains,
                    harmonic=harmonic,
                    frequency_hz=hz,
                    amplitude_peak=float(found.amplitude[i]),
                    unit=series.unit,
                    db_over_floor=float(found.db_over_floor[i]),
                    shared=bool(np.any(np.abs(expected - hz) <= 2 * spectrum.resolution_hz)),
                )
            )
        own = [line.harmonic for line in lines if not line.shared]
        if 1 in own or len(own) >= LEAST_HARMONICS:
            result += lines
    return tuple(result)
