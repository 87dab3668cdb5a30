"""A command's processes end with it: after Ctrl-C none goes on with its task."""

from __future__ import annotations

import time

import psutil
import pytest

from app.cli.processes import processes

LONG_S = 3600.0


def square(x: int) -> int:
    return x * x


def test_one_needs_no_process() -> None:
    with processes(1) as pool:
        assert pool is None


@pytest.mark.slow
def test_work_is_shared_and_the_results_come_in_order() -> None:
    with processes(2) as pool:
        assert pool is not None
        assert list(pool.map(square, range(5))) == [0, 1, 4, 9, 16]


@pytest.mark.slow
def test_after_ctrl_c_no_process_goes_on() -> None:
    """A test that hangs has failed: the tasks last an hour."""
    pids: list[int] = []
    with pytest.raises(KeyboardInterrupt), processes(2) as pool:
        assert pool is not None
        for _ in range(6):
            pool.submit(time.sleep, LONG_S)
        pids = list(pool._processes or {})
        raise KeyboardInterrupt
    assert len(pids) == 2 and not any(psutil.pid_exists(pid) for pid in pids)
