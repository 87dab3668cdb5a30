"""Results of spectral analysis. Each says its unit, scaling, window and resolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from signals.series import FloatArray

AmplitudeKind = Literal["peak", "rms"]
SpectrumKind = Literal["amplitude", "envelope", "squared_envelope", "density"]
Scaling = Literal["peak", "rms", "density"]
"""`peak`/`rms`: a sine a sin(2 pi f t) reads a or a/sqrt(2); `density`: power per hertz."""


@dataclass(frozen=True, kw_only=True)
class Band:
    """A demodulation band and why it was chosen. `spectral_kurtosis` is None when the band was given."""

    low_hz: float
    high_hz: float
    rule: str
    spectral_kurtosis: float | None = None
    threshold: float | None = None
    """Spectral kurtosis a stationary Gaussian signal exceeds in any band of the search with probability 5 %."""

    @property
    def impulsive(self) -> bool | None:
        """Whether the chosen band is more impulsive than chance; None when the band was given."""
        if self.spectral_kurtosis is None or self.threshold is None:
            return None
        return self.spectral_kurtosis > self.threshold


@dataclass(frozen=True, kw_only=True)
class Spectrum:
    """One-sided spectrum: `frequency_hz` and `values` have shape (bins,), frequency_hz[k] = k resolution_hz.

    `unit` is the unit of `values` (`m/s^2`, `(m/s^2)^2/Hz`).
    """

    kind: SpectrumKind
    frequency_hz: FloatArray
    values: FloatArray
    unit: str
    scaling: Scaling
    window: str
    resolution_hz: float
    """Spacing of the bins, 1/T of one segment."""
    noise_bandwidth_hz: float
    """Equivalent noise bandwidth of a bin: amplitude^2 of noise = density times this."""
    averages: int = 1
    effective_averages: float = 1.0
    """Number of independent averages that has the same variance (overlap counted)."""
    channel: str = ""
    band: Band | None = None

    def amplitude_factor(self, kind: AmplitudeKind) -> float:
        """Factor from this spectrum's values to the asked kind of amplitude (line spectra only)."""
        if self.scaling == "density":
            raise ValueError("a density has no line amplitude; use an amplitude spectrum")
        if self.scaling == kind:
            return 1.0
        return float(np.sqrt(2.0) if kind == "peak" else np.sqrt(0.5))


@dataclass(frozen=True, kw_only=True)
class OrderSpectrum:
    """One-sided spectrum over orders of one shaft: `order` and `values` have shape (bins,)."""

    order: FloatArray
    values: FloatArray
    unit: str
    scaling: AmplitudeKind
    window: str
    resolution_order: float
    noise_bandwidth_order: float
    shaft: str
    mean_speed_hz: float
    samples_per_revolution: int
    revolutions: float
    channel: str = ""

    def at_speed(self, speed_hz: float) -> Spectrum:
        """The same lines over frequency at a constant speed, for labelling: frequency = order times speed."""
        return Spectrum(
            kind="amplitude",
            frequency_hz=self.order * speed_hz,
            values=self.values,
            unit=self.unit,
            scaling=self.scaling,
            window=self.window,
            resolution_hz=self.resolution_order * speed_hz,
            noise_bandwidth_hz=self.noise_bandwidth_order * speed_hz,
            channel=self.channel,
        )


@dataclass(frozen=True, kw_only=True)
class Spectrogram:
    """Amplitude over time: `values` has shape (bins, frames); `time_s` is the centre of each frame."""

    time_s: FloatArray
    frequency_hz: FloatArray
    values: FloatArray
    unit: str
    scaling: AmplitudeKind
    window: str
    resolution_hz: float
    hop_s: float
    channel: str = ""
