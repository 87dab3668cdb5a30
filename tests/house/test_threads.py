"""Tests use one thread of linear algebra each: more would only wait for one another."""

from __future__ import annotations

from tests.conftest import TOO_LATE


def test_threads_are_settled_before_linear_algebra_is_loaded() -> None:
    assert not TOO_LATE, "a plugin of pytest loads numpy: switch it off in pyproject.toml"
