"""Shares in sentences: a sign where one is asked for and none for zero, and a space before the sign of per cent."""

from __future__ import annotations


def percent(share: float, digits: int = 1) -> str:
    """`1.4 %`."""
    return f"{abs(share) * 100 if round(share * 100, digits) == 0 else share * 100:.{digits}f} %"


def signed_percent(share: float, digits: int = 1) -> str:
    """`+1.4 %`, `-0.3 %`, `0.0 %`."""
    return percent(share, digits) if round(share * 100, digits) == 0 else f"{share * 100:+.{digits}f} %"
