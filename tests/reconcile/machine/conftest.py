"""What tests of whole reconciliations share."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from reconcile.observe import observation
from tests.reconcile import few
from tests.reconcile.remembered import Simulated, Steadied


@pytest.fixture(scope="session")
def simulated() -> Simulated:
    """Healthy machines of the kind are the same for every effect that is looked for."""
    return Simulated()


@pytest.fixture
def few_machines() -> Iterator[None]:
    """As `few.few_machines`."""
    with few.few_machines():
        yield


@pytest.fixture(scope="module", autouse=True)
def steadied() -> Iterator[None]:
    """Tests of a file often hold others against the same baseline."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(observation, "steady", Steadied())
        yield
