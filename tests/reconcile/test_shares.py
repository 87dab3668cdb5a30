"""Shares as sentences have them."""

from __future__ import annotations

import pytest

from reconcile.shares import from_drawing, percent, signed_percent, two_digits


@pytest.mark.parametrize(
    ("share", "signed", "bare"),
    [
        (0.014, "+1.4 %", "1.4 %"),
        (-0.0032, "-0.3 %", "-0.3 %"),
        (-0.0004, "0.0 %", "0.0 %"),
        (0.0, "0.0 %", "0.0 %"),
    ],
)
def test_zero_has_no_sign_and_per_cent_a_space(share: float, signed: str, bare: str) -> None:
    assert (signed_percent(share), percent(share)) == (signed, bare)


def test_no_difference_from_the_drawing_is_told_so() -> None:
    assert [from_drawing(x) for x in (0.0004, 0.0, -0.001)] == ["as in the drawing"] * 2 + ["-0.1 % from the drawing"]


def test_digits() -> None:
    assert (percent(0.2, 0), signed_percent(-0.004, 0), percent(0.00123, 2)) == ("20 %", "0 %", "0.12 %")


def test_two_digits_without_an_exponent() -> None:
    shares = (0.0029, 0.014, 0.03, 0.994, 0.9951, 1.37, 790.0, 1.2e-7, 0.0, -0.12)
    told = ("0.29 %", "1.4 %", "3 %", "99 %", "100 %", "137 %", "79000 %", "0.000012 %", "0 %", "-12 %")
    assert tuple(two_digits(x) for x in shares) == told
