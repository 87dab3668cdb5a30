"""Finding lines in a spectrum: local maxima, their frequency and amplitude between bins, leakage from others."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from signals.floor import Floor
from signals.series import BoolArray, FloatArray, IntArray
from signals.spectra.types import Spectrum
from signals.windows import MAIN_LOBE_BINS, transform

LEAKAGE_MARGIN = 2.0
"""A maximum must stand this much above the summed sidelobes of the stronger lines to count as a line."""
FREQUENCY_SPREAD_BINS = 0.75
"""Standard deviation of the interpolated frequency of a Hann line, in bins, times amplitude over floor level: what
three bins give (measured 0.7 by a test). The Cramer-Rao bound is 0.32 (D. C. Rife and R. R. Boorstyn, IEEE Trans. Inf.
Theory 20 (1974) 591-598, with the floor of a Hann bin)."""
DISAGREEMENT_SPREAD_BINS = 1.0
"""The same of the distance between the places that the two neighbours of a Hann line tell (a test measures it)."""
SIGMAS = 3.0
ROW_BLOCK = 512
MAX_PEAKS = 5000
"""The strongest peaks that are looked at; a spectrum with more is noise above its own floor."""


@dataclass(frozen=True, kw_only=True)
class FoundPeaks:
    """Lines found in a spectrum, sorted by frequency; arrays of shape (peaks,)."""

    frequency_hz: FloatArray
    amplitude: FloatArray
    floor: FloatArray
    """Noise level at the peak, in the unit of the amplitude."""
    leak: FloatArray
    """Most that the sidelobes of the stronger lines add at the peak, in the unit of the amplitude."""
    pull_bins: FloatArray
    """How far the peak's two neighbours disagree on where the line is, beyond what noise explains: an unresolved line
    stands near by."""

    @property
    def doubt_bins(self) -> FloatArray:
        """How far the true frequency may lie from the measured, bins: three deviations and the pull of others."""
        spread = (SIGMAS * FREQUENCY_SPREAD_BINS * self.floor + self.leak) / self.amplitude
        return np.asarray(spread + self.pull_bins, dtype=np.float64)

    def part(self, kept: BoolArray) -> FoundPeaks:
        """The peaks where `kept`, shape (peaks,)."""
        return FoundPeaks(
            frequency_hz=self.frequency_hz[kept],
            amplitude=self.amplitude[kept],
            floor=self.floor[kept],
            leak=self.leak[kept],
            pull_bins=self.pull_bins[kept],
        )

    @property
    def db_over_floor(self) -> FloatArray:
        """Amplitude over the noise level, dB."""
        return np.asarray(20 * np.log10(self.amplitude / self.floor), dtype=np.float64)


def find_peaks(spectrum: Spectrum, floor: Floor) -> FoundPeaks:
    """Local maxima above the floor's threshold and above the sidelobes of stronger lines."""
    first = int(MAIN_LOBE_BINS[spectrum.window])
    bins = local_maxima(spectrum.values, floor.threshold, first)
    if bins.size > MAX_PEAKS:
        bins = np.sort(bins[np.argsort(-spectrum.values[bins], kind="stable")[:MAX_PEAKS]])
    frequency, amplitude = refine(spectrum, bins)
    leak = leakage_of_stronger(spectrum, frequency, amplitude)
    level = floor.level[bins]
    by_noise = SIGMAS * DISAGREEMENT_SPREAD_BINS * level / np.maximum(amplitude, 1e-300)
    peaks = FoundPeaks(
        frequency_hz=frequency,
        amplitude=amplitude,
        floor=level,
        leak=leak,
        pull_bins=np.maximum(disagreement_bins(spectrum, bins) - by_noise, 0.0),
    )
    return peaks.part(amplitude > LEAKAGE_MARGIN * leak)


def local_maxima(values: FloatArray, above: FloatArray, first_bin: int) -> IntArray:
    """Bins from `first_bin` on that exceed both neighbours and `above` (both of shape (bins,))."""
    inner = values[1:-1]
    is_peak = (inner > values[:-2]) & (inner >= values[2:]) & (inner > above[1:-1])
    bins = np.flatnonzero(is_peak) + 1
    return np.asarray(bins[bins >= first_bin], dtype=np.int64)


