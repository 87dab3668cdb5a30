"""Rolling geometry of a bearing of the machine specification."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

from sim.core.errors import Problem, SpecError
from sim.core.spec import BallGeometry, BearingSpec
from sim.parts.bearing.catalogue import lookup
from sim.parts.bearing.geometry import RollingGeometry
from sim.parts.bearing.uncatalogued import uncatalogued

_SPEC_NAMES = {"contact_angle_rad": "contact_angle_deg"}


def _relocated(error: SpecError, field: str) -> SpecError:
    """The same problems under the field where the caller wrote the geometry."""
    return SpecError([replace(p, field=f"{field}.{_SPEC_NAMES.get(p.field, p.field)}") for p in error.problems])


def _completed(spec: BallGeometry, field: str) -> tuple[float | None, float | None, float]:
    """Ball diameter, pitch diameter and ratio, each completed from the other two where that is possible."""
    ball, pitch, ratio = spec.ball_diameter_m, spec.pitch_diameter_m, spec.diameter_ratio
    if ratio is None:
        if ball is None or pitch is None:
            missing = "ball_diameter_m" if ball is None else "pitch_diameter_m"
            message = "is missing: give both diameters, or their ratio when only frequencies matter"
            raise SpecError(Problem(field=f"{field}.{missing}", message=message, allowed="a diameter", unit="m"))
        return ball, pitch, ball / pitch
    if ball is None and pitch is not None:
        ball = ratio * pitch
    elif pitch is None and ball is not None:
        pitch = ball / ratio
    return ball, pitch, ratio


@lru_cache(maxsize=256)
def geometry_from_ball_spec(spec: BallGeometry, *, field: str = "geometry") -> RollingGeometry:
    """Checked geometry from the specification's form; problems are reported under `field`."""
    ball_m, pitch_m, ratio = _completed(spec, field)
    try:
        return RollingGeometry(
            balls=spec.balls,
            diameter_ratio=ratio,
            ball_diameter_m=ball_m,
            pitch_diameter_m=pitch_m,
            contact_angle_rad=math.radians(spec.contact_angle_deg),
            inner_groove_ratio=spec.inner_groove_ratio,
            outer_groove_ratio=spec.outer_groove_ratio,
            width_m=spec.width_m,
        )
    except SpecError as error:
        raise _relocated(error, field) from None


def geometry_from_spec(bearing: BearingSpec, *, field: str = "") -> RollingGeometry:
    """Geometry of a bearing from its catalogue designation or its own numbers, exactly one of them; problems are
    reported under `field`, else under the bearing's name."""
    field = field or f"bearings.{bearing.name}"
    if (bearing.catalogue is None) == (bearing.geometry is None):
        message = "give either a catalogue designation or a geometry"
        raise SpecError(Problem(field=f"{field}.geometry", message=message, allowed="exactly one of the two"))
    if bearing.geometry is not None:
        return geometry_from_ball_spec(bearing.geometry, field=f"{field}.geometry")
    assert bearing.catalogue is not None
    unknown = unknown_size(bearing, field)
    if unknown is not None:
        raise SpecError(unknown)
    return lookup(bearing.catalogue).geometry()


def unknown_size(bearing: BearingSpec, field: str) -> Problem | None:
    """The problem with a designation that the catalogue does not have."""
    return None if bearing.catalogue is None else uncatalogued(bearing.catalogue, f"{field}.catalogue", "a `geometry`")
