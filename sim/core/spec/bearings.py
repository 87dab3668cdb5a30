"""Bearings, their supports, and the resonators (sensor mounts) on their outer rings."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from sim.core.spec.base import WHOLE, Finite, Name, SpecModel

Stiffness = Annotated[float, Field(ge=0, le=1e13)]
Damping = Annotated[float, Field(ge=0, le=1e9)]
Mass = Annotated[float, Field(ge=1e-6, le=1e4)]


class BallGeometry(SpecModel):
    """Rolling-element geometry. Either both diameters, or their ratio when only frequencies matter."""

    balls: Annotated[int, Field(ge=3, le=64, strict=False), WHOLE]
    ball_diameter_m: Annotated[float, Field(ge=1e-5, le=0.5)] | None = None
    pitch_diameter_m: Annotated[float, Field(ge=1e-4, le=5)] | None = None
    diameter_ratio: Annotated[float, Field(ge=1e-3, lt=0.9)] | None = None
    """d_b/d_m, when the diameters are not given."""
    contact_angle_deg: Annotated[float, Field(ge=0, le=50)] = 0.0
    inner_groove_ratio: Annotated[float, Field(gt=0.5, le=0.6)] = 0.515
    """Groove radius over ball diameter, inner race."""
    outer_groove_ratio: Annotated[float, Field(gt=0.5, le=0.6)] = 0.525
    width_m: Annotated[float, Field(ge=1e-5, le=1)] | None = None


class SupportSpec(SpecModel):
    """Outer ring to ground (the housing)."""

    stiffness_x_n_per_m: Stiffness
    stiffness_y_n_per_m: Stiffness
    damping_x_ns_per_m: Damping = 0.0
    damping_y_ns_per_m: Damping = 0.0


class BearingSpec(SpecModel):
    """A ball bearing between a body of a shaft and the ground."""

    name: Name
    body: Name
    """The gear or body it carries."""
    catalogue: Annotated[str, Field(pattern=r"^[A-Za-z0-9][A-Za-z0-9 ./-]{0,31}$")] | None = None
    """A designation of the bearing catalogue, or `geometry`."""
    geometry: BallGeometry | None = None
    contact_stiffness_n_per_m15: Annotated[float, Field(ge=1e-3, le=1e13)] | None = None
    """Ball-race stiffness k_re; none: Hertz contact from the geometry."""
    radial_clearance_m: Annotated[float, Field(ge=-1e-4, le=1e-3)] = 0.0
    """c_o of seed eq. (12): gap of each ball when centred (half the diametral clearance); negative is preload."""
    inner_mass_kg: Mass
    outer_mass_kg: Mass
    shaft_stiffness_n_per_m: Annotated[float, Field(ge=1e-3, le=1e13)]
    """Between inner ring and body, k_s."""
    shaft_damping_ns_per_m: Damping = 0.0
    support: SupportSpec
    cage_phase_rad: Finite = 0.0
    bore_damping_ns_per_m: Damping | None = None
    """c_N of the ring striking its bore, where a clearance term does not give its own."""


class ResonatorSpec(SpecModel):
    """A sensor mount: a mass on a spring and damper on a bearing's outer ring, seed eq. (2), last line."""

    name: Name
    bearing: Name
    axis: Literal["x", "y"] = "y"
    mass_kg: Mass
    stiffness_n_per_m: Annotated[float, Field(ge=1e-3, le=1e13)]
    damping_ns_per_m: Damping = 0.0
