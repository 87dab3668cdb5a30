"""Spectral kurtosis over bands of every width, and the band it proposes."""

from signals.kurtogram.kurtogram import Cell, Kurtogram, kurtogram

__all__ = ["Cell", "Kurtogram", "kurtogram"]
