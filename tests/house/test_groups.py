"""Tests that share what is dear to make run on one worker."""

from __future__ import annotations

import pytest


@pytest.mark.xdist_group("together")
def test_groups_have_an_effect(request: pytest.FixtureRequest) -> None:
    """Where tests are handed out by groups, the plugin's mark must reach the name by which it hands them out."""
    if getattr(request.config.option, "loadgroup", False):
        assert request.node.nodeid.endswith("@together")
    else:
        pytest.skip("tests are not handed out by groups here (`make test` does)")
