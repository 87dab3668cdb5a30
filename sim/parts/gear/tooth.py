"""The tooth as a beam: half thickness over height, from the clamped root to the contact point.

x runs along the tooth's centre line from the gear's centre, h is the half thickness there. On the involute
(seed Fig 4, with alpha from alpha_2 on the base circle to -alpha_1 at the contact)
    x = Rb [cos a - (alpha_2 - a) sin a],  h = Rb [sin a + (alpha_2 - a) cos a],  dx = -Rb (alpha_2 - a) cos a da.

Root models
    clamped_at_base  the involute ends and is clamped on the base circle, whatever the root circle is
    true_root        clamped on the root circle. Rf < Rb: flanks go on parallel to the centre line down to the root
                     (Liang, Zuo, Hoseini 2014). Rf > Rb: the involute ends on the root circle. A quarter circle
                     with the height of the rack's fillet is added to the half thickness just above the root.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from sim.core.roots import bracketed_root
from sim.parts.gear.geometry import GearGeometry

FloatArray = NDArray[np.float64]
RootModel = Literal["clamped_at_base", "true_root"]
NODES = 32
"""Gauss-Legendre nodes a segment: the compliances are converged to 1e-9 (tests)."""


@dataclass(frozen=True, kw_only=True)
class RootSection:
    """Where the tooth is clamped: height of the clamp, half angle alpha at the involute's lower end, root thickness."""

    clamp_m: float
    lowest_alpha_rad: float
    half_thickness_m: float
    """Half of S_f: on the root circle, at the 30 degree tangent of the fillet for the true root."""
    half_angle_rad: float
    """theta_f = S_f / (2 Rf)."""


@dataclass(frozen=True, kw_only=True)
class ToothSections:
    """Beam sections under K contact points, arrays (K, Q): height, half thickness, quadrature weight dx, all m."""

    x_m: FloatArray
    h_m: FloatArray
    dx_m: FloatArray


def involute_x_m(gear: GearGeometry, alpha_rad: FloatArray) -> FloatArray:
    """Height along the centre line of the flank point with parameter alpha, m."""
    return gear.base_radius_m * (np.cos(alpha_rad) - (gear.base_half_angle_rad - alpha_rad) * np.sin(alpha_rad))


def involute_h_m(gear: GearGeometry, alpha_rad: FloatArray) -> FloatArray:
    """Half thickness at the flank point with parameter alpha, m."""
    return gear.base_radius_m * (np.sin(alpha_rad) + (gear.base_half_angle_rad - alpha_rad) * np.cos(alpha_rad))


@lru_cache(maxsize=256)
def root_section(gear: GearGeometry, root_model: RootModel) -> RootSection:
    """Clamp and root thickness of a tooth under a root model."""
    base_m, root_m, half = gear.base_radius_m, gear.root_radius_m, gear.base_half_angle_rad
    if root_model == "clamped_at_base":
        # The arc on the root circle is taken as long as the arc on the base circle.
        return RootSection(
            clamp_m=base_m * math.cos(half),
            lowest_alpha_rad=half,
            half_thickness_m=base_m * half,
            half_angle_rad=half * base_m / root_m,
        )
    lowest = half - math.sqrt(max(0.0, (root_m / base_m) ** 2 - 1))
    flank_m = float(involute_h_m(gear, np.array(lowest)))
    thickness_m = flank_m + (1 - math.sin(math.pi / 3)) * gear.fillet_height_m
    return RootSection(
        clamp_m=math.sqrt(max(root_m**2 - flank_m**2, 0.0)),
        lowest_alpha_rad=lowest,
        half_thickness_m=thickness_m,
        half_angle_rad=thickness_m / root_m,
    )


