"""Spectral analysis of one channel."""

from signals.spectra.amplitude import amplitude_spectrum, power_spectral_density
from signals.spectra.angle import constant_speed_angle, resample_in_angle, tacho_angle
from signals.spectra.band import choose_band
from signals.spectra.envelope import envelope, envelope_spectrum, given_band
from signals.spectra.order import order_spectrum
from signals.spectra.spectrogram import spectrogram
from signals.spectra.types import AmplitudeKind, Band, OrderSpectrum, Scaling, Spectrogram, Spectrum, SpectrumKind

__all__ = [
    "AmplitudeKind",
    "Band",
    "OrderSpectrum",
    "Scaling",
    "Spectrogram",
    "Spectrum",
    "SpectrumKind",
    "amplitude_spectrum",
    "choose_band",
    "constant_speed_angle",
    "envelope",
    "envelope_spectrum",
    "given_band",
    "order_spectrum",
    "power_spectral_density",
    "resample_in_angle",
    "spectrogram",
    "tacho_angle",
]
