"""A worker tells the catalogue that it lives, whatever the broker does."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from redis.exceptions import ConnectionError as BrokerGone
from rq import Worker

from workers.worker import SidebandWorker


@pytest.mark.parametrize(("horse", "state"), [(7, "busy"), (0, "idle")])
def test_the_catalogue_hears_of_it_while_the_broker_is_away(
    monkeypatch: pytest.MonkeyPatch, horse: int, state: str
) -> None:
    def away(*_: Any, **__: Any) -> None:
        raise BrokerGone

    told: list[str] = []
    monkeypatch.setattr(Worker, "heartbeat", away)
    worker = SidebandWorker.__new__(SidebandWorker)
    worker._watch, worker._horse_pid = SimpleNamespace(report=told.append), horse  # type: ignore[assignment]
    with pytest.raises(BrokerGone):
        worker.heartbeat()
    assert told == [state]
