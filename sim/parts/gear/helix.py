"""Helical gears as spur slices staggered along the face (thin slices, each in its own phase of the mesh).

Module and pressure angle are those of the transverse section. The contact of a pair runs over the face within
    eps_beta = b tan(beta) / (pi m_t) = b sin(beta) / (pi m_n)     (ISO 21771:2007, overlap ratio),
so its stiffness is the spur pair's, averaged over that stretch of the mesh cycle, and it lasts eps_alpha + eps_beta.
A slice's normal stands by the base helix angle to the transverse plane: projecting deflection and force takes cos^2 of
it, the contact line is longer by 1/cos; ISO 6336-1:2006 has the same one factor, cos(beta), in its mesh stiffness.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]
POINTS = 1025
"""Samples of the spur pair's curve: its integral by Simpson's rule is exact to 1e-10."""


@dataclass(frozen=True, kw_only=True)
class Helix:
    """Overlap ratio and base helix angle (rad, positive right-handed) of a pair; both zero for spur gears."""

    overlap_ratio: float = 0.0
    base_angle_rad: float = 0.0


def base_helix_rad(helix_rad: float, pressure_angle_rad: float) -> float:
    """tan(beta_b) = tan(beta) cos(alpha_t), rad (ISO 21771:2007)."""
    return math.atan(math.tan(helix_rad) * math.cos(pressure_angle_rad))


def helix_of(helix_rad: float, pressure_angle_rad: float, module_m: float, width_m: float) -> Helix:
    """Overlap and base helix angle from the transverse section's module and pressure angle."""
    return Helix(
        overlap_ratio=width_m * math.tan(abs(helix_rad)) / (math.pi * module_m),
        base_angle_rad=base_helix_rad(helix_rad, pressure_angle_rad),
    )


def cumulative(curve: FloatArray, step: float) -> FloatArray:
    """Integral from the first sample to each (..., K): cubic between samples (Simpson on the even ones)."""
    middle = 0.5 * step * (curve[..., 1:] + curve[..., :-1])
    slope = np.gradient(curve, step, axis=-1, edge_order=2)
    corrected = middle - step**2 / 12.0 * (slope[..., 1:] - slope[..., :-1])
    return np.concatenate([np.zeros((*curve.shape[:-1], 1)), np.cumsum(corrected, axis=-1)], axis=-1)


def spread(spur: FloatArray, ratio: float, helix: Helix, position: FloatArray) -> FloatArray:
    """Stiffness of a helical pair at positions (P,), base pitches since its first slice touched, N/m, shape (..., P).

    `spur` (..., K): the spur pair of the whole width at K equal steps from 0 to its contact `ratio`.
    """
    grid = np.linspace(0.0, ratio, spur.shape[-1])
    total = cumulative(spur, float(grid[1] - grid[0]))
    last = np.clip(position, 0.0, ratio)
    first = np.clip(position - helix.overlap_ratio, 0.0, ratio)
    rows = total.reshape(-1, total.shape[-1])
    found = np.array([np.interp(last, grid, row) - np.interp(first, grid, row) for row in rows])
    factor = math.cos(helix.base_angle_rad) / helix.overlap_ratio
    return np.asarray(factor * found.reshape(*spur.shape[:-1], position.size))
