"""Where product and generator say the same in different numbers or words."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

FAULT_WORDS: Mapping[str, tuple[str, ...]] = {
    "clipping": ("clipping", "clipped", "saturated"),
    "dropouts": ("dropouts", "dropout", "gaps"),
    "mains_hum": ("mains_hum", "hum", "mains"),
    "loose_sensor": ("loose_sensor", "sensor_resonance"),
    "stuck": ("stuck", "constant", "silence"),
    "swapped": ("swapped", "swapped_channels"),
    "gain_change": ("gain_change", "gain", "sensitivity", "unit_mismatch"),
    "aliasing": ("aliasing", "alias"),
}
"""Kinds of sensor fault and what the engine may call them."""
CRACK_DEPTH = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5)
CRACK_LOSS: Mapping[str, tuple[float, ...]] = {
    "pinion": (0.0, 0.007, 0.020, 0.039, 0.066, 0.105),
    "gear": (0.0, 0.035, 0.103, 0.196, 0.311, 0.448),
}
"""Mean stiffness that a pair loses at a crack depth (docs/physics/tooth_crack.md, the paper's gears at 70 degrees)."""


def same_unit(term: str, site: str, name: str, value: float) -> float:
    """A severity of the product's term in the generator's measure."""
    if term == "tooth_crack" and name == "depth":
        return float(np.interp(value, CRACK_DEPTH, CRACK_LOSS.get(site, CRACK_LOSS["pinion"])))
    return value
