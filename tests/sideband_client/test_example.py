"""The first example of docs/client.md, run as it stands against the real physics."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from app.wiring import application
from tests.service.parts import ROOT, LiveServer, open_parts


@pytest.mark.slow
def test_example_of_the_page_runs(tmp_path: Path) -> None:
    code, _ = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "client.md").read_text(encoding="utf-8"), re.DOTALL)
    parts = open_parts(tmp_path)
    env = {**os.environ, "REDIS_URL": parts.url, "SIDEBAND_DATA_DIR": str(tmp_path)}
    parts.workers.append(subprocess.Popen([sys.executable, "-m", "workers"], env=env, cwd=ROOT))
    try:
        with LiveServer(application(parts.settings())) as http:
            told = _run(code, http, tmp_path)
    finally:
        parts.close()
    assert told.returncode == 0, told.stderr
    assert told.stdout.startswith("accepted\n")
    assert "simulating" in told.stdout and re.search(r"^1\*f_m .* present$", told.stdout, re.MULTILINE), told.stdout
    assert (tmp_path / "out" / "signals.npz").is_file()


def _run(code: str, http: httpx.Client, folder: Path) -> subprocess.CompletedProcess[str]:
    """In a process of its own, started in another folder: it needs nothing but the package."""
    code = code.replace("http://127.0.0.1:8000", str(http.base_url))
    env = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-c", code]
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, timeout=300, check=False)
