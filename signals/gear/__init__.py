"""Condition indicators of gears."""

from signals.gear.indicators import GearIndicators, fm0, gear_indicators, mesh_envelope, normalised_moment
from signals.gear.runs import quasi_kurtosis

__all__ = ["GearIndicators", "fm0", "gear_indicators", "mesh_envelope", "normalised_moment", "quasi_kurtosis"]
