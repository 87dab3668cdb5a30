"""The whole service with the fake physics, its workers started by its supervisor as those of `sideband serve` are."""

from __future__ import annotations

import sys
from pathlib import Path

from app.main import create_app
from app.serve import Service, run
from app.settings import Settings
from signals.encode import encode
from store.settings import StoreSettings
from tests.service.fakes import FakeEngine


def serve(workers: int, folder: Path) -> int:
    """Until SIGINT or SIGTERM, on any free port; the first line of its output ends with its address."""
    settings = Settings(stores=StoreSettings(data_dir=folder, redis_url=""), port=0, recover_every_s=0.2)
    service = Service(
        settings=settings,
        workers=workers,
        build=lambda given: create_app(given, engine=FakeEngine(), encode=encode),
        worker_command=(sys.executable, str(Path(__file__).with_name("worker.py"))),
    )
    return run(service)
