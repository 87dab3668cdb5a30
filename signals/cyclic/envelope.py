"""Enhanced envelope spectrum: the cyclic coherence over the carriers of a band, against what noise would give.

J. Antoni, G. Xin and N. Hamzaoui, "Fast computation of the spectral correlation", Mech. Syst. Signal Process. 92 (2017)
248-277, section 5: the envelope spectrum of the whitened signal. Unlike the envelope spectrum it needs no band, and
strong stationary parts of the spectrum do not drown weak modulated ones.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signals.cyclic.coherence import CyclicCoherence
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

FALSE_ALARM = 0.01


@dataclass(frozen=True, kw_only=True)
class EnhancedEnvelope:
    """Mean |gamma|^2 over the band, `values` (alphas,), dimensionless, over `alpha_hz` (alphas,).

    Stationary Gaussian noise has the mean `expected` and exceeds `threshold` at *any* alpha with probability 1 %.
    """

    alpha_hz: FloatArray
    values: FloatArray
    expected: float
    threshold: float
    low_hz: float
    high_hz: float
    resolution_hz: float
    channel: str = ""

    def peaks(self, most: int = 20) -> tuple[tuple[float, float], ...]:
        """(alpha in Hz, value) of the local maxima above the threshold, the strongest first."""
        padded = np.concatenate(([-np.inf], self.values, [-np.inf]))
        top = (self.values > padded[:-2]) & (self.values >= padded[2:]) & (self.values > self.threshold)
        found = sorted(np.flatnonzero(top), key=lambda i: -self.values[i])[:most]
        return tuple((float(self.alpha_hz[i]), float(self.values[i])) for i in found)


def enhanced_envelope(coherence: CyclicCoherence, band_hz: tuple[float, float] | None = None) -> EnhancedEnvelope:
    """Mean over the bands that lie wholly within `band_hz` (default: all)."""
    low, high = band_hz or (float(coherence.low_hz[0]), float(coherence.high_hz[-1]))
    rows = np.flatnonzero((coherence.low_hz >= low - 1e-9) & (coherence.high_hz <= high + 1e-9))
    if not rows.size:
        raise SpecError(
            Problem(
                field="band_hz",
                message="holds no whole band of the coherence",
                given=band_hz,
                allowed=f"at least {coherence.high_hz[0] - coherence.low_hz[0]:.4g} wide",
                unit="Hz",
            )
        )
    return EnhancedEnvelope(
        alpha_hz=coherence.alpha_hz,
        values=np.asarray(np.mean(coherence.values[rows], axis=0), dtype=np.float64),
        expected=1 / coherence.averages,
        threshold=coherence.chance_level(FALSE_ALARM / coherence.alpha_hz.size, int(rows.size)),
        low_hz=float(coherence.low_hz[rows[0]]),
        high_hz=float(coherence.high_hz[rows[-1]]),
        resolution_hz=coherence.resolution_hz,
        channel=coherence.channel,
    )
