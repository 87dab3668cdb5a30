"""Outer measures of a bearing, for judging whether numbers belong together; never for physics."""

from __future__ import annotations

from dataclasses import dataclass

from sim.core.spec import BearingSpec
from sim.parts.bearing.catalogue import lookup
from sim.parts.bearing.from_spec import geometry_from_spec

RING_SHARE = 1.6
"""(d_m - d) / d_b and (D - d_m) / d_b: 1.56 to 1.84 over the catalogue (`tests`)."""


@dataclass(frozen=True, kw_only=True)
class BearingSize:
    """Ball, pitch, bore and outside diameter, m; `estimated` when the last two follow from the first two."""

    ball_m: float
    pitch_m: float
    bore_m: float
    outside_m: float
    estimated: bool


def bearing_size(bearing: BearingSpec) -> BearingSize | None:
    """Sizes of a bearing; None when only the ratio of its diameters is known."""
    geometry = geometry_from_spec(bearing)
    row = None if bearing.catalogue is None else lookup(bearing.catalogue)
    ball, pitch = geometry.ball_diameter_m, geometry.pitch_diameter_m
    if row is not None:
        ball, pitch = row.ball_diameter_m, row.pitch_diameter_m
    if ball is None or pitch is None:
        return None
    bore = None if row is None else row.bore_m
    outside = None if row is None else row.outside_m
    return BearingSize(
        ball_m=ball,
        pitch_m=pitch,
        bore_m=pitch - RING_SHARE * ball if bore is None else bore,
        outside_m=pitch + RING_SHARE * ball if outside is None else outside,
        estimated=bore is None or outside is None,
    )
