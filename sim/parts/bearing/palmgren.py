"""Palmgren's line contact, used between an outer ring and its housing bore.

delta = 3.83e-5 P^0.9 / L^0.8 with delta and L in mm and P in N: Palmgren, Ball and Roller Bearing Engineering,
3rd ed., 1959; quoted with this factor in Harris & Kotzalas, Rolling Bearing Analysis, 5th ed., 2006, chapter 6, and
in eq. (32) of the seed paper. All arguments here are SI; the millimetres stay inside.
"""

from __future__ import annotations

FACTOR_MM = 3.83e-5
LOAD_EXPONENT = 10 / 9
"""P grows with delta^(10/9)."""
_MM_PER_M = 1e3


def line_coefficient_n_per_m109(length_m: float) -> float:
    """c of P = c delta^(10/9), delta in m, N/m^(10/9), for a contact `length_m` long."""
    scale_mm = _MM_PER_M * (length_m * _MM_PER_M) ** 0.8 / FACTOR_MM
    return float(scale_mm**LOAD_EXPONENT)


def line_force_n(penetration_m: float, length_m: float) -> float:
    """Contact force, N; zero without penetration."""
    if penetration_m <= 0:
        return 0.0
    return line_coefficient_n_per_m109(length_m) * float(penetration_m**LOAD_EXPONENT)


def line_penetration_m(force_n: float, length_m: float) -> float:
    """Penetration under a force, m; zero without force."""
    if force_n <= 0:
        return 0.0
    return float(FACTOR_MM * force_n**0.9 / (length_m * _MM_PER_M) ** 0.8) / _MM_PER_M


def line_tangent_n_per_m(penetration_m: float, length_m: float) -> float:
    """dP/d(delta), N/m; zero without penetration."""
    if penetration_m <= 0:
        return 0.0
    return LOAD_EXPONENT * line_coefficient_n_per_m109(length_m) * float(penetration_m ** (LOAD_EXPONENT - 1))
