"""What both clearance variants declare alike: parameters, outputs, coordinates, lines."""

from __future__ import annotations

from functools import lru_cache

from sim.core.elements import Coordinate, Output, flat
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.core.terms import SiteContext, Values
from sim.parts.bearing.clearances import loosest_seat_m
from sim.parts.bearing.size import bearing_size
from sim.parts.rotor import at_speed

CONTEXT = 1
SOUGHT_DAMPING = (1e3, 3e5)
"""Collision damping, N s/m, of which drawings say nothing: the paper's Table 1 has 2e5, its reference solutions 2e3 and
300. Below some 5e3 a fit shows the same whatever it is (levels move by less than 0.3 dB), at 2e5 it rings no more."""
SOUGHT_FRICTION_SPEED = (1e-3, 1e-1)
"""Speed of the regularised friction, m/s: a number of the model, of which nothing is known of any seat. Contacts give
way and lose energy before they slide (R. D. Mindlin, "Compliance of elastic bodies in contact", J. Appl. Mech. 16
(1949) 259-268, for the giving way); a friction that is full only at such speeds loses it too. At the 1e-4 of the
paper's reference solutions a ring that is all but at rest sticks and slips, and rattles by 30 dB more. Chosen by cases
of the proof, whose generator lies within (docs/decisions/reconcile-rattle.md)."""
WALL_PARAMS = (
    Param(
        name="gap",
        unit="m",
        default=2e-5,
        low=0.0,
        high=5e-4,
        sentence="Radial clearance between outer ring and housing bore.",
        scale="log",
    ),
    Param(
        name="damping",
        unit="N*s/m",
        default=2e3,
        low=0.0,
        high=1e6,
        sentence="Viscous damping of the collision, c_N.",
        scale="log",
        sought=SOUGHT_DAMPING,
    ),
    Param(
        name="friction", unit="1", default=0.1, low=0.0, high=1.0, sentence="Coulomb friction between ring and bore."
    ),
    Param(
        name="length",
        unit="mm",
        default=15.0,
        low=1.0,
        high=500.0,
        sentence="Width of the ring in the bore, L_2 of Palmgren's formula, in mm as it is published.",
    ),
    Param(
        name="friction_speed",
        unit="m/s",
        default=1e-4,
        low=1e-6,
        high=1e-1,
        sentence="Sliding speed at which the regularised friction has 76 % of its full value.",
        scale="log",
        sought=SOUGHT_FRICTION_SPEED,
    ),
)
OUTPUTS = (
    Output(name="contact", quantity="state", unit="1"),
    Output(name="normal_force", quantity="force", unit="N"),
    Output(name="friction_force", quantity="force", unit="N"),
)


PALMGREN = 3.83e-5
"""delta = 3.83e-5 P^0.9 / L^0.8 in mm and N (Palmgren, Ball and Roller Bearing Engineering, 3rd ed., 1959)."""


def wall_parameters(values: Values) -> FloatArray:
    """Parameter array of the wall kernel: the declared parameters, then L^0.8 / 3.83e-5."""
    return flat(*(values[p.name] for p in WALL_PARAMS), values["length"] ** 0.8 / PALMGREN)


def bore_values(machine: MachineSpec, bearing: str) -> Values:
    """Collision damping from the bearing's specification, when it has one."""
    damping = next(b.bore_damping_ns_per_m for b in machine.bearings if b.name == bearing)
    return {} if damping is None else {"damping": damping}


def beside_resonance(machine: MachineSpec) -> MachineSpec:
    """At a speed where the loose ring does not mainly move the machine away from a resonance."""
    return at_speed(machine, 40.0)


def fit_cautions(values: Values, site: SiteContext) -> tuple[str, ...]:
    """A sentence when the gap is wider than any fit of a ring of that size; none where its size is unknown."""
    size = bearing_size(next(b for b in site.machine.bearings if b.name == site.site))
    if size is None or values["gap"] <= (loosest := loosest_seat_m(size.outside_m)):
        return ()
    ring = f"a ring of {'about ' if size.estimated else ''}{1e3 * size.outside_m:.3g} mm"
    gap = f"radial fit clearance {1e6 * values['gap']:.4g} um"
    return (f"{site.site}: {gap} is above {1e6 * loosest:.3g} um, the loosest seat (H11/h11, ISO 286-1) of {ring}",)


def ring_wall_coordinates(bearing: str, *, against: str | None) -> tuple[Coordinate, ...]:
    """Outer ring relative to ground, or to the DOF group `against` (a housing)."""
    result = []
    for axis in ("x", "y"):
        weights = [(f"{bearing}.outer.{axis}", 1.0)]
        if against is not None:
            weights.append((f"{against}.{axis}", -1.0))
        result.append(Coordinate(name=f"{bearing}.wall.{axis}", unit="m", weights=tuple(weights)))
    return tuple(result)


def mesh_sidebands(site: SiteContext, key: str, *, harmonics: int, sides: int) -> tuple[Line, ...]:
    """Mesh harmonics modulated by the passing balls of this bearing: j f_m +- k f_o."""
    meshes = tuple(name for name in site.bases_hz if name.startswith("f_m"))
    return _beside(site.site, f"f_o{site.index}", meshes, key, harmonics, sides)


@lru_cache(maxsize=512)
def _beside(
    component: str, base: str, meshes: tuple[str, ...], key: str, harmonics: int, sides: int
) -> tuple[Line, ...]:
    return tuple(
        Line(orders=((mesh, j), (base, k)), component=component, mechanism=key, family="outer")
        for mesh in meshes
        for j in range(1, harmonics + 1)
        for k in range(-sides, sides + 1)
        if k != 0
    )


def clearance_lines(site: SiteContext, key: str) -> tuple[Line, ...]:
    """Multiples of f_o (the seed reports up to the 18th) and their sidebands of the mesh harmonics."""
    base = f"f_o{site.index}"
    own = tuple(Line(orders=((base, k),), component=site.site, mechanism=key, family="outer") for k in range(1, 21))
    return own + mesh_sidebands(site, key, harmonics=8, sides=9)
