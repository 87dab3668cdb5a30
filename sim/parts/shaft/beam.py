"""A Timoshenko beam element as two springs over its four coordinates, with its mass lumped at its ends.

Coordinates of a node are the deflection w and the slope of the section, positive like dw/dz, in the xz and in the yz
plane alike. The static element of Friedman & Kosmatka 1993 (Computers & Structures 47(3), 473-481), which is exact for
end loads, is the sum of two rank-one parts:
    K = E I/L a a' + 12 E I/(L (1 + Phi)) b b',  Phi = 12 E I/(kappa G A L^2),
    a = (0, -1, 0, 1),  b = (1/L, 1/2, -1/L, 1/2)
on (w1, s1, w2, s2). Masses are lumped because the machine's mass matrix is diagonal: half of rho A L and of the rotary
inertia rho I L at each end.
"""

from __future__ import annotations

from dataclasses import dataclass

from sim.parts.shaft.section import Section

Weights = tuple[float, float, float, float]


@dataclass(frozen=True, kw_only=True)
class BeamElement:
    """Springs (weights on w1, s1, w2, s2; stiffness) and what is lumped at each end."""

    springs: tuple[tuple[Weights, float], ...]
    end_mass_kg: float
    end_rotary_kg_m2: float
    """Diametral; the polar inertia that the gyroscopic moment sees is twice as much."""


def beam_element(section: Section, length_m: float) -> BeamElement:
    """Element of a length in m."""
    bending = section.bending_nm2 / length_m
    phi = 12.0 * section.bending_nm2 / (section.shear_n * length_m**2)
    sheared = 12.0 * bending / (1.0 + phi)
    return BeamElement(
        springs=(
            ((0.0, -1.0, 0.0, 1.0), bending),
            ((1.0 / length_m, 0.5, -1.0 / length_m, 0.5), sheared),
        ),
        end_mass_kg=0.5 * section.mass_kg_per_m * length_m,
        end_rotary_kg_m2=0.5 * section.rotary_kg_m * length_m,
    )
