"""Shares in sentences: a sign where one is asked for and none for zero, and a space before the sign of per cent."""

from __future__ import annotations


def percent(share: float, digits: int = 1) -> str:
    """`1.4 %`."""
    return f"{abs(share) * 100 if round(share * 100, digits) == 0 else share * 100:.{digits}f} %"


def signed_percent(share: float, digits: int = 1) -> str:
    """`+1.4 %`, `-0.3 %`, `0.0 %`."""
    return percent(share, digits) if round(share * 100, digits) == 0 else f"{share * 100:+.{digits}f} %"


def from_drawing(share: float) -> str:
    """`+1.4 % from the drawing`, `as in the drawing`."""
    return "as in the drawing" if round(share * 100, 1) == 0 else f"{signed_percent(share)} from the drawing"


def two_digits(share: float) -> str:
    """`1.4 %`, `0.29 %`, `3 %`, `137 %`: two digits, or all before the point, and never an exponent."""
    value = 100 * share
    if 1e-4 <= abs(value) < 99.5 or value == 0.0:
        return f"{value:.2g} %"
    return f"{value:.0f} %" if abs(value) >= 1.0 else f"{value:.6f}".rstrip("0").rstrip(".") + " %"
