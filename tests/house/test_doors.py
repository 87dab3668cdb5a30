"""The commands that README and CI promise exist."""

from __future__ import annotations

import json
import os
import re
import subprocess

import pytest

from app.cli.main import COMMANDS
from reconcile.kinematics import read_kinematic_spec
from tests.house.project import ROOT

MAKEFILE = (ROOT / "Makefile").read_text(encoding="utf-8")
README = (ROOT / "README.md").read_text(encoding="utf-8")
PROMISED = ("run", "test", "fast", "lint", "bench", "cost", "paper", "proof", "openapi", "lock", "clean", "setup")


def _targets() -> set[str]:
    return set(re.findall(r"^([a-z0-9-]+):", MAKEFILE, re.MULTILINE))


@pytest.mark.parametrize("target", PROMISED)
def test_the_door_exists_and_is_no_file(target):
    assert target in _targets()
    assert re.search(rf"^\.PHONY:.*\b{target}\b", MAKEFILE, re.MULTILINE)


def test_every_door_is_told_to_make_as_no_file():
    phony = set(re.findall(r"^\.PHONY:(.*)", MAKEFILE, re.MULTILINE)[0].split())
    assert _targets() == phony


def test_readme_names_only_doors_and_commands_that_exist():
    assert set(re.findall(r"\bmake ([a-z0-9-]+)\b", README)) <= _targets()
    assert set(re.findall(r"bin/sideband ([a-z]+)", README)) <= set(COMMANDS)


def test_readme_needs_no_splitting_of_words_which_zsh_does_not():
    assert not re.search(r"^\$\w+ ", README, re.MULTILINE)


def test_the_drawing_in_readme_is_one():
    (drawing,) = re.findall(r"```json\n(.+?)```", README, re.DOTALL)
    found = read_kinematic_spec(json.loads(drawing))
    assert [bearing.name for bearing in found.bearings] == ["drive_end"]


def test_ci_runs_the_test_door_and_nothing_else():
    script = ROOT / ".ci" / "run"
    assert os.access(script, os.X_OK)
    commands = [line for line in script.read_text(encoding="utf-8").splitlines() if line and not line.startswith("#")]
    assert commands[0] == "set -euo pipefail"
    assert commands[-1] == "make test"
    assert sum("make " in line for line in commands) == 1


def _make(*asked):
    # These tests may themselves run under make, whose settings would be inherited.
    outside = {name: value for name, value in os.environ.items() if not name.startswith(("MAKE", "MFLAGS"))}
    return subprocess.run(["make", *asked], cwd=ROOT, env=outside, capture_output=True, text=True, check=False)


def test_help_lists_every_door_that_says_what_it_does():
    told = _make("-s", "help").stdout.splitlines()
    assert [line.split()[0] for line in told] == sorted(re.findall(r"^(\S+):.*## ", MAKEFILE, re.MULTILINE))


def test_make_accepts_its_file():
    told = _make("-n", "test")
    assert told.returncode == 0, told.stderr
    assert "pytest" in told.stdout.splitlines()[-1], "the test runner's closing line must come last"
    for tool in ("ruff check", "ruff format --check", "mypy", "lint-imports"):
        assert tool in told.stdout
