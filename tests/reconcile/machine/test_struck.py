"""Which second part is struck: one that has lines of its own, not those of the first one's cage."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from reconcile.kinematics.families import Family, Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine import struck
from reconcile.machine.struck import combs
from sim import presets

TIE = ties(of_machine(presets.preset("paper-lightly-damped")))


def heard(family: Family, z: float = 6.0) -> Any:
    return SimpleNamespace(family=family, z=z, present=True, risen=True, chance=1e-6)


def family(key: str) -> Family:
    return next(f for f in TIE.families if f.key == key)


def seconds(monkeypatch: pytest.MonkeyPatch, first: str, second: str, *, stands: tuple[bool, ...]) -> list[str]:
    """Keys of what is told beside `first`, where `second` stands with only its lines taken out, or with its cage's too,
    as `stands` has it."""

    def stand(tests: Any, baselines: Any, tie: Ties, seed: int, explained: Any, *, lean: bool) -> Any:
        return (heard(family(second)),) if lean in stands else ()

    monkeypatch.setattr(struck, "candidates", stand)
    seen = [heard(family(first), 23.0), heard(family(second))]
    return [c.family.key for c in combs((), (), TIE, seen, 1)[1:]]


def test_twice_the_cage_of_a_struck_bearing_is_no_outer_race_of_the_slow_shaft(monkeypatch: pytest.MonkeyPatch) -> None:
    near = 2.0 * family("bearing1.cage").order / family("bearing3.outer").order
    assert abs(near - 1.0) < 0.01, "the case that is meant"
    told = ["bearing3.outer"]
    assert seconds(monkeypatch, "bearing1.outer", "bearing3.outer", stands=(True,)) == []
    assert seconds(monkeypatch, "bearing1.outer", "bearing3.outer", stands=(False,)) == told, "without the cage's"
    assert seconds(monkeypatch, "bearing1.outer", "bearing3.outer", stands=(True, False)) == told
    assert seconds(monkeypatch, "input.turn", "bearing3.outer", stands=(True,)) == told, "no cage of what is struck"


def test_a_race_elsewhere_needs_no_more_than_the_first_ones_lines_taken_out(monkeypatch: pytest.MonkeyPatch) -> None:
    for second in ("bearing3.inner", "bearing3.ball", "bearing1.inner"):
        assert seconds(monkeypatch, "bearing1.outer", second, stands=(True,)) == [second]
