"""The guard: holds the folder's lock, keeps the server alive on one address, ends it with its owner."""

from __future__ import annotations

import logging
import select
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from workers.broker import valkey
from workers.broker.lock import FolderLock

log = logging.getLogger(__name__)

TRIES = 5
LOOK_EVERY_S = 0.2


def guard(
    folder: Path, *, owner: BinaryIO, announce: Callable[[valkey.Address], None], stopped: Callable[[], bool]
) -> None:
    """Serve until `stopped()` or until `owner` (a pipe whose other end the owner holds) is closed.

    A server that dies is started again on the same address: clients only have to reconnect.
    """
    with FolderLock(folder):
        address, server = first_start(folder)
        announce(address)
        try:
            while not stopped() and not _closed(owner, LOOK_EVERY_S):
                if server.poll() is not None:
                    log.error("the broker ended with code %s; starting it again", server.returncode)
                    server = restart(address, folder)
        finally:
            valkey.stop(server)


def first_start(folder: Path) -> tuple[valkey.Address, subprocess.Popen[bytes]]:
    """Start on a free port; a file that the server cannot read is set aside, since the catalogue can fill a new one."""
    for attempt in range(TRIES):
        address = valkey.new_address()
        try:
            return address, valkey.start(address, folder)
        except valkey.BrokerFailed:
            if attempt == TRIES - 1:
                raise
            if attempt >= 1:
                _set_aside(folder)
    raise AssertionError("unreachable")


def restart(address: valkey.Address, folder: Path) -> subprocess.Popen[bytes]:
    """Start again where clients expect the server."""
    for attempt in range(TRIES):
        try:
            return valkey.start(address, folder)
        except valkey.BrokerFailed:
            if attempt == TRIES - 1:
                raise
            time.sleep(0.2 * (attempt + 1))
    raise AssertionError("unreachable")


def _set_aside(folder: Path) -> None:
    persisted = folder / "appendonlydir"
    if persisted.exists():
        moved = folder / f"unreadable-{int(time.time() * 1000)}"
        persisted.rename(moved)
        log.error("the broker could not read its file; it is kept as %s", moved)


def _closed(owner: BinaryIO, wait_s: float) -> bool:
    readable, _, _ = select.select([owner], [], [], wait_s)
    return bool(readable) and owner.read(1) == b""
