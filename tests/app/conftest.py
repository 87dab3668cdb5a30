"""An application on a real broker with one worker, for a whole module."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest

from tests.service.parts import LiveServer, Parts, open_parts


@pytest.fixture(scope="module")
def parts(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Parts]:
    opened = open_parts(Path(tmp_path_factory.mktemp("data")))
    if request.config.option.markexpr != "not slow":  # what waits for a worker is slow
        opened.start_worker("worker-1")
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def client(parts: Parts) -> Iterator[httpx.Client]:
    with LiveServer(parts.app()) as opened:
        yield opened
