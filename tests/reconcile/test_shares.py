"""Shares as sentences have them."""

from __future__ import annotations

import pytest

from reconcile.shares import percent, signed_percent


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


def test_digits() -> None:
    assert (percent(0.2, 0), signed_percent(-0.004, 0), percent(0.00123, 2)) == ("20 %", "0 %", "0.12 %")
