"""What tests of whole reconciliations share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.reconcile import few
from tests.reconcile.remembered import Simulated


@pytest.fixture(scope="session")
def simulated() -> Simulated:
    """Healthy machines of the kind are the same for every effect that is looked for."""
    return Simulated()


@pytest.fixture
def few_machines() -> Iterator[None]:
    """As `few.few_machines`."""
    with few.few_machines():
        yield
