"""Laws as a reader sees them."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.driven.law_words import product
from reconcile.force_law.library import ABOVE, BELOW, CUBIC, FREE_POWER, HERTZ_BELOW, STOPS, Law


@pytest.mark.parametrize(
    ("law", "shape", "shown"),
    [
        (ABOVE, -0.000506, "(z + 0.506 mm)₊"),
        (ABOVE, 2.5e-3, "(z − 2.5 mm)₊"),
        (BELOW, -4e-5, "−(−z + 40 µm)₊"),
        (HERTZ_BELOW, 0.000377, "−(−z − 0.377 mm)₊^1.5"),
        (STOPS, 4e-4, "sgn z (|z| − 0.4 mm)₊"),
        (FREE_POWER, 2.96, "sgn z |z|^2.96"),
        (CUBIC, 0.0, "z³"),
    ],
)
def test_a_gap_is_shown_with_its_unit_and_an_exponent_without(law: Law, shape: float, shown: str) -> None:
    assert replace(law, shape=shape).shown() == shown


def test_a_force_is_a_product_with_its_unit_and_one_sign() -> None:
    """`-2.69e+05 −(−z + 0.685 mm)₊` read as a difference."""
    below = replace(BELOW, shape=-0.000685)
    assert product(-2.69e5, below) == "2.69e+05 N/m · (−z + 0.685 mm)₊"
    assert product(2.69e5, below) == "-2.69e+05 N/m · (−z + 0.685 mm)₊"
    assert product(4.0207e10, CUBIC) == "4.021e+10 N/m^3 · z³"


def test_the_formula_of_the_machine_keeps_metres() -> None:
    assert replace(ABOVE, shape=-0.000506).expression(2.0) == "2*max(x-(-0.000506),0)"
