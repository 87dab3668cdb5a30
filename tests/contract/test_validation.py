"""Every effect names a check that exists, against something that is not its own code."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from sim.terms import REGISTRY

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("key", REGISTRY.keys())
def test_every_effect_was_checked_and_the_test_is_there(key):
    term = REGISTRY.get(key)
    assert term is not None
    assert term.validation, f"{key} names no check"
    for check in term.validation:
        assert 0.0 <= check.deviation < 1.0
        assert check.source
        name, function = check.test.split("::")
        tree = ast.parse((ROOT / name).read_text())
        assert function in {node.name for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)}, check.test


def test_the_catalogue_is_large_enough_to_diagnose_with():
    known = REGISTRY.keys()
    assert len(known) >= 30
    assert all((ROOT / "docs" / "physics" / f"{key}.md").is_file() for key in known)
