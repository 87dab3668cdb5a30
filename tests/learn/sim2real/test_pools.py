"""Processes that work is shared among, or none."""

import pytest

from learn.sim2real.pools import AtOnce, workers


def test_without_processes_work_is_done_when_it_is_handed_in():
    done: list[int] = []
    pool = AtOnce()
    future = pool.submit(done.append, 3)
    assert done == [3] and future.result() is None
    assert list(pool.map(pow, [2, 3], [3, 2])) == [8, 9]
    with pytest.raises(ValueError, match="invalid literal"):
        pool.submit(int, "x")


def test_one_process_is_the_one_that_asks():
    with workers(1) as pool:
        assert isinstance(pool, AtOnce)


def test_an_error_leaves_the_pool():
    with pytest.raises(ZeroDivisionError), workers(1) as pool:
        pool.submit(divmod, 1, 0)
