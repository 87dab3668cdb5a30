"""Processes that the work is shared among."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import AbstractContextManager, contextmanager, nullcontext
from multiprocessing import get_context
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
T = TypeVar("T")


def pool_of(processes: int) -> AbstractContextManager[Executor | None]:
    """Processes of one thread each, as another thread costs more than it brings; none for one."""
    if processes == 1:
        return nullcontext()
    for library in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(library, "1")
    return ProcessPoolExecutor(processes, mp_context=get_context("spawn"))


class AtOnce(Executor):
    """Where there is no other process: work is done when it is handed in."""

    def submit(self, work: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        """Done, with its result; what it raises is raised here."""
        future: Future[T] = Future()
        future.set_result(work(*args, **kwargs))
        return future


@contextmanager
def workers(processes: int) -> Iterator[Executor]:
    """A pool for everything, so that no step waits for another's last process; after an error nothing more is begun."""
    with pool_of(processes) as several:
        pool = several or AtOnce()
        try:
            yield pool
        except BaseException:
            pool.shutdown(wait=True, cancel_futures=True)
            raise
