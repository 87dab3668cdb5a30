"""From which size on an effect would have been seen: what counts, and how a page tells it."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from reconcile.machine.faintest import seen_from
from reconcile.report.action import to_do
from reconcile.report.page import page
from reconcile.verdict import Faintest, Report


def test_all_from_the_size_on_were_seen() -> None:
    sizes = np.array([3.0, 1.0, 2.0, 4.0])
    assert seen_from(sizes, np.array([True, False, True, True])) == 2.0
    assert seen_from(sizes, np.array([False, True, True, True])) == 4.0
    assert seen_from(sizes, np.array([True, True, True, False])) is None
    assert seen_from(sizes, np.ones(4, dtype=bool)) == 1.0


@given(st.lists(st.tuples(st.floats(1e-6, 1.0), st.booleans()), min_size=1, max_size=12, unique_by=lambda x: x[0]))
def test_nothing_missed_is_as_large_and_no_smaller_size_will_do(draws: list[tuple[float, bool]]) -> None:
    sizes, told = np.array([d[0] for d in draws]), np.array([d[1] for d in draws])
    found = seen_from(sizes, told)
    if found is None:
        assert not told[np.argmax(sizes)]
    else:
        assert told[sizes >= found].all()
        smaller = np.sort(sizes[sizes < found])
        assert smaller.size == 0 or not told[sizes == smaller[-1]].all()


def row(term: str, name: str, seen: int, smallest: float | None, *, strikes: bool = False) -> Faintest:
    return Faintest(
        term=term, site="bearing1", name=name, unit="m", seen=seen, simulated=8, seen_from=smallest, largest=3e-3,
        strikes=strikes,
    )  # fmt: skip


def rows() -> tuple[Faintest, ...]:
    return row("inner_spall", "width", 6, 3.1e-4, strikes=True), row("radial_clearance", "change", 0, None)


def test_the_page_says_what_would_have_been_seen_and_what_not() -> None:
    sound = Report(verdict="nothing_missing", sentence="Nothing is missing.", level="machine", faintest=rows())
    told = page(sound)
    assert "What would have been seen" in told
    assert "bearing1 310 \u00b5m (6 of 8 sizes)" in told and "bearing1 3 mm (0 of 8 sizes)" in told
    assert told.index("radial clearance") < told.index("inner spall*")  # what is told least comes first
    assert "What would have been seen" in to_do(sound)


def test_without_simulations_nothing_is_said_of_it() -> None:
    bare = Report(verdict="nothing_missing", sentence="Nothing is missing.", level="kinematics")
    assert "would have been seen" not in page(bare) and "would hardly" not in to_do(bare)
