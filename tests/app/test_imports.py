"""What only some requests need is loaded by them, not by every start of a server or a command."""

from __future__ import annotations

import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow
LARGE = ("matplotlib", "scipy.signal", "scipy.stats")
CODE = """
import importlib, sys
for module in sys.argv[1:]:
    importlib.import_module(module)
    print(module, [name for name in {large!r} if name in sys.modules])
"""


def told(*modules: str) -> list[str]:
    """What each has loaded, with those before it, in a process of its own."""
    command = [sys.executable, "-c", CODE.format(large=LARGE), *modules]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=120)
    return done.stdout.splitlines()


def test_a_start_does_not_wait_for_what_few_requests_need() -> None:
    """Both in one process, which seconds of a core are: what is not loaded after both, neither loads."""
    modules = ("app.main", "app.cli.reconcile")
    assert told(*modules) == [f"{module} []" for module in modules], "slower starts: a third of a server's"
