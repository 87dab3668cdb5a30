"""Ready machines."""

from sim.presets.catalogue import PRESETS, Preset, names, preset

__all__ = ["PRESETS", "Preset", "names", "preset"]
