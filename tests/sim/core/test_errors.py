"""Errors reach a caller whole, from wherever they are raised."""

from __future__ import annotations

import pickle
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import pytest

from sim.core.errors import Cancelled, Diverged, Meaningless, Problem, SidebandError, SpecError, UnknownName

WRONG = Problem(field="speed_hz", message="must be positive", given=-1.0, allowed="above 0", unit="Hz")
ERRORS = [
    SpecError([WRONG, WRONG]),
    UnknownName("preset", "papr", ("paper",)),
    Diverged(time_s=0.1, dof="pinion.y", advice="halve the step"),
    Meaningless(reasons=("energy grew",), advice="add damping"),
    Cancelled(),
]


@pytest.mark.parametrize("error", ERRORS, ids=lambda e: type(e).__name__)
def test_an_error_is_the_same_after_pickling(error: SidebandError) -> None:
    back = pickle.loads(pickle.dumps(error))
    assert type(back) is type(error)
    assert str(back) == str(error)
    assert vars(back) == vars(error)


def _fails() -> None:
    raise SpecError(WRONG)


@pytest.mark.slow
def test_problems_come_whole_from_another_process() -> None:
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        found = pool.submit(_fails).exception(timeout=60)
    assert isinstance(found, SpecError)
    assert found.problems == (WRONG,)
    assert str(found) == "speed_hz: must be positive (given -1.0); allowed: above 0 Hz"
