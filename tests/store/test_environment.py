"""Numbers from the environment: wrong ones are named together, with what was given and what is allowed."""

from __future__ import annotations

import pytest

from sim.core.errors import SpecError
from store.environment import Numbers
from store.worker_settings import WorkerSettings


def test_defaults_numbers_and_whole_numbers() -> None:
    read = Numbers({"A": " 2.5 ", "B": "2e9", "C": "  "})
    assert (read.number("A", 1.0), read.whole("B", 1), read.number("C", 7.0), read.whole("D", 3)) == (
        2.5,
        2 * 10**9,
        7.0,
        3,
    )
    read.settle()


@pytest.mark.parametrize("text", ["abc", "nan", "inf", "-1", "11", "2,5", "0x10", "1 2"])
def test_what_is_no_number_within_the_bounds_is_told(text: str) -> None:
    read = Numbers({"A": text})
    assert read.number("A", 4.0, most=10, unit="s") == 4.0
    with pytest.raises(SpecError) as caught:
        read.settle()
    (problem,) = caught.value.problems
    assert (problem.field, problem.given, problem.allowed, problem.unit) == ("A", text, "a number, 0 to 10", "s")


def test_a_fraction_is_no_whole_number() -> None:
    read = Numbers({"A": "80.5"})
    assert read.whole("A", 8) == 8
    with pytest.raises(SpecError, match=r"A: is not usable \(given '80\.5'\); allowed: a whole number, 0 or more"):
        read.settle()


def test_every_wrong_variable_of_a_worker_is_told() -> None:
    environment = {"SIDEBAND_LEASE_S": "0", "SIDEBAND_KEEP_DAYS": "for ever", "SIDEBAND_CANCEL_GRACE_S": "1"}
    with pytest.raises(SpecError) as caught:
        WorkerSettings.from_environment(environment)
    assert [problem.field for problem in caught.value.problems] == ["SIDEBAND_LEASE_S", "SIDEBAND_KEEP_DAYS"]


def test_a_worker_is_set_from_the_environment() -> None:
    found = WorkerSettings.from_environment({"SIDEBAND_LEASE_S": "4", "SIDEBAND_KEEP_DAYS": "0"})
    assert (found.lease_s, found.renew_s, found.keep_s) == (4.0, 1.0, None)
    assert WorkerSettings.from_environment({}) == WorkerSettings()
