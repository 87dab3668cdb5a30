"""What the three spalls declare alike: parameters, the sizes they need, and which of them make no spall."""

from __future__ import annotations

from sim.core.errors import Problem, SpecError
from sim.core.laws import BallLaw
from sim.core.params import Param
from sim.core.spec import MachineSpec
from sim.core.terms import FAINT, SiteContext, Values
from sim.parts.bearing.frequencies import Ring
from sim.parts.bearing.from_spec import geometry_from_spec
from sim.parts.bearing.spall import Contact, contact

WIDTH = Param(
    name="width",
    unit="m",
    default=1e-3,
    low=0.0,
    high=1e-2,
    sentence="Length of the spall along the rolling direction (arc).",
    scale="log",
)
DEPTH = Param(
    name="depth",
    unit="m",
    default=1e-4,
    low=0.0,
    high=1e-3,
    sentence="Depth of its floor; small spalls never let the ball down to it.",
    scale="log",
)
PITCH = Param(
    name="pitch_diameter",
    unit="m",
    default=0.04,
    low=1e-3,
    high=5.0,
    sentence="Pitch diameter, which turns lengths to angles; the bearing's own where its geometry has one.",
    scale="log",
)
SAME_PITCH = 0.01
"""Makers' pitch diameters of one designation differ that much."""
WIDEST_RAD = 1.0
"""A pit that takes more than this of a circle is no spall: the ball would fall into a different race."""


def angle_param(sentence: str, default: float = 0.0) -> Param:
    """An angle of a full turn to either side."""
    return Param(name="angle", unit="rad", default=default, low=-6.2832, high=6.2832, sentence=sentence)


def pitch_values(machine: MachineSpec, bearing: str) -> Values:
    """Pitch diameter from the bearing's geometry, when it has lengths."""
    geometry = geometry_from_spec(next(b for b in machine.bearings if b.name == bearing), field=f"bearings.{bearing}")
    return {} if geometry.pitch_diameter_m is None else {PITCH.name: geometry.pitch_diameter_m}


def site_balls(site: SiteContext) -> int:
    """Number of balls of the site's bearing."""
    return geometry_from_spec(next(b for b in site.machine.bearings if b.name == site.site)).balls


def contact_of(law: BallLaw, values: Values, site: SiteContext, ring: Ring) -> Contact:
    """Radii of the contact with a ring; SpecError when the pitch diameter is not the bearing's."""
    bearing = next(b for b in site.machine.bearings if b.name == site.site)
    geometry = geometry_from_spec(bearing, field=f"bearings.{bearing.name}")
    pitch, known = values[PITCH.name], geometry.pitch_diameter_m
    if known is not None and abs(pitch - known) > SAME_PITCH * known:
        message = "is not that of the bearing's own geometry (leave it out)"
        field = f"{PITCH.name} of the spall at {site.site}"
        raise SpecError(Problem(field=field, message=message, given=pitch, allowed=f"{known:.6g}", unit="m"))
    return contact(pitch_m=pitch, ratio=geometry.diameter_ratio, ratio_cos=law.diameter_ratio_cos, ring=ring)


def width_rad(values: Values, radius_m: float, site: SiteContext, key: str) -> float:
    """Angle of the spall on a circle of the race or the ball, rad; SpecError when it is no spall any more."""
    angle = values["width"] / radius_m
    if angle > WIDEST_RAD:
        raise SpecError(
            Problem(
                field=f"{key}@{site.site}.width",
                message=f"takes {angle:.3g} rad of a circle of radius {1e3 * radius_m:.3g} mm",
                given=values["width"],
                allowed=f"up to {WIDEST_RAD * radius_m:.3g}",
                unit="m",
            )
        )
    return angle


def depth_m(values: Values, at: Contact, site: SiteContext, key: str) -> float:
    """Depth, m; SpecError when the spall is deeper than half the ball's radius."""
    if values["depth"] > 0.5 * at.ball_m:
        raise SpecError(
            Problem(
                field=f"{key}@{site.site}.depth",
                message=f"is more than half the radius of the ball, {1e3 * at.ball_m:.3g} mm",
                given=values["depth"],
                allowed=f"up to {0.5 * at.ball_m:.3g}",
                unit="m",
            )
        )
    return values["depth"]


def faint_pit(values: Values) -> Values:
    """The same pit with next to no depth."""
    return {**values, DEPTH.name: FAINT * values.get(DEPTH.name, DEPTH.default)}
