"""Plans of datasets are made by few at a time: each may take seconds of a core and some memory."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from threading import BoundedSemaphore

from jobs.errors import PlannersBusy

AT_ONCE = 2
"""Plans that are made at a time in a process."""
WAIT_S = 2.0
"""Whoever comes later waits so long at most: most plans take tenths of a second."""
RETRY_AFTER_S = 5

_places = BoundedSemaphore(AT_ONCE)


@contextmanager
def planning() -> Iterator[None]:
    """A place among those who plan; PlannersBusy when none becomes free in time."""
    if not _places.acquire(timeout=WAIT_S):
        raise PlannersBusy(AT_ONCE, RETRY_AFTER_S)
    try:
        yield
    finally:
        _places.release()
