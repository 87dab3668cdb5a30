"""Torsion arm of a tooth pair whose axes are tilted: how far the load's centre moves along the face.

Model: the flanks touch over the width W like a bed of equal springs with mean deflection d under the mesh load. A
tilt theta in the plane of action changes the deflection by z tan(theta) along the width, so
    full contact, W |tan theta| <= 2 d:  t = W^2 tan(theta) / (12 d)
    partial contact:                     t = sign(theta) (W/2 - b/3),  b = sqrt(2 W d / |tan theta|)
continuous at t = W/6, zero when aligned, W/2 (edge load) at most. The seed's constant arm W/8 is the value at
W |tan theta| = 1.5 d. Only the arm is modelled here; the loss of contact width is a matter of thin slices.
"""

from __future__ import annotations

import numpy as np

from sim.parts.gear.tooth import FloatArray


def torsion_arm_m(tilt_rad: FloatArray, width_m: float, mean_deflection_m: float) -> FloatArray:
    """Signed shift of the load's centre, m, for signed tilts (any shape); odd in the tilt."""
    slope = np.tan(tilt_rad)
    steep = np.maximum(np.abs(slope), 2 * mean_deflection_m / width_m)
    edge_m = 0.5 * width_m - np.sqrt(2 * width_m * mean_deflection_m / steep) / 3
    full = np.abs(slope) * width_m <= 2 * mean_deflection_m
    return np.asarray(np.where(full, width_m**2 * slope / (12 * mean_deflection_m), np.sign(slope) * edge_m))
