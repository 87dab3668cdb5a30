"""The import rules hold, and would notice if they did not."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.house.project import ROOT, configuration, sources

PLANTED = {
    "sim/core/params.py": "import sim.parts",
    "sim/core/lines.py": "import sim.presets",
    "sim/presets/gearbox.py": "import sim.solve.api",
    "sim/terms/unbalance.py": "import sim.terms.eccentricity",
    "jobs/limits.py": "import rq",
    "workers/context.py": "import app.settings",
    "sideband_client/errors.py": "import sim.core.errors",
    "proof/machine.py": "import sim.core.errors",
}
"""One forbidden import for each contract, in the order they are declared below."""
BROKEN_BY = {
    "physics": "sim/core/params.py",
    "presets": "sim/core/lines.py",
    "presets-reach": "sim/presets/gearbox.py",
    "terms": "sim/terms/unbalance.py",
    "no-web-below": "jobs/limits.py",
    "rooms": "workers/context.py",
    "client": "sideband_client/errors.py",
    "proof": "proof/machine.py",
}


def _lint(folder: Path, *contracts: str) -> subprocess.CompletedProcess[str]:
    chosen = [part for contract in contracts for part in ("--contract", contract)]
    command = "import sys; from importlinter.cli import lint_imports_command; sys.exit(lint_imports_command())"
    return subprocess.run(
        [sys.executable, "-c", command, "--no-cache", *chosen],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": str(folder), "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("house")
    for name in sources():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, folder / name)
    shutil.copy(ROOT / "pyproject.toml", folder)
    return folder


def test_every_contract_has_a_planted_violation():
    declared = {contract["id"] for contract in configuration()["tool"]["importlinter"]["contracts"]}
    assert declared == set(BROKEN_BY)


@pytest.mark.slow
def test_the_rules_hold(copy):
    told = _lint(copy)
    assert told.returncode == 0, told.stdout + told.stderr


@pytest.mark.slow
@pytest.mark.parametrize("contract", sorted(BROKEN_BY))
def test_a_contract_notices_a_forbidden_import(copy, contract):
    planted = copy / BROKEN_BY[contract]
    before = planted.read_text(encoding="utf-8")
    planted.write_text(before + "\n" + PLANTED[BROKEN_BY[contract]] + "\n", encoding="utf-8")
    try:
        told = _lint(copy, contract)
    finally:
        planted.write_text(before, encoding="utf-8")
    assert told.returncode == 1, told.stdout + told.stderr
    assert "BROKEN" in told.stdout
