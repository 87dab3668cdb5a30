"""A real server with a real broker and worker, and the client of it; and a client of a scripted server."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

import sideband_client
from sideband_client import Client
from tests.service.parts import LiveServer, Parts, open_parts
from tests.sideband_client.script import Script


@pytest.fixture(scope="module")
def parts(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Parts]:
    opened = open_parts(Path(tmp_path_factory.mktemp("data")))
    if request.config.option.markexpr != "not slow":  # what waits for a worker is slow
        opened.start_worker("worker-1")
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def url(parts: Parts) -> Iterator[str]:
    with LiveServer(parts.app()) as opened:
        yield str(opened.base_url)


@pytest.fixture
def client(url: str) -> Iterator[Client]:
    with sideband_client.connect(url) as opened:
        yield opened


@pytest.fixture
def script() -> Script:
    return Script()


@pytest.fixture
def scripted(script: Script) -> Iterator[Callable[..., Client]]:
    opened: list[Client] = []

    def make(**timing: float) -> Client:
        opened.append(Client(script.transport(**timing)))
        return opened[-1]

    yield make
    for each in opened:
        each.close()
