"""Cyclic spectral coherence: how far the spectrum at f and at f - alpha are the same signal, modulated at alpha.

|gamma|^2 = |S(alpha, f)|^2 / (S(0, f) S(0, f - alpha)), between 0 and 1, with the spectral correlation S estimated by
smoothing the cyclic periodogram X(f) X*(f - alpha) over frequency: W. A. Gardner, "Measurement of spectral
correlation", IEEE Trans. Acoust. Speech Signal Process. 34 (1986) 1111-1123; use and significance in J. Antoni,
"Cyclic spectral analysis in practice", Mech. Syst. Signal Process. 21 (2007) 597-630, and "Cyclostationarity by
examples", ibid. 23 (2009) 987-1036. The fast estimator of J. Antoni, G. Xin and N. Hamzaoui, ibid. 92 (2017) 248-277,
sums over time instead; smoothing over frequency keeps the coherence below 1 and its distribution for noise known, and
costs (bins x cyclic frequencies) a segment.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from scipy import fft

from signals.series import ComplexArray, FloatArray, IntArray, Series
from signals.spectra.segments import effective_averages, hop_length, segment_length, segments
from signals.windows import window
from sim.core.errors import Problem, SpecError

LONGEST_SEGMENT_S = 2.0
"""Longer records are cut into half-overlapping segments: alpha is resolved to 0.5 Hz, the time linear in the record."""
MIN_BINS = 32
FIRST_ALPHA = 3
"""Bins nearer than this share the window's main lobe: they are coherent whatever the signal (Hann: exactly two)."""
BANDS = 64
MAX_VALUES = 8_000_000
WINDOW = "hann"


@dataclass(frozen=True, kw_only=True)
class CyclicCoherence:
    """Mean |gamma|^2 over the segments: `values` has shape (bands, alphas), dimensionless.

    Band i covers `low_hz[i]` <= f < `high_hz[i]`; `alpha_hz` (alphas,) rises by `resolution_hz` from 3 of them on.
    A stationary Gaussian signal has the mean 1 / `averages` everywhere.
    """

    alpha_hz: FloatArray
    low_hz: FloatArray
    high_hz: FloatArray
    values: FloatArray
    resolution_hz: float
    averages: float
    """Independent products in a band of a segment."""
    segments: int
    effective_segments: float
    channel: str = ""

    def chance_level(self, false_alarm: float, bands: int = 1) -> float:
        """Level that the mean of `bands` bands of stationary Gaussian noise exceeds with probability `false_alarm`.

        One |gamma|^2 of K averages is Beta(1, K - 1) distributed (Antoni 2007); the mean of several is taken as a Gamma
        of the same mean and variance.
        """
        k = self.averages
        mean, variance = 1 / k, (k - 1) / (k**2 * (k + 1)) / (self.effective_segments * bands)
        return float(scipy.stats.gamma.isf(false_alarm, mean**2 / variance, scale=variance / mean))


def cyclic_coherence(
    series: Series,
    *,
    max_alpha_hz: float,
    band_hz: tuple[float, float] | None = None,
    bands: int = BANDS,
    resolution_hz: float | None = None,
) -> CyclicCoherence:
    """Coherence for cyclic frequencies to `max_alpha_hz` and carriers in `band_hz` (default: all above `max_alpha_hz`).

    `resolution_hz` of alpha (default: 1 / record, at least 0.5 Hz). `bands` is the number of carrier bands, fewer where
    a band would hold less than 32 bins. Lines of any kind are coherent with each other: take the regular part of gears
    out first (`signals.synchronous`, `signals.cepstrum`), or look where they are not.
    """
    if resolution_hz is None:
        resolution_hz = 1 / min(series.duration_s, LONGEST_SEGMENT_S)
    length = segment_length(series, resolution_hz)
    step = series.sampling_rate_hz / length
    alphas, edges = _grid(series, step, max_alpha_hz, band_hz, bands)
    win = window(WINDOW, length)
    hop = hop_length(length, 0.5)
    frames = segments(series.samples, length, hop)
    total = np.zeros((edges.size - 1, alphas - FIRST_ALPHA + 1))
    mean = float(np.mean(series.samples))
    for frame in frames:
        total += _segment(np.asarray(fft.rfft((frame - mean) * win.values)), alphas, edges)
    return CyclicCoherence(
        alpha_hz=np.arange(FIRST_ALPHA, alphas + 1, dtype=np.float64) * step,
        low_hz=edges[:-1].astype(np.float64) * step,
        high_hz=edges[1:].astype(np.float64) * step,
        values=total / frames.shape[0],
        resolution_hz=step,
        averages=_independent(int(edges[1] - edges[0])),
        segments=int(frames.shape[0]),
        effective_segments=effective_averages(win.values, hop, int(frames.shape[0])),
        channel=series.name,
    )


