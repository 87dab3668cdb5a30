"""Seconds that rattle under a driving first are asked by simulation: sums cannot tell them."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.machine import interplay
from reconcile.machine.decide import Decision
from reconcile.machine.interplay import FAINT, NEAR, SHAKEN, SHARE, interplaying, shaken
from sim.core.spec import TermSpec

FIRST, MOMENT = "unbalance@pinion", 1e-2
LOOSE, WORN, OPEN = "fit_clearance_series@bearing1", "radial_clearance@bearing2", "pedestal_looseness@bearing1"
OTHER = "tooth_crack@gear"
SIZES = {"fit_clearance_series": "gap", "radial_clearance": "change", "pedestal_looseness": "loss", "tooth_crack": "x"}
DRAWS = 11


def drawn(name: str) -> tuple[TermSpec, ...]:
    term, site = name.split("@")
    return tuple(TermSpec(term=term, site=site, parameters={SIZES[term]: 1e-6 * (k + 1)}) for k in range(DRAWS))


def asked(names: tuple[str, ...], first: str = FIRST) -> Any:
    groups = {name: tuple(range(DRAWS * k, DRAWS * (k + 1))) for k, name in enumerate(names)}
    every = SimpleNamespace(
        terms=tuple(t for name in names for t in drawn(name)), library=SimpleNamespace(groups=groups)
    )
    left = SimpleNamespace(likelihood=lambda changes: changes[:, 0], base=-100.0)
    return SimpleNamespace(setting=None, first=first, every=every, left=left, mapper=map)


def start() -> Any:
    terms = tuple(
        TermSpec(term="unbalance", site="pinion", parameters={"moment": MOMENT, "angle": 0.1 * k}) for k in (1, 2)
    )
    return SimpleNamespace(candidate="first", offsets=("one", "two"), terms=terms)


Simulation = Callable[[dict[str, float]], list[tuple[Any, ...]]]


@pytest.fixture
def simulated(monkeypatch: pytest.MonkeyPatch) -> Simulation:
    """Machines whose log likelihood over the first alone is as given for the larger size of each second, and 1 less for
    the smaller; what was asked for."""

    def world(gains: dict[str, float]) -> list[tuple[Any, ...]]:
        calls: list[tuple[Any, ...]] = []

        def again(_setting, candidate, offsets, terms, _mapper, also):  # type: ignore[no-untyped-def]
            calls.append((candidate, list(offsets), list(terms), list(also)))
            told = []
            for second in also:
                small = next(iter(second.parameters.values())) < 6e-6
                told.append([-100.0 + gains[f"{second.term}@{second.site}"] - small])
            runs = tuple(range(len(also)))
            return SimpleNamespace(library=SimpleNamespace(changes=np.array(told)), pairs=runs)

        monkeypatch.setattr(interplay, "simulated_again", again)
        return calls

    return world


def test_the_likeliest_comes_first_with_its_sizes_and_what_cannot_rattle_is_not_asked(simulated: Simulation) -> None:
    calls = simulated({LOOSE: 40.0, WORN: 40.0 - NEAR + 1.0, OPEN: 0.0})
    found = interplaying(asked((OTHER, LOOSE, WORN, OPEN)), start())
    assert list(found) == [LOOSE, WORN]
    assert found[LOOSE] == (DRAWS + 7, DRAWS + 3), "of both sizes, the likelier first"
    ((candidate, offsets, firsts, seconds),) = calls
    assert candidate == "first" and offsets == ["one", "two"] * 3 and len(seconds) == 6
    assert {t.parameters["moment"] for t in firsts} == {SHARE * MOMENT}, "alone it is too large"
    assert {t.parameters["angle"] for t in firsts} == {0.1, 0.2} and not any(t.term == "tooth_crack" for t in seconds)


def test_what_is_far_behind_is_not_searched_and_what_is_faint_not_at_all(simulated: Simulation) -> None:
    simulated({LOOSE: 40.0, WORN: 40.0 - NEAR - 1.0})
    assert list(interplaying(asked((LOOSE, WORN)), start())) == [LOOSE]
    simulated({LOOSE: FAINT - 1.0, WORN: FAINT - 2.0})
    assert interplaying(asked((LOOSE, WORN)), start()) == {}


@pytest.mark.parametrize("first", ["tooth_crack@gear", "rub@pinion", LOOSE])
def test_only_what_drives_makes_rattle(first: str, simulated: Simulation) -> None:
    calls = simulated({LOOSE: 40.0, WORN: 0.0})
    assert interplaying(asked((LOOSE, WORN), first), start()) == {} and calls == []


def test_nothing_without_seconds_or_where_too_few_run(simulated: Simulation, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = simulated({})
    assert interplaying(asked((OTHER,)), start()) == {} and calls == []
    monkeypatch.setattr(interplay, "simulated_again", lambda *_, **__: None)
    assert interplaying(asked((LOOSE,)), start()) == {}


@pytest.mark.parametrize(
    ("word", "first", "evidence", "told"),
    [
        ("unknown_physics", FIRST, SHAKEN, True),
        ("unknown_physics", FIRST, SHAKEN - 0.1, False),
        ("unknown_physics", LOOSE, SHAKEN + 9.0, False),
        ("not_decidable", FIRST, SHAKEN + 9.0, False),
        ("explained", FIRST, SHAKEN + 9.0, False),
    ],
)
def test_a_sure_driving_effect_that_leaves_too_much_shakes_something(
    word: str, first: str, evidence: float, told: bool
) -> None:
    decision = Decision(word=word, chosen=(first, OTHER), p=1e-6, reasons=())  # type: ignore[arg-type]
    screen = SimpleNamespace(names=(OTHER, first), evidence=np.array([99.0, evidence]))
    assert shaken(SimpleNamespace(screen=screen), decision) is told  # type: ignore[arg-type]
    assert not shaken(SimpleNamespace(screen=screen), Decision(word=word, chosen=(), p=1e-6, reasons=()))  # type: ignore[arg-type]
