"""Sizes of two effects that act on each other are found where machines moved by what they show get nowhere."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.calibrate.uncertain import Offsets
from reconcile.machine import causes, left_pairs, left_start, sizes
from reconcile.machine.asked import LEAST_GAIN, TEMPER
from reconcile.machine.assimilate import Ensemble
from reconcile.machine.left_pairs import _searched
from reconcile.machine.pairs import Pair, Pairs, sizes_of
from reconcile.machine.second import Beside, Together
from reconcile.machine.sizes import APART, ENOUGH, HOPELESS_AFTER, SMALLEST_FIRST, TURNS, Trial, searched, spread
from reconcile.verdict import Severity
from sim.core.spec import TermSpec

FIRST, SECOND = "unbalance@pinion", "fit_clearance@bearing1"
MOMENT, GAP = 5.4e-3, 2.2e-5
ALONE, GAPS = 2.5 * MOMENT, (4.7e-5, 4.5e-6, 1.1e-5)
SOUGHT = (2e-6, 1.2e-4)
MEMBERS, BASE = 8, -20.0
SETTING = SimpleNamespace(seed=0, machine=None)


def unbalance(moment: float) -> TermSpec:
    return TermSpec(term="unbalance", site="pinion", parameters={"moment": moment, "angle": 0.3})


def clearance(gap: float, damping: float = 2e3) -> TermSpec:
    return TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": gap, "damping": damping, "friction": 0.1})


def made_of(trial: Trial) -> tuple[float, float]:
    return trial.first.parameters["moment"], trial.second.parameters["gap"]


def likelihood(changes: np.ndarray) -> np.ndarray:
    """Of a ridge that bends: what is left when the one is wrong depends on the other."""
    a, b = changes[:, 0] - np.log(MOMENT), changes[:, 1] - np.log(GAP)
    return -400.0 * (a - 0.5 * b**2) ** 2 - 100.0 * b**2


@pytest.fixture(autouse=True)
def simulated(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """Machines that show the logarithms of their sizes; how many were asked for each time. The third never runs."""
    asked: list[int] = []

    def again(_setting, candidate, offsets, terms, _mapper, also):  # type: ignore[no-untyped-def]
        assert candidate.label == FIRST
        asked.append(len(terms))
        runs = tuple(k for k in range(len(terms)) if k != 2)
        changes = np.log([[terms[k].parameters["moment"], also[k].parameters["gap"]] for k in runs])
        return SimpleNamespace(
            library=SimpleNamespace(changes=changes),
            terms=tuple(terms[k] for k in runs),
            pairs=runs,
            offsets=tuple(offsets[k] for k in runs),
        )

    monkeypatch.setattr(sizes, "simulated_again", again)
    monkeypatch.setattr(sizes, "sought_range", lambda *_: SOUGHT)
    return asked


def start(count: int = MEMBERS) -> Ensemble:
    return Ensemble(
        candidate=SimpleNamespace(label=FIRST),  # type: ignore[arg-type]
        offsets=tuple(Offsets(values=np.full(3, 0.01 * k)) for k in range(count)),
        terms=(unbalance(ALONE),) * count,
        changes=np.zeros((count, 2)),
    )


def asked(**more: object) -> SimpleNamespace:
    left = SimpleNamespace(likelihood=likelihood, base=BASE)
    every = SimpleNamespace(terms=tuple(clearance(gap, 10.0 ** (3 + k)) for k, gap in enumerate(GAPS)))
    given = {"setting": SETTING, "left": left, "first": FIRST, "every": every, "members": MEMBERS, "mapper": map}
    return SimpleNamespace(**{**given, "least": LEAST_GAIN, "beside_impacts": False, **more})


def test_both_sizes_are_found(simulated: list[int]) -> None:
    found = searched(asked(), start(), (0, 1, 2))  # type: ignore[arg-type]
    assert found is not None and simulated == [16] + [8] * TURNS
    likely = np.argsort(-found.gains)[: MEMBERS // 2]
    moments = [found.known.terms[k].parameters["moment"] for k in likely]
    gaps = [found.also[found.known.pairs[k]].parameters["gap"] for k in likely]
    assert np.median(moments) == pytest.approx(MOMENT, rel=0.15)
    assert np.median(gaps) == pytest.approx(GAP, rel=0.25)
    told = likelihood(found.known.library.changes)
    assert found.gains == pytest.approx((told - BASE) / TEMPER)
    begun = likelihood(np.log([[ALONE, gap] for gap in GAPS]))
    assert np.median(told) > 0.1 * begun.max()
    again = searched(asked(), start(), (0, 1, 2))  # type: ignore[arg-type]
    assert again is not None and again.also == found.also


@pytest.mark.parametrize(("base", "turns"), [(-3.0 * ENOUGH, range(1, 4)), (BASE, [TURNS]), (200.0, [HOPELESS_AFTER])])
def test_the_search_ends_where_it_is_good_enough_or_hopeless(
    base: float, turns: Sequence[int], simulated: list[int]
) -> None:
    left = SimpleNamespace(likelihood=likelihood, base=base)
    assert searched(asked(left=left), start(), (0, 1, 2)) is not None  # type: ignore[arg-type]
    assert len(simulated) - 1 in turns


def test_starts_are_spread_over_both_ranges_and_alike_in_all_else() -> None:
    firsts = [Trial(offsets=Offsets(values=np.zeros(3)), first=unbalance(ALONE), second=clearance(2e-5))] * 16
    moments, gaps = np.array([made_of(t) for t in spread(SETTING, firsts, FIRST)]).T  # type: ignore[arg-type]
    for found, low, high in ((moments, SMALLEST_FIRST * ALONE, ALONE), (gaps, 2e-5 / APART, 2e-5 * APART)):
        place = np.log(found / low) / np.log(high / low) * 16
        assert sorted(np.floor(place)) == list(range(16)), "each stretch once"
    other = spread(SETTING, firsts, FIRST)[0].second.parameters  # type: ignore[arg-type]
    assert (other["damping"], other["friction"]) == (2e3, 0.1)
    wide = [Trial(offsets=t.offsets, first=t.first, second=clearance(1e-4)) for t in firsts]
    assert max(made_of(t)[1] for t in spread(SETTING, wide, FIRST)) <= SOUGHT[1]  # type: ignore[arg-type]


@pytest.mark.parametrize("fails", [0, 3])
def test_nothing_where_machines_do_not_run(fails: int, monkeypatch: pytest.MonkeyPatch) -> None:
    made, calls = sizes.simulated_again, []

    def again(*given, **more):  # type: ignore[no-untyped-def]
        calls.append(1)
        return None if len(calls) > fails else made(*given, **more)

    monkeypatch.setattr(sizes, "simulated_again", again)
    assert searched(asked(), start(), (0,)) is None  # type: ignore[arg-type]
    assert len(calls) == fails + 1


@pytest.fixture
def sought(monkeypatch: pytest.MonkeyPatch) -> list[tuple[int, ...]]:
    """The draws with which a search began."""
    begun: list[tuple[int, ...]] = []
    monkeypatch.setattr(left_pairs, "start_of", lambda *_: start())
    monkeypatch.setattr(left_pairs, "searched", lambda _asked, _start, rows: begun.append(rows))
    return begun


BOTH = Together(
    severity=Severity(name="gap", value=GAP, unit="m", low=1e-5, high=4e-5),
    terms=((unbalance(MOMENT), clearance(GAP)),),
    middle=Offsets(values=np.zeros(3)),
    own=Severity(name="moment", value=MOMENT, unit="kg*m", low=0.8 * MOMENT, high=1.2 * MOMENT),
)


def pair(gain: float, together: Together | None = None) -> Pair:
    beside = Beside(
        view=None,  # type: ignore[arg-type]
        left=np.zeros(2),
        names=(SECOND,),
        evidence=np.array([gain]),
        p=0.0,
        misfit=0.5,
        together=together,
    )
    return Pair(first=FIRST, beside=beside, gain=gain, rest=None)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("made", "sums", "more", "rows"),
    [
        ({"a@x": pair(-900.0), "b@x": pair(-90.0)}, (430.0, 178.0), {}, [(2, 3)]),
        ({"a@x": None, "b@x": pair(-90.0)}, (430.0, 178.0), {}, [(2, 3)]),
        ({"a@x": pair(-900.0), "b@x": pair(LEAST_GAIN)}, (430.0, 178.0), {}, []),
        ({"a@x": pair(-900.0), "b@x": pair(5.0)}, (430.0, LEAST_GAIN - 1.0), {}, [(0, 1)]),
        ({"a@x": pair(-9.0), "b@x": pair(5.0)}, (LEAST_GAIN - 0.5, 4.0), {}, []),
        ({"a@x": pair(-900.0), "b@x": pair(-90.0)}, (430.0, 178.0), {"beside_impacts": True}, []),
    ],
)
def test_only_what_sums_promise_and_simulation_refuses_is_searched(
    made: dict[str, Pair | None],
    sums: tuple[float, float],
    more: dict[str, bool],
    rows: list[tuple[int, ...]],
    sought: list[tuple[int, ...]],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    seen = [("a@x", sums[0], (0, 1)), ("b@x", sums[1], (2, 3))]
    assert _searched(asked(**more), made, seen) == {}  # type: ignore[arg-type]
    assert sought == rows
    found: Callable[..., object] = lambda *_: SimpleNamespace()  # noqa: E731
    monkeypatch.setattr(left_pairs, "searched", found)
    monkeypatch.setattr(left_pairs, "_pair", lambda _asked, _name, _made: pair(55.0, BOTH))
    told = _searched(asked(**more), made, seen)  # type: ignore[arg-type]
    assert [p.gain for p in told.values()] == ([55.0] if rows else [])
    assert all(p.beside.together.searched for p in told.values() if p.beside.together)


@pytest.mark.parametrize(
    ("second", "parts", "looked"),
    [
        ("outer_spall@x", (75.0, 69.0, -70.0), True),  # dy040 of the proof: a pit beside a loose ring
        ("outer_spall@x", (25.0, 39.0, 10.0), False),
        ("unbalance@x", (75.0, 69.0, -70.0), False),  # no law has how a ring alone rattles at one speed
    ],
)
def test_what_would_strike_and_does_not_repeat_is_searched_as_what_adds_too_little(
    second: str, parts: tuple[float, ...], looked: bool, sought: list[tuple[int, ...]]
) -> None:
    made = {second: replace(pair(sum(parts)), parts=parts)}
    setting = SimpleNamespace(direct=SimpleNamespace(evidence={}))
    beside_ring = asked(setting=setting, first="fit_clearance@bearing3")
    assert _searched(beside_ring, made, [(second, 43.0, (0, 1))]) == {}  # type: ignore[arg-type]
    assert sought == ([(0, 1)] if looked else [])


def test_the_first_is_as_large_as_it_is_beside_the_second() -> None:
    alone = Severity(name="moment", value=ALONE, unit="kg*m", low=0.5 * ALONE, high=2.0 * ALONE)
    assert BOTH.own is not None
    between = causes._between(alone, BOTH)
    assert between is not None and between.value == pytest.approx(np.sqrt(ALONE * MOMENT))
    assert causes._between(alone, replace(BOTH, searched=True)) == BOTH.own
    assert causes._between(alone, None) == alone
    several = replace(pair(55.0, replace(BOTH, searched=True)), others=(SECOND, "radial_clearance@bearing1"))
    assert sizes_of(Pairs(first=FIRST, tried=(), best=several)) == several.beside.together
    assert sizes_of(Pairs(first=FIRST, tried=(), best=pair(55.0, BOTH))) is None
    assert sizes_of(Pairs(first=FIRST, tried=(), best=None)) is None and sizes_of(None) is None


def test_forecasts_have_the_sizes_that_were_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """On machines that were not led to the observation."""
    begun: list[tuple[tuple[TermSpec, ...], tuple[TermSpec, ...]]] = []

    def again(_setting, _candidate, _offsets, terms, _mapper, also):  # type: ignore[no-untyped-def]
        begun.append((terms, also))

    given = asked(found=SimpleNamespace(unled=None), view=None)
    for module in (left_pairs, left_start):
        monkeypatch.setattr(module, "simulated_again", again, raising=False)
    monkeypatch.setattr(left_pairs, "replace", lambda one, **more: one if one is given.found else replace(one, **more))
    monkeypatch.setattr(left_pairs, "_asked", lambda *_: given)
    monkeypatch.setattr(left_pairs, "ranked_seconds", lambda *_: [(SECOND, 430.0, (0,))])
    monkeypatch.setattr(left_pairs, "start_of", lambda *_: replace(start(), also=(clearance(4.7e-5),) * MEMBERS))
    given.every, given.setting = None, SimpleNamespace(changes=None)
    for searched_too in (True, False):
        left_pairs._drawn(given, None, pair(55.0, replace(BOTH, searched=searched_too)))  # type: ignore[arg-type]
    (found, other), (usual, before) = begun
    assert {t.parameters["moment"] for t in found} == {MOMENT} and {t.parameters["gap"] for t in other} == {GAP}
    assert {t.parameters["moment"] for t in usual} == {ALONE} and {t.parameters["gap"] for t in before} == {4.7e-5}
