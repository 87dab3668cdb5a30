"""The API keys that hold now: those of the environment, and those of a file that may change while the server runs."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping
from pathlib import Path

from app.key_file import VARIABLE, Key, keys_of, read_keys
from sim.core.errors import SpecError

log = logging.getLogger(__name__)

LOOK_EVERY_S = 1.0
"""How long a changed file may go unnoticed: a look is a system call, which may wait on a network's file system."""
_Stamp = tuple[int, int, int]


class KeyRing:
    """Finds a key by its digest. A changed file that cannot be used leaves the keys as they are, and is logged once."""

    def __init__(
        self,
        plain: Mapping[str, str],
        file: Path | None,
        *,
        requests_per_minute: int | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """`requests_per_minute`: of each holder of a `plain` key; None: no limit."""
        self._plain, self._file, self._clock = keys_of(plain, requests_per_minute), file, clock
        self._stamp = self._look()
        self._looked_at = clock()
        self._keys = {**self._plain, **(read_keys(file) if file is not None else {})}

    def find(self, digest: str) -> Key | None:
        """The key, also one that has ended. An entry of the file goes before one of the environment.

        A dictionary will do: digests are searched for, not keys, so how long a search takes tells nothing of use.
        """
        self._refresh()
        return self._keys.get(digest)

    def _refresh(self) -> None:
        now = self._clock()
        if self._file is None or now - self._looked_at < LOOK_EVERY_S:
            return
        self._looked_at = now
        stamp = self._look()
        if stamp == self._stamp:
            return
        self._stamp = stamp
        try:
            self._keys = {**self._plain, **read_keys(self._file)}
        except SpecError as error:
            for problem in error.problems:
                log.error("the changed file of API keys is not used, the keys before it hold on: %s", problem)
            return
        log.warning("%s was read again: %d keys hold", VARIABLE, len(self._keys))

    def _look(self) -> _Stamp | None:
        # Taken before the file is read: what is written in between is noticed at the next look.
        try:
            found = self._file.stat() if self._file is not None else None
        except OSError:
            return None
        return None if found is None else (found.st_mtime_ns, found.st_size, found.st_ino)
