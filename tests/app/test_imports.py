"""What only some requests need is loaded by them, not by every start of a server or a command."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow
LARGE = ("matplotlib", "scipy.signal", "scipy.stats")


@pytest.mark.parametrize("module", ["app.main", "app.cli.reconcile"])
def test_a_start_does_not_wait_for_what_few_requests_need(module: str) -> None:
    code = f"import sys, {module}; print([name for name in {LARGE!r} if name in sys.modules])"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=120)
    assert told.stdout.strip() == "[]", "slower starts: a third of a server's"
