"""Doors that read the environment: a wrong variable ends them with exit code 2 and a line that names it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.service.parts import ROOT

WORKER, SERVE = ("-m", "workers"), ("-m", "app.cli.main", "serve")
API = ("-c", "import app.wiring as w; w.application()")
LEASE = ("SIDEBAND_LEASE_S", "soon", "a number, 1 to 86400 s")
PORT = ("SIDEBAND_PORT", "80.5", "a whole number, 0 to 65535")


@pytest.mark.slow
@pytest.mark.parametrize(("door", "wrong"), [(WORKER, LEASE), (SERVE, LEASE), (SERVE, PORT), (API, PORT)])
def test_a_wrong_variable(tmp_path: Path, door: tuple[str, ...], wrong: tuple[str, str, str]) -> None:
    name, given, allowed = wrong
    environment = {**os.environ, "SIDEBAND_DATA_DIR": str(tmp_path), "PYTHONPATH": str(ROOT), name: given}
    command = [sys.executable, *door]
    done = subprocess.run(command, env=environment, cwd=ROOT, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 2, done.stderr
    assert f"{name}: is not usable (given '{given}'); allowed: {allowed}" in done.stderr
    assert "Traceback" not in done.stderr and done.stderr.count("\n") == 1
