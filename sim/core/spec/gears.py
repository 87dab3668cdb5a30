"""Gears and meshes."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from sim.core.spec.base import WHOLE, Finite, Name, SpecModel


class GearSpec(SpecModel):
    """A spur or helical gear: geometry, material, and mass or the density to derive it from."""

    name: Name
    shaft: Name
    teeth: Annotated[int, Field(ge=6, le=2000, strict=False), WHOLE]
    module_m: Annotated[float, Field(ge=1e-4, le=0.1)]
    """A module of 2 mm is 0.002. Of a helical gear: the transverse module, normal module over cos(helix angle)."""
    pressure_angle_deg: Annotated[float, Field(ge=10, le=35)] = 20.0
    """In the transverse section: tan of it is tan of the normal one over cos(helix angle)."""
    helix_angle_deg: Annotated[float, Field(ge=-45, le=45)] = 0.0
    """On the reference circle, positive right-handed; mates have opposite hands. 0: spur."""
    addendum_coefficient: Annotated[float, Field(ge=1e-2, le=1.5)] = 1.0
    """This and the other coefficients are in normal modules."""
    tip_clearance_coefficient: Annotated[float, Field(ge=0, le=0.6)] = 0.25
    profile_shift_coefficient: Annotated[float, Field(ge=-1, le=1.5)] = 0.0
    face_width_m: Annotated[float, Field(ge=1e-4, le=2)]
    bore_radius_m: Annotated[float, Field(ge=0, le=10)] | None = None
    """Default: 0.3 of the pitch radius."""
    fillet_radius_coefficient: Annotated[float, Field(ge=0, le=0.6)] = 0.38
    """Root fillet radius over module (ISO 53 profile A: 0.38)."""
    youngs_modulus_pa: Annotated[float, Field(ge=1e8, le=1e12)] = 2.06e11
    poisson_ratio: Annotated[float, Field(ge=0, lt=0.5)] = 0.3
    density_kg_per_m3: Annotated[float, Field(ge=500, le=25000)] = 7850.0
    mass_kg: Annotated[float, Field(ge=1e-6, le=1e5)] | None = None
    inertia_kg_m2: Annotated[float, Field(ge=1e-12, le=1e5)] | None = None
    translates: bool = True
    """False: the gear turns on a rigid support and has no radial motion."""
    stiffness_x_n_per_m: Annotated[float, Field(ge=0, le=1e13)] = 0.0
    """Spring from the gear body straight to ground, beside any bearings."""
    stiffness_y_n_per_m: Annotated[float, Field(ge=0, le=1e13)] = 0.0
    damping_x_ns_per_m: Annotated[float, Field(ge=0, le=1e9)] = 0.0
    damping_y_ns_per_m: Annotated[float, Field(ge=0, le=1e9)] = 0.0


class TransmissionError(SpecModel):
    """e(phi) = mean + amplitude sin(z phi + phase): seed eq. (15) over the shaft angle."""

    mean_m: Annotated[float, Field(ge=-1e-3, le=1e-3)] = 0.0
    amplitude_m: Annotated[float, Field(ge=0, le=1e-3)] = 0.0
    phase_rad: Finite = 0.0


class MeshTable(SpecModel):
    """A total mesh stiffness of the user's own: rows over centre-distance error, columns over mesh phase j/n."""

    centre_distance_error_m: Annotated[list[Annotated[float, Field(ge=-1, le=1)]], Field(min_length=1, max_length=201)]
    stiffness_n_per_m: Annotated[
        list[Annotated[list[Annotated[float, Field(ge=1e-3, le=1e13)]], Field(min_length=2, max_length=8192)]],
        Field(min_length=1, max_length=201),
    ]


class MeshSpec(SpecModel):
    """Two gears in mesh. The first is the pinion side in all signs (see docs/conventions.md)."""

    name: Name
    pinion: Name
    gear: Name
    damping_ns_per_m: Annotated[float, Field(ge=0, le=1e8)] | None = None
    """Viscous mesh damping c_t; none: from `damping_ratio`."""
    damping_ratio: Annotated[float, Field(ge=0, le=2)] = 0.05
    backlash_m: Annotated[float, Field(ge=0, le=5e-3)] | None = None
    """Total backlash on the line of action at the installed centre distance; none: the flanks never part (the seed)."""
    transmission_error: TransmissionError = TransmissionError()
    centre_distance_m: Annotated[float, Field(ge=1e-4, le=50)] | None = None
    """Installed centre distance; none: the standard one."""
    centre_distance_form: Literal["printed", "true"] = "printed"
    """`printed`: seed eq. (17); `true`: centre line tilted by the working pressure angle from the line of action."""
    follow_gear_shaft: bool = True
    """Whether the driven shaft's motion counts in the centre distance (the seed's assumption 5 drops it)."""
    line_of_action: Literal["y", "rotated"] = "y"
    """`y`: force along y only (the seed); `rotated`: turned by the working pressure angle into x and y."""
    offset_angle: bool = False
    """Whether the shaft's tilt (eq. 16) enters the mesh stiffness."""
    tooth_pairs: bool = True
    """Sum over tooth pairs, each with its own stiffness and gap; False: one total curve."""
    root_model: Literal["clamped_at_base", "true_root"] = "clamped_at_base"
    """Where the tooth beam is clamped: on the base circle, or on the root circle with its fillet."""
    table: MeshTable | None = None
    """Total stiffness given by the user; none: potential-energy method."""
