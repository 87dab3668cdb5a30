"""Choosing a demodulation band: the most repetitive and impulsive of the sub-bands of a binary/ternary tree.

The tree of bandwidths (fs/2)/{1, 2, 3, 4, 6, 8, 12, ...} and the spectral kurtosis E|x|^4 / (E|x|^2)^2 - 2 of the
complex envelope x of each band (0 for stationary Gaussian noise, negative for steady lines) are those of
J. Antoni, "Fast computation of the kurtogram for the detection of transient faults", Mech. Syst. Signal
Process. 21 (2007) 108-124. Kurtosis alone falls for a single click anywhere in the record, so among the bands whose
kurtosis is above chance the one with the largest mean of two negentropies <w ln w> is taken, of the squared envelope
in time (w: the envelope over its mean) and of its spectrum (w: power of a bin over their mean): impacts stand out in
time, and repeated ones gather in few lines, where a click spreads over all. That is the infogram's average of
J. Antoni, "The infogram: entropic evidence of the signature of repetitive transients", Mech. Syst. Signal Process. 74
(2016) 73-94. A single click, or the jump from the end of the record to its beginning, has the larger mean at times:
bands whose spectrum is no more lined than noise makes it are passed over. The spectrum's half by itself falls for a low
band with a few lines of the shaft and the bearing in it, that beat; gears beat sharply as well, and have no excess
kurtosis.
The bands are cut ideally from one transform of the whole series.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import fft
from scipy.special import ndtri

from signals.series import FloatArray, Series
from signals.spectra.types import Band
from sim.core.errors import Problem, SpecError

RULE = "largest mean negentropy of the squared envelope and of its spectrum among the bands of a 1/3-binary tree whose "
RULE += "spectral kurtosis, and where there are such the negentropy of that spectrum, is above chance; if no band is "
RULE += "impulsive, the largest spectral kurtosis relative to chance"
FALSE_ALARM = 0.05
MIN_BAND_SAMPLES = 128
"""Complex samples a band needs before its kurtosis is looked at."""
NOISE_NEGENTROPY = 1 - float(np.euler_gamma)
MIN_POWER_SHARE = 1e-6
"""Bands with less of the power are passed over: in simulated or filtered signals they hold rounding only."""


@dataclass(frozen=True, kw_only=True)
class _Candidate:
    low_hz: float
    high_hz: float
    kurtosis: float
    in_time: float
    in_spectrum: float
    """Negentropies of the squared envelope and of its spectrum."""
    samples: int

    @property
    def negentropy(self) -> float:
        """Mean of both."""
        return (self.in_time + self.in_spectrum) / 2

    @property
    def repetitive(self) -> bool:
        """Whether the spectrum is more lined than that of noise, by three deviations.

        Its bins are exponential there: <w ln w> = 1 - 0.577 with a variance of Gamma''(3) - 0.423^2 = 2.3 a bin.
        """
        bins = self.samples // 2
        return self.in_spectrum > NOISE_NEGENTROPY + 3 * math.sqrt(2.3 / bins)


def choose_band(series: Series, *, min_bandwidth_hz: float | None = None, max_level: int = 5) -> Band:
    """The band to demodulate. `min_bandwidth_hz` should hold a few multiples of the fault frequency looked for
    (default: the narrowest of the tree, (fs/2)/2^max_level).
    """
    transform = np.asarray(fft.rfft(series.samples - np.mean(series.samples)), dtype=np.complex128)
    nyquist = series.sampling_rate_hz / 2
    if min_bandwidth_hz is not None and not 0 < min_bandwidth_hz <= nyquist:
        raise SpecError(
            Problem(
                field="min_bandwidth_hz",
                message="no band can be that wide",
                given=min_bandwidth_hz,
                allowed=f"above 0, up to {nyquist:g}",
                unit="Hz",
            )
        )
    narrowest = min_bandwidth_hz or nyquist / 2**max_level
    candidates: list[_Candidate] = []
    for parts in tree(max_level):
        # 1e-9: a width asked for as fs/2/k must not be lost to rounding
        if parts > 1 and nyquist / parts < narrowest * (1 - 1e-9):
            break
        candidates.extend(_level(transform, parts, nyquist))
    return _best(candidates, nyquist)


def tree(max_level: int) -> list[int]:
    """Numbers of bands a level splits the axis into: 1, 2, 3, 4, 6, 8, 12, ..."""
    parts = [1]
    for level in range(1, max_level + 1):
        parts.append(2**level)
        if level < max_level:
            parts.append(3 * 2 ** (level - 1))
    return parts


def _level(transform: NDArray[np.complex128], parts: int, nyquist: float) -> list[_Candidate]:
    """Measures of `parts` equal bands; those that hold next to no power are left out."""
    size = transform.size // parts
    if size < MIN_BAND_SAMPLES:
        return []
    # Twice the critical rate: the squared envelope of a band is twice as wide as the band.
    envelope = fft.ifft(transform[: size * parts].reshape(parts, size), n=2 * size, axis=1)
    power = envelope.real**2 + envelope.imag**2
    mean = np.mean(power, axis=1)
    width = nyquist * size / transform.size
    return [
        _Candidate(
            low_hz=float(i * width),
            high_hz=float((i + 1) * width),
            kurtosis=float(np.mean(power[i] ** 2) / mean[i] ** 2 - 2),
            in_time=_entropy_gap(power[i]),
            in_spectrum=_negentropy(power[i] - mean[i]),
            samples=size,
        )
        for i in np.flatnonzero(mean > MIN_POWER_SHARE * np.sum(mean))
    ]


def _negentropy(squared_envelope: FloatArray) -> float:
    """<w ln w> of the bins up to half the bandwidth; beyond, noise itself falls off towards the band's width."""
    spectrum = fft.rfft(squared_envelope)[1 : squared_envelope.size // 4]
    return _entropy_gap(np.asarray(spectrum.real**2 + spectrum.imag**2, dtype=np.float64))


def _entropy_gap(power: FloatArray) -> float:
    """<w ln w> of powers over their mean: 0 when all are equal, ln n when one of n has all."""
    share = power / max(float(np.mean(power)), np.finfo(np.float64).tiny)
    return float(np.mean(share * np.log(np.maximum(share, 1e-300))))


def _best(candidates: list[_Candidate], nyquist: float) -> Band:
    if not candidates:
        return Band(low_hz=0.0, high_hz=nyquist, rule="whole axis: the signal is too short or silent to choose from")
    alarm = FALSE_ALARM / len(candidates)  # Bonferroni over all bands
    excess = {c: c.kurtosis - chance_level(c.samples, alarm) for c in candidates}
    impulsive = [c for c in candidates if excess[c] > 0]
    if impulsive:
        repeated = [c for c in impulsive if c.repetitive] or impulsive
        best = max(repeated, key=lambda c: (c.negentropy, c.high_hz - c.low_hz))
    else:
        best = max(candidates, key=lambda c: (excess[c], c.high_hz - c.low_hz))
    return Band(
        low_hz=best.low_hz,
        high_hz=best.high_hz,
        rule=RULE,
        spectral_kurtosis=best.kurtosis,
        threshold=chance_level(best.samples, alarm),
    )


def chance_level(samples: int, alarm: float) -> float:
    """Spectral kurtosis that complex Gaussian noise exceeds with probability `alarm`, by Cornish-Fisher expansion.

    To first order the estimate is the mean of p^2 - 4p + 2 over exponential p: its variance is 4, its skewness
    80 / 4^1.5 = 10 and its excess kurtosis 4752 / 16 - 3 = 294, each over the power of `samples` that a mean brings.
    Slightly high for short bands (0.70 for 0.64 at 256 samples and 2e-4), so alarms are no more than stated.
    """
    z = -float(ndtri(alarm))
    skewness, excess = 10 / samples**0.5, 294 / samples
    z += (z**2 - 1) * skewness / 6 + (z**3 - 3 * z) * excess / 24 - (2 * z**3 - 5 * z) * skewness**2 / 36
    return float(z * 2 / samples**0.5)