def _segment(spectrum: ComplexArray, alphas: int, edges: IntArray) -> FloatArray:
    """|gamma|^2 of one segment, (bands, cyclic frequencies)."""
    first, last = int(edges[0]), int(edges[-1])
    starts = edges[:-1] - first
    here = spectrum[first:last]
    power = spectrum.real**2 + spectrum.imag**2
    here_power = np.add.reduceat(power[first:last], starts)
    values = np.empty((edges.size - 1, alphas - FIRST_ALPHA + 1))
    for column, a in enumerate(range(FIRST_ALPHA, alphas + 1)):
        product = np.add.reduceat(here * spectrum[first - a : last - a].conj(), starts)
        below = here_power * np.add.reduceat(power[first - a : last - a], starts)
        size = product.real**2 + product.imag**2
        values[:, column] = np.where(below > 0, size / np.where(below > 0, below, 1.0), 0.0)
    return values


def _grid(
    series: Series, step: float, max_alpha_hz: float, band_hz: tuple[float, float] | None, bands: int
) -> tuple[int, IntArray]:
    """Number of cyclic frequencies, and the edges of the bands in bins, (bands + 1,), equally wide."""
    nyquist = series.sampling_rate_hz / 2
    low, high = band_hz or (max_alpha_hz, nyquist)
    problems = []
    if not FIRST_ALPHA * step <= max_alpha_hz < nyquist:
        allowed = f"{FIRST_ALPHA * step:g} to below {nyquist:g}"
        problems.append(_problem("max_alpha_hz", "is no cyclic frequency of this signal", max_alpha_hz, allowed))
    elif not max_alpha_hz <= low < high <= nyquist * (1 + 1e-9):
        allowed = f"{max_alpha_hz:g} (max_alpha_hz) <= low < high <= {nyquist:g}"
        problems.append(_problem("band_hz", "is no band of carriers", (low, high), allowed))
    elif (high - low) / step < MIN_BINS + 2:
        problems.append(_problem("band_hz", "is too narrow", (low, high), f"at least {(MIN_BINS + 2) * step:.4g} wide"))
    if bands < 1:
        problems.append(Problem(field="bands", message="must be positive", given=bands, allowed="1 or more"))
    if problems:
        raise SpecError(problems)
    alphas = int(max_alpha_hz / step * (1 + 1e-12))
    first, last = max(int(np.ceil(low / step)), alphas + 1), int(np.floor(high / step)) + 1
    width = max(MIN_BINS, (last - first) // bands)
    count = (last - first) // width
    if count * alphas > MAX_VALUES:
        allowed = f"at most {MAX_VALUES // count * step:.4g} with {count} bands"
        raise SpecError(_problem("max_alpha_hz", "gives too large a map; ask fewer bands", max_alpha_hz, allowed))
    return alphas, first + width * np.arange(count + 1)


def _problem(field: str, message: str, given: object, allowed: str) -> Problem:
    return Problem(field=field, message=message, given=given, allowed=allowed, unit="Hz")


def _independent(bins: int) -> float:
    """Independent products among `bins` neighbours.

    Bins d apart of windowed noise correlate by rho_d, the transform of the squared window at d bins; the products of
    two such spectra by |rho_d|^2.
    """
    distance = np.arange(1.0, 6.0)
    taper = window(WINDOW, 4096).values ** 2
    kernel = np.abs(fft.rfft(taper))[: distance.size + 1]
    rho = kernel[1:] / kernel[0]
    shared = np.sum(2 * (1 - distance / bins) * rho**2)
    return float(bins / (1 + shared))
