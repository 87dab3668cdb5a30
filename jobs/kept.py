"""Answers that cost something to make, kept for a while in memory, within a bound."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from concurrent.futures import Future
from threading import Lock

MAX_BYTES = 32 * 2**20
"""About forty label documents: those of the gearbox presets (2 s at 30 kHz) have 0.5 to 0.9 MB."""
Key = tuple[str, ...]


class Kept:
    """The bytes last used, up to `max_bytes` of them. A key must name everything its bytes depend on.

    Two threads that ask the same at the same time wait for one making. What fails is not kept.
    """

    def __init__(self, max_bytes: int = MAX_BYTES) -> None:
        self._max_bytes = max_bytes
        self._bytes: OrderedDict[Key, bytes] = OrderedDict()
        self._making: dict[Key, Future[bytes]] = {}
        self._size = 0
        self._lock = Lock()

    def get(self, key: Key, make: Callable[[], bytes]) -> bytes:
        """The bytes of the key, from `make` when they are not here."""
        with self._lock:
            if key in self._bytes:
                self._bytes.move_to_end(key)
                return self._bytes[key]
            others = self._making.get(key)
            if others is None:
                mine = self._making[key] = Future[bytes]()
        if others is not None:
            return others.result()
        try:
            made = make()
        except BaseException as error:
            self._settle(key)
            mine.set_exception(error)
            raise
        self._settle(key, made)
        mine.set_result(made)
        return made

    def _settle(self, key: Key, made: bytes | None = None) -> None:
        with self._lock:
            del self._making[key]
            if made is None or len(made) > self._max_bytes:
                return
            self._bytes[key] = made
            self._size += len(made)
            while self._size > self._max_bytes:
                _, dropped = self._bytes.popitem(last=False)
                self._size -= len(dropped)
