"""The whole service with the fake physics: `python tests/service/server.py PORT WORKERS DATA_DIR`."""

from __future__ import annotations

import gc
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
gc.disable()  # while loading, as the commands do (sim.loading)

from app.main import create_app
from app.serve import Service, run
from app.settings import Settings
from signals.encode import encode
from sim.core.errors import SidebandError
from store.settings import StoreSettings
from tests.service.fakes import FakeEngine

if __name__ == "__main__":
    gc.freeze()
    gc.enable()
    port, workers, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    settings = Settings(stores=StoreSettings(data_dir=folder, redis_url=""), port=port, recover_every_s=0.2)
    service = Service(
        settings=settings,
        workers=workers,
        build=lambda given: create_app(given, engine=FakeEngine(), encode=encode),
        worker_command=(sys.executable, str(Path(__file__).with_name("worker.py"))),
    )
    try:
        sys.exit(run(service))
    except SidebandError as error:
        print(error, file=sys.stderr)
        sys.exit(3)
