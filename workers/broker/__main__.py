"""`python -m workers.broker FOLDER`: prints one JSON line with the URL, then serves until its standard input closes."""

from __future__ import annotations

import json
import logging
import os
import signal
import sys
from pathlib import Path
from types import FrameType

from sim.core.errors import SidebandError
from workers.broker.guard import guard
from workers.broker.valkey import Address
from workers.process import die_with_parent


def main(arguments: list[str]) -> int:
    """Entry point."""
    logging.basicConfig(level=logging.INFO, format="%(levelname)s broker: %(message)s")
    stop_asked = False

    def stop(_signal: int, _frame: FrameType | None) -> None:
        nonlocal stop_asked
        stop_asked = True

    # Ctrl-C reaches the whole terminal group; the owner decides when the broker goes, after the workers.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, stop)
    die_with_parent(signal.SIGTERM, os.getppid())
    try:
        with open(0, "rb", buffering=0, closefd=False) as owner:
            guard(Path(arguments[0]).absolute(), owner=owner, announce=_announce, stopped=lambda: stop_asked)
    except SidebandError as error:
        _say(error=str(error))
        return 1
    return 0


def _announce(address: Address) -> None:
    _say(url=address.url)


def _say(**document: str) -> None:
    sys.stdout.write(json.dumps(document) + "\n")
    sys.stdout.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
