"""A PostgreSQL database: an empty one named by SIDEBAND_TEST_POSTGRESQL_URL, or on a private server."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest

from tests.service import postgresql


@pytest.fixture(scope="session")
def postgresql_url() -> Iterator[str]:
    given = os.environ.get("SIDEBAND_TEST_POSTGRESQL_URL", "")
    if given:
        yield given
        return
    reason = postgresql.missing()
    if reason:
        pytest.skip(reason)
    with postgresql.cluster() as url:
        yield url
