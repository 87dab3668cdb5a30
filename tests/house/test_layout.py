"""Sizes and places of files: what reviewers would otherwise have to say again and again."""

from __future__ import annotations

import ast
import statistics
from fnmatch import fnmatch
from pathlib import Path

import pytest

from tests.house.project import ROOT, configuration, packages, sources, text, tracked

MEDIAN_LINES, MOST_LINES, MOST_FUNCTION_LINES = 150, 320, 60
ROOMS = {"sim", "signals", "reconcile", "sideband_datasets", "jobs", "store", "workers", "app", "sideband_client"}


def _lines(name: Path) -> int:
    return (text(name) or "").count("\n")


def test_the_median_file_is_small():
    assert statistics.median(_lines(name) for name in sources()) < MEDIAN_LINES


def test_no_file_needs_a_table_of_contents():
    long = {str(name): _lines(name) for name in tracked() if name.suffix == ".py" and _lines(name) > MOST_LINES}
    assert not long


def _functions(name: Path) -> list[tuple[str, int]]:
    tree = ast.parse(text(name) or "")
    kinds = (ast.FunctionDef, ast.AsyncFunctionDef)
    found = [node for node in ast.walk(tree) if isinstance(node, kinds)]
    return [(f"{name}:{f.lineno} {f.name}", (f.end_lineno or f.lineno) - f.lineno + 1) for f in found]


@pytest.mark.slow
def test_functions_are_short():
    found = [entry for name in sources() for entry in _functions(name)]
    long = {label: size for label, size in found if size > MOST_FUNCTION_LINES}
    assert not long


def test_every_package_is_typed_linted_for_imports_and_installed():
    assert set(packages()) >= ROOMS
    rules = configuration()["tool"]
    installed = rules["setuptools"]["packages"]["find"]["include"]
    for package in packages():
        assert package in rules["mypy"]["files"], f"{package} is not type-checked"
        assert package in rules["importlinter"]["root_packages"], f"{package} is under no import rule"
    for room in ROOMS:
        assert any(fnmatch(room, pattern) for pattern in installed), f"{room} would not be installed"


def test_tests_are_not_packages():
    assert not [str(name) for name in tracked() if name.parts[0] == "tests" and name.name == "__init__.py"]


@pytest.mark.parametrize("room", sorted(ROOMS))
def test_every_folder_with_code_is_a_package(room):
    folders = {name.parent for name in sources() if name.parts[0] == room}
    missing = [str(folder) for folder in folders if not (ROOT / folder / "__init__.py").is_file()]
    assert not missing, "without __init__.py these are neither installed nor under the import rules"


def test_nothing_large_or_generated_is_committed():
    suffixes = {".pyc", ".npz", ".wav", ".parquet", ".db", ".log"}
    # atlases are generated, but making them would cost the test command minutes; their own tests say when one is stale
    kept = {Path("tests/proof/atlas"), Path("tests/reconcile/machine/atlas")}
    sizes = {name: (ROOT / name).stat().st_size for name in tracked()}
    large = {str(name): size for name, size in sizes.items() if size > (1_300_000 if name.parent in kept else 600_000)}
    generated = [str(name) for name in tracked() if name.suffix in suffixes and name.parent not in kept]
    assert not large
    assert not generated
