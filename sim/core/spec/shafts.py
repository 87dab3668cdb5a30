"""Shafts and the rigid bodies they carry."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from sim.core.spec.base import Name, NonNegative, Positive, SpecModel


class ShaftSpec(SpecModel):
    """A shaft: its torsion between the end (motor or brake) and the gear, and its length."""

    name: Name
    end_inertia_kg_m2: Annotated[float, Field(ge=1e-12, le=1e4)] | None = None
    """Inertia at the driving or driven end; none: the shaft has no torsional end mass."""
    torsional_stiffness_nm_per_rad: Annotated[float, Field(gt=0, le=1e10)] | None = None
    torsional_damping_nms_per_rad: Annotated[float, Field(ge=0, le=1e8)] = 0.0
    length_m: Annotated[float, Field(gt=0, le=20)] = 0.26
    diameter_m: Annotated[float, Field(gt=0, le=2)] | None = None
    """Used to derive stiffness that is not given."""
    shear_modulus_pa: Annotated[float, Field(gt=0, le=1e12)] = 8.0e10


class BodySpec(SpecModel):
    """A rigid mass without teeth: a disc on a shaft, or a mass on a spring to ground."""

    name: Name
    mass_kg: Annotated[float, Field(ge=1e-6, le=1e5)]
    shaft: Name | None = None
    inertia_kg_m2: Annotated[float, Field(ge=1e-12, le=1e5)] | None = None
    """Polar inertia; needs `shaft`."""
    axes: Literal["x", "y", "xy"] = "xy"
    stiffness_x_n_per_m: NonNegative = 0.0
    """Spring to ground."""
    stiffness_y_n_per_m: NonNegative = 0.0
    damping_x_ns_per_m: NonNegative = 0.0
    damping_y_ns_per_m: NonNegative = 0.0


__all__ = ["BodySpec", "Positive", "ShaftSpec"]
