"""Shafts and the rigid bodies they carry."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from sim.core.spec.base import Name, Positive, SpecModel


class ShaftSegment(SpecModel):
    """A uniform stretch of a flexible shaft."""

    length_m: Annotated[float, Field(ge=1e-3, le=20)]
    diameter_m: Annotated[float, Field(ge=1e-3, le=2)]
    bore_m: Annotated[float, Field(ge=0, le=2)] = 0.0
    """Diameter of a hollow shaft's bore."""
    youngs_modulus_pa: Annotated[float, Field(ge=1e8, le=1e12)] = 2.06e11
    poisson_ratio: Annotated[float, Field(ge=0, lt=0.5)] = 0.3
    density_kg_per_m3: Annotated[float, Field(ge=500, le=25000)] = 7850.0


class ShaftSpec(SpecModel):
    """A shaft: its torsion between the end (motor or brake) and the gear, and its length; rigid unless segmented."""

    name: Name
    end_inertia_kg_m2: Annotated[float, Field(ge=1e-12, le=1e4)] | None = None
    """Inertia at the driving or driven end; none: the shaft has no torsional end mass."""
    torsional_stiffness_nm_per_rad: Annotated[float, Field(ge=1e-6, le=1e10)] | None = None
    torsional_damping_nms_per_rad: Annotated[float, Field(ge=0, le=1e8)] = 0.0
    length_m: Annotated[float, Field(ge=1e-4, le=20)] = 0.26
    diameter_m: Annotated[float, Field(ge=1e-4, le=2)] | None = None
    """Used to derive stiffness that is not given."""
    shear_modulus_pa: Annotated[float, Field(ge=1e5, le=1e12)] = 8.0e10
    segments: Annotated[list[ShaftSegment], Field(max_length=32)] = Field(default_factory=list)
    """From one end to the other along z: the shaft then bends (Timoshenko beam elements). None: rigid."""
    seats: Annotated[dict[Name, Annotated[float, Field(ge=0, le=20)]], Field(max_length=64)] = Field(
        default_factory=dict
    )
    """Where its gears, bodies and bearings sit on a segmented shaft: name to distance from its start, m."""
    end_position_m: Annotated[float, Field(ge=0, le=20)] = 0.0
    """Where the end inertia sits on a segmented shaft."""
    longest_element_m: Annotated[float, Field(ge=2e-3, le=20)] | None = None
    """Longest beam element; none: nodes only at seats and where the segments change."""
    bending_damping_s: Annotated[float, Field(ge=0, le=1e-2)] = 0.0
    """Damping over stiffness of the beam elements, in the fixed frame."""
    gyroscopic: bool = True
    """Whether gyroscopic moments at the nominal speed act on a segmented shaft."""


class BodySpec(SpecModel):
    """A rigid mass without teeth: a disc on a shaft, or a mass on a spring to ground."""

    name: Name
    mass_kg: Annotated[float, Field(ge=1e-6, le=1e5)]
    shaft: Name | None = None
    inertia_kg_m2: Annotated[float, Field(ge=1e-12, le=1e5)] | None = None
    """Polar inertia; needs `shaft`."""
    diametral_inertia_kg_m2: Annotated[float, Field(ge=1e-12, le=1e5)] | None = None
    """Against tilting, on a segmented shaft; none: half of the polar inertia."""
    axes: Literal["x", "y", "xy"] = "xy"
    stiffness_x_n_per_m: Annotated[float, Field(ge=0, le=1e13)] = 0.0
    """Spring to ground."""
    stiffness_y_n_per_m: Annotated[float, Field(ge=0, le=1e13)] = 0.0
    damping_x_ns_per_m: Annotated[float, Field(ge=0, le=1e9)] = 0.0
    damping_y_ns_per_m: Annotated[float, Field(ge=0, le=1e9)] = 0.0


__all__ = ["BodySpec", "Positive", "ShaftSegment", "ShaftSpec"]