def tooth_sections(
    gear: GearGeometry, alpha_1_rad: FloatArray, root_model: RootModel, nodes: int = NODES
) -> ToothSections:
    """Quadrature sections from the clamp to contact points alpha_1, shape (K,) -> arrays (K, Q)."""
    root = root_section(gear, root_model)
    shape = alpha_1_rad.shape
    low, tip = np.full(shape, root.lowest_alpha_rad), -alpha_1_rad
    if root_model == "clamped_at_base":
        return _involute_piece(gear, low, tip, nodes)
    top_m = root.clamp_m + gear.fillet_height_m
    bottom_m = float(involute_x_m(gear, np.array(root.lowest_alpha_rad)))
    split = np.maximum(np.full(shape, _alpha_at(gear, top_m, root.lowest_alpha_rad)), tip)
    fillet_end_m = min(top_m, bottom_m)
    pieces = [
        _straight_piece(gear, root, fillet_end_m, bottom_m, shape, nodes),
        _straight_piece(gear, root, root.clamp_m, fillet_end_m, shape, nodes),
        _involute_piece(gear, low, split, nodes),
        _involute_piece(gear, split, tip, nodes),
    ]
    x_m = np.concatenate([p.x_m for p in pieces], axis=-1)
    h_m = np.concatenate([p.h_m for p in pieces], axis=-1)
    dx_m = np.concatenate([p.dx_m for p in pieces], axis=-1)
    return ToothSections(x_m=x_m, h_m=h_m + _fillet_m(gear, x_m - root.clamp_m), dx_m=dx_m)


@lru_cache(maxsize=8)
def _nodes(count: int) -> tuple[FloatArray, FloatArray]:
    """Nodes v^2 and weights on [0, 1], crowded at 0, where the fillet meets the root with an infinite slope."""
    x, w = np.polynomial.legendre.leggauss(count)
    v = 0.5 * (x + 1)
    return v**2, w * v


def _involute_piece(gear: GearGeometry, low: FloatArray, high: FloatArray, nodes: int) -> ToothSections:
    part, weight = _nodes(nodes)
    span = (high - low)[..., None]
    alpha = low[..., None] + span * part
    cos, sin, rest = np.cos(alpha), np.sin(alpha), gear.base_half_angle_rad - alpha
    return ToothSections(
        x_m=gear.base_radius_m * (cos - rest * sin),
        h_m=gear.base_radius_m * (sin + rest * cos),
        dx_m=-gear.base_radius_m * rest * cos * span * weight,
    )


def _straight_piece(
    gear: GearGeometry, root: RootSection, low_m: float, high_m: float, shape: tuple[int, ...], nodes: int
) -> ToothSections:
    part, weight = _nodes(nodes)
    full = (*shape, nodes)
    h_m = float(involute_h_m(gear, np.array(root.lowest_alpha_rad)))
    x_m, dx_m = low_m + (high_m - low_m) * part, (high_m - low_m) * weight
    return ToothSections(x_m=np.broadcast_to(x_m, full), h_m=np.full(full, h_m), dx_m=np.broadcast_to(dx_m, full))


def _fillet_m(gear: GearGeometry, above_root_m: FloatArray) -> FloatArray:
    """Extra half thickness of the quarter-circle fillet, m; 0 above it."""
    radius_m = gear.fillet_height_m
    left_m = np.clip(radius_m - above_root_m, 0.0, radius_m)
    return np.asarray(radius_m - np.sqrt(radius_m**2 - left_m**2))


@lru_cache(maxsize=256)
def _alpha_at(gear: GearGeometry, x_m: float, lowest_alpha_rad: float) -> float:
    """Flank parameter whose height is x_m; the lower end when x_m lies below the involute."""
    highest = -math.sqrt((gear.tip_radius_m / gear.base_radius_m) ** 2 - 1) + gear.base_half_angle_rad

    def miss(alpha: float) -> float:
        return float(involute_x_m(gear, np.array(alpha))) - x_m

    if miss(lowest_alpha_rad) >= 0:
        return lowest_alpha_rad
    return highest if miss(highest) <= 0 else bracketed_root(miss, highest, lowest_alpha_rad)
