"""Palmgren's line contact: units, inverse, tangent."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.parts.bearing.palmgren import (
    line_coefficient_n_per_m109,
    line_force_n,
    line_penetration_m,
    line_tangent_n_per_m,
)


def test_units_of_the_printed_formula() -> None:
    """1000 N on 10 mm: 3.83e-5 * 1000^0.9 / 10^0.8 mm = 3.042 um."""
    assert line_penetration_m(1000.0, 0.010) == pytest.approx(3.83e-5 * 501.187234 / 6.30957344 * 1e-3, rel=1e-8)
    assert line_penetration_m(1000.0, 0.010) == pytest.approx(3.0422e-6, rel=1e-3)


@pytest.mark.slow
@given(st.floats(1e-3, 1e6), st.floats(1e-3, 0.2))
def test_force_inverts_penetration(force_n: float, length_m: float) -> None:
    assert line_force_n(line_penetration_m(force_n, length_m), length_m) == pytest.approx(force_n, rel=1e-9)


@given(st.floats(1e-8, 1e-4), st.floats(1e-3, 0.2))
def test_tangent_is_the_derivative(penetration_m: float, length_m: float) -> None:
    h = 1e-4 * penetration_m
    numeric = (line_force_n(penetration_m + h, length_m) - line_force_n(penetration_m - h, length_m)) / (2 * h)
    assert line_tangent_n_per_m(penetration_m, length_m) == pytest.approx(numeric, rel=1e-6)


def test_no_penetration_no_force() -> None:
    for value in (0.0, -1e-6):
        assert line_force_n(value, 0.015) == 0.0
        assert line_tangent_n_per_m(value, 0.015) == 0.0
        assert line_penetration_m(value, 0.015) == 0.0


def test_coefficient_reproduces_the_reference_form() -> None:
    """The form of seed eq. (32): ((r - delta)[mm] L^0.8 / 3.83e-5)^(10/9)."""
    depth_m, length_m = 2e-6, 0.015
    printed = (depth_m * 1e3 * 15**0.8 / 3.83e-5) ** (10 / 9)
    assert line_coefficient_n_per_m109(length_m) * depth_m ** (10 / 9) == pytest.approx(printed, rel=1e-12)
