"""What tests of the sensor gate share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from reconcile.gate import levels
from tests.reconcile.remembered import Once


@pytest.fixture(scope="module", autouse=True)
def levels_once() -> Iterator[None]:
    """Most tests hold new signals against the same baselines."""
    with pytest.MonkeyPatch.context() as patched:
        for name in ("channel_levels", "strong_lines"):
            patched.setattr(levels, name, Once(getattr(levels, name)))
        yield
