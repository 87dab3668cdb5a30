"""What tests of whole reconciliations share."""

from __future__ import annotations

import pytest

from tests.reconcile.remembered import Simulated


@pytest.fixture(scope="session")
def simulated() -> Simulated:
    """Healthy machines of the kind are the same for every effect that is looked for."""
    return Simulated()
