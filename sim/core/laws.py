"""The named laws that terms modify before they become contact elements: mesh, ball contact, rotor.

Terms are pure functions from one law to the next; `Term.order` says who comes first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from sim.core.response import FloatArray

TOOTH_POINTS = 129
"""Samples of a tooth's shape over its path of contact (0.8 %)."""
RACE_POINTS = 2048
"""Samples of a race profile over one turn (0.18 degrees)."""


def _zeros(n: int) -> FloatArray:
    return np.zeros(n)


@dataclass(frozen=True, kw_only=True)
class MeshLaw:
    """A mesh before it becomes an element.

    `kind` is decided by the part that built it: `total_rows` (rows, n) N/m over `centre_errors_m` (rows,) for a
    total curve, or the pair arrays for a sum over tooth pairs. Tooth arrays have one entry a tooth.
    """

    name: str
    pinion: str
    gear: str
    teeth: tuple[int, int]
    base_radii_m: tuple[float, float]
    centre_distance_m: float
    working_angle_rad: float
    damping_ns_per_m: float
    backlash_m: float | None
    error_mean_m: float
    error_amplitude_m: float
    error_phase_rad: float
    centre_errors_m: FloatArray
    total_rows: FloatArray | None
    pair_rows: FloatArray | None
    """(tilts, rows, points) N/m over normalised position 0..1 between start and end of action."""
    pair_ratios: FloatArray | None
    """(rows,) contact ratio: the length of engagement in base pitches."""
    tilts_rad: FloatArray = field(default_factory=lambda: _zeros(1))
    pinion_tooth_gap_m: FloatArray = field(default_factory=lambda: _zeros(1))
    gear_tooth_gap_m: FloatArray = field(default_factory=lambda: _zeros(1))
    runout_pinion_m: float = 0.0
    runout_pinion_phase_rad: float = 0.0
    runout_gear_m: float = 0.0
    runout_gear_phase_rad: float = 0.0
    true_centre_line: bool = False
    follow_gear_shaft: bool = True
    pinion_sense: float = 1.0
    """Sense in which the pinion's run-out turns: +1 from x to y, -1 from y to x. The defaults are the seed's."""
    gear_sense: float = -1.0
    flank: float = 1.0
    """Side on which a positive force pushes the pinion: +1 towards +y (the seed), -1 towards -y."""
    drive: float = 1.0
    """+1: the flanks on which the pinion drives carry the load; -1: those on which the gear drives."""
    gear_first_tooth: int = 0
    """Number of the gear's tooth that enters at mesh phase 0; the pinion's is tooth 0."""
    mean_force_n: float = 0.0
    """Magnitude of the mean force on the line of action, from the torques."""
    pinion_shape: FloatArray | None = None
    """(teeth, 2, TOOTH_POINTS) over the path of contact from entry to exit: compliance a tooth has gained, m/N, and
    metal missing from its loaded flank, m. None: every tooth is sound."""
    gear_shape: FloatArray | None = None
    slices: int = 1
    """Slices of the face; more than one needs flanks that may part (backlash)."""
    face_width_m: float = 0.0
    """Common face width of both gears; set where there are slices."""
    lead_rad: float = 0.0
    """Lead misalignment in the plane of action: how much farther the flanks stand apart per metre along z."""


@dataclass(frozen=True, kw_only=True)
class BallLaw:
    """Ball contacts of one bearing before they become an element.

    Profiles are extra gaps in m over the angle, `RACE_POINTS` samples a turn; positive opens the contact. The outer
    race's angle counts from x on the ring at t = 0, the inner's on its own ring; the ball's is that by which the first
    ball has turned towards its outer contact, and its table holds what both of its contacts lose.
    """

    name: str
    body: str
    balls: int
    diameter_ratio_cos: float
    """(d_b/d_m) cos(contact angle)."""
    stiffness_n_per_m15: float
    gap_m: float
    cage_phase_rad: float
    sense: float = 1.0
    """Sense in which cage and inner ring turn: +1 from x to y, -1 from y to x."""
    cage_slip: float = 0.0
    outer_creep: float = 0.0
    """Turns of the outer ring per turn of the shaft, in its sense."""
    ball_spin_ratio: float = 0.0
    """Turns of a ball about its own axis per turn of the shaft, outer ring at rest."""
    ball_phase_rad: float = 0.0
    outer_profile_m: FloatArray | None = None
    inner_profile_m: FloatArray | None = None
    ball_profile_m: FloatArray | None = None


@dataclass(frozen=True, kw_only=True)
class SupportLaw:
    """How an outer ring is held: direct springs to ground, or released (a term takes over)."""

    bearing: str
    stiffness_x_n_per_m: float
    stiffness_y_n_per_m: float
    damping_x_ns_per_m: float
    damping_y_ns_per_m: float
    housing_mass_kg: float = 0.0
    """Above zero: the springs hold a housing mass instead, and a wall contact joins ring and housing."""
    released: bool = False


@dataclass(frozen=True, kw_only=True)
class AddedSpring:
    """A spring and damper between two degrees of freedom, or from one to ground (`b` None)."""

    a: str
    b: str | None = None
    stiffness: float = 0.0
    """N/m between displacements, N m/rad between angles."""
    damping: float = 0.0
    """N s/m between displacements, N m s/rad between angles."""


@dataclass(frozen=True, kw_only=True)
class AddedMass:
    """A degree of freedom that a term adds, with what joins it to the machine; `held` checks that something does.

    `name` is the DOF, part first and axis last: `bearing1.mode.y`. Masses are added after all parts of the machine and
    in the order in which terms added them; springs may join any DOF of the machine or of a mass added before.
    """

    name: str
    mass: float
    """kg, or kg m^2 for an angle."""
    springs: tuple[AddedSpring, ...]


@dataclass(frozen=True, kw_only=True)
class AddedWeight:
    """An acceleration in m/s^2 that pulls at every displacement of the named parts: m a, constant from t = 0 on."""

    parts: tuple[str, ...]
    x_m_per_s2: float
    y_m_per_s2: float


@dataclass(frozen=True, kw_only=True)
class Laws:
    """All named laws of a machine; terms return a changed copy."""

    meshes: Mapping[str, MeshLaw]
    balls: Mapping[str, BallLaw]
    supports: Mapping[str, SupportLaw]
    masses: tuple[AddedMass, ...] = ()
    weights: tuple[AddedWeight, ...] = ()