def refine(spectrum: Spectrum, bins: IntArray) -> tuple[FloatArray, FloatArray]:
    """Frequency (Hz) and amplitude of lines near `bins`, interpolated between bins; both of shape (len(bins),).

    The shift from the bin follows from the neighbours by the window's own transform, so both are exact for a
    single sine far from zero frequency. Where a bin is not a local maximum it is returned as it stands.
    """
    left, mid, right = (spectrum.values[bins + i] for i in (-1, 0, 1))
    is_peak = (mid >= left) & (mid >= right) & (mid > 0)
    safe = np.where(is_peak, mid, 1.0)
    if spectrum.window == "boxcar":
        # Both neighbours of a centred line are zero, whichever way it moves: the larger one tells the side.
        ratio = np.maximum(left, right) / safe
        shift = np.where(right >= left, 1.0, -1.0) * ratio / (1 + ratio)
    else:
        slope, shifts = _shift_table(spectrum.window)
        shift = np.interp((right - left) / (left + 2 * safe + right), slope, shifts)
    shift = np.where(is_peak, np.clip(shift, -0.5, 0.5), 0.0)
    frequency = (bins + shift) * spectrum.resolution_hz
    return np.asarray(frequency, dtype=np.float64), mid / transform(spectrum.window, shift)


def disagreement_bins(spectrum: Spectrum, bins: IntArray) -> FloatArray:
    """Distance between the places that the left and the right neighbour of each peak tell, bins, shape (len(bins),).

    A lone sine has one place, whichever neighbour is asked. Another line within the main lobe or the first sidelobes
    pulls `refine`'s place, by less than it parts the two (a test draws such pairs). Zero for a rectangular window, of
    which one neighbour tells nothing.
    """
    if spectrum.window == "boxcar":
        return np.zeros(bins.size)
    left, mid, right = (spectrum.values[bins + i] for i in (-1, 0, 1))
    ratios, shifts = _side_table(spectrum.window)
    by_right = np.interp(right / np.maximum(mid, 1e-300), ratios, shifts)
    by_left = -np.interp(left / np.maximum(mid, 1e-300), ratios, shifts)
    return np.asarray(np.abs(by_right - by_left))


@cache
def _side_table(window_name: str) -> tuple[FloatArray, FloatArray]:
    """X1 / X0 of a sine shifted by delta, ascending, and delta; by symmetry X-1 / X0 of one shifted by -delta."""
    shifts = np.linspace(-0.6, 0.6, 2401)
    mid, right = (np.abs(transform(window_name, i - shifts)) for i in (0, 1))
    return np.asarray(right / mid), shifts


@cache
def _shift_table(window_name: str) -> tuple[FloatArray, FloatArray]:
    """(X1 - X-1) / (X-1 + 2 X0 + X1) of a sine shifted by delta, and delta; for Hann this is delta / 2 exactly."""
    shifts = np.linspace(-0.5, 0.5, 2001)
    left, mid, right = (np.abs(transform(window_name, i - shifts)) for i in (-1, 0, 1))
    return np.asarray((right - left) / (left + 2 * mid + right)), shifts


def leakage(window_name: str, distance_bins: FloatArray) -> FloatArray:
    """Upper envelope of the window's transform over its peak, at a distance in bins; 1 inside the main lobe.

    Hann: 1 / (pi d (d^2 - 1)) from its transform; boxcar: 1 / (pi d). The others are bounded by their highest
    sidelobe (Harris 1978, table 1: Hamming -43 dB, Blackman -58 dB, Blackman-Harris -92 dB; flat top -93 dB).
    """
    d = np.maximum(distance_bins, 1e-9)
    if window_name == "hann":
        return np.where(d < 1.3, 1.0, np.minimum(1.0, 1 / (np.pi * d * np.maximum(d**2 - 1, 1e-9))))
    if window_name == "boxcar":
        return np.where(d < 0.7, 1.0, np.minimum(1.0, 1 / (np.pi * d)))
    highest_db = {"hamming": -42.7, "blackman": -58.1, "blackmanharris": -92.0, "flattop": -93.0}[window_name]
    return np.where(d < MAIN_LOBE_BINS[window_name], 1.0, 10 ** (highest_db / 20))


def leakage_of_stronger(spectrum: Spectrum, frequency_hz: FloatArray, amplitude: FloatArray) -> FloatArray:
    """Sum of the sidelobes of all stronger lines at each line, an upper bound; shapes (lines,)."""
    position = frequency_hz / spectrum.resolution_hz
    leak = np.zeros(amplitude.size)
    for start in range(0, amplitude.size, ROW_BLOCK):
        rows = slice(start, start + ROW_BLOCK)
        spread = leakage(spectrum.window, np.abs(position[rows, np.newaxis] - position))
        stronger = amplitude[np.newaxis] > amplitude[rows, np.newaxis]
        leak[rows] = np.sum(np.where(stronger, spread * amplitude, 0.0), axis=1)
    return leak
