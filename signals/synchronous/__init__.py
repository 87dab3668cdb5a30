"""Averages over the turns of a shaft, and what they leave when the regular part is taken out."""

from signals.synchronous.average import SynchronousAverage, synchronous_average
from signals.synchronous.separate import GearSignals, separate

__all__ = ["GearSignals", "SynchronousAverage", "separate", "synchronous_average"]
