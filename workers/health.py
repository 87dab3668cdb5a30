"""`python -m workers.health`: whether this host's workers reported lately; for container health checks."""

from __future__ import annotations

import socket
import sys
import time

from sim.core.errors import SidebandError
from store.catalogue import engine, workers
from store.settings import StoreSettings

SILENT_S = 60.0


def main() -> int:
    """Entry point: 0 when a worker of this host was heard of within a minute."""
    database = engine.connect(StoreSettings.from_environment().catalogue_url, pooled=False)
    try:
        rows = workers.seen_since(database, time.time() - SILENT_S)
    except SidebandError as error:
        sys.stderr.write(f"{error}\n")
        return 1
    return 0 if any(row.host == socket.gethostname() for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
