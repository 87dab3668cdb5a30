"""Rolling geometry of a bearing of the machine specification."""

from __future__ import annotations

import math
from dataclasses import replace

from sim.core.errors import Problem, SpecError
from sim.core.spec import BallGeometry, BearingSpec
from sim.parts.bearing.catalogue import lookup
from sim.parts.bearing.geometry import RollingGeometry, from_diameters

_SPEC_NAMES = {"contact_angle_rad": "contact_angle_deg"}


def _relocated(error: SpecError, field: str) -> SpecError:
    """The same problems under the field where the caller wrote the geometry."""
    return SpecError([replace(p, field=f"{field}.{_SPEC_NAMES.get(p.field, p.field)}") for p in error.problems])


def geometry_from_ball_spec(spec: BallGeometry, *, field: str = "geometry") -> RollingGeometry:
    """Checked geometry from the specification's form; problems are reported under `field`."""
    angle_rad = math.radians(spec.contact_angle_deg)
    if spec.diameter_ratio is None and spec.ball_diameter_m is None and spec.pitch_diameter_m is None:
        message = "needs both diameters, or their ratio when only frequencies matter"
        raise SpecError(Problem(field=f"{field}.ball_diameter_m", message=message, allowed="a diameter", unit="m"))
    try:
        if spec.diameter_ratio is None and spec.ball_diameter_m is not None and spec.pitch_diameter_m is not None:
            return from_diameters(
                balls=spec.balls,
                ball_diameter_m=spec.ball_diameter_m,
                pitch_diameter_m=spec.pitch_diameter_m,
                contact_angle_rad=angle_rad,
                inner_groove_ratio=spec.inner_groove_ratio,
                outer_groove_ratio=spec.outer_groove_ratio,
                width_m=spec.width_m,
            )
        return RollingGeometry(
            balls=spec.balls,
            # One diameter alone is refused by the constructor; any admissible ratio lets it get that far.
            diameter_ratio=0.2 if spec.diameter_ratio is None else spec.diameter_ratio,
            ball_diameter_m=spec.ball_diameter_m,
            pitch_diameter_m=spec.pitch_diameter_m,
            contact_angle_rad=angle_rad,
            inner_groove_ratio=spec.inner_groove_ratio,
            outer_groove_ratio=spec.outer_groove_ratio,
            width_m=spec.width_m,
        )
    except SpecError as error:
        raise _relocated(error, field) from None


def geometry_from_spec(bearing: BearingSpec, *, field: str = "bearing") -> RollingGeometry:
    """Geometry of a bearing from its catalogue designation or its own numbers, exactly one of them."""
    if (bearing.catalogue is None) == (bearing.geometry is None):
        message = "give either a catalogue designation or a geometry"
        raise SpecError(Problem(field=f"{field}.geometry", message=message, allowed="exactly one of the two"))
    if bearing.geometry is not None:
        return geometry_from_ball_spec(bearing.geometry, field=f"{field}.geometry")
    assert bearing.catalogue is not None
    return lookup(bearing.catalogue).geometry()
