"""Fewer simulations than a user's reconciliation has: enough to go through all stages with a strong effect.

`tests/proof/test_rotor_case.py` has as many as a user's.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import pytest

from reconcile.machine import local
from reconcile.machine.budget import QUICK

BUDGET = replace(QUICK, terms=3, pairs=1, seconds=1)


@contextmanager
def few_machines() -> Iterator[None]:
    """8 machines fitted to the baseline, as many as vector lanes hold, of a user's 24."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(local, "MACHINES", local.LANES)
        yield
