"""Rules of what acts many times a turn, on rises at single orders: how much, how new, how near, how far apart."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from reconcile.kinematics.families import Family, Kind, Ties
from reconcile.machine.many_turns import (
    AHEAD,
    APART,
    HIGHEST_ORDER,
    LEAST_DB,
    MOST_BEFORE_DB,
    MOST_TURNS,
    NEAR,
    ManyTurns,
    _multiples,
    _of_a_bearing,
    many_turns,
)
from reconcile.machine.order_rises import Rises
from reconcile.machine.sidebands import LEAST_LEVEL_DB
from reconcile.observe.observation import PointData
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import (
    CHANNELS,
    points_of,
    steady,
)

pytestmark = pytest.mark.slow
NAMES = [c.name for c in CHANNELS]
SPEEDS_HZ = (22.5, 30.0, 39.0)


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def made(
    machine: MachineSpec, risen: dict[float, float], *, before: float = 0.0, bin_order: float = 0.02, end: float = 10.35
) -> Any:
    """Rises of single orders, dB, alike at two speeds, with `before` in the baselines; one sideband rose more."""
    grid = np.arange(0.5, end, 0.01)
    every = np.zeros(grid.size)
    for order, rise in risen.items():
        every[int(np.argmin(np.abs(grid - order)))] = rise
    data = points_of(machine, steady, speeds_hz=SPEEDS_HZ[:2], seconds=0.1)
    cube = np.broadcast_to(every, (6, 2, grid.size))
    groups = [[0], [1]]
    level = np.full(cube.shape, LEAST_LEVEL_DB + before)
    return lambda *_args: Rises(
        data=data, grid=grid, each=(cube, cube), before=(level, level), every=1.2 * every, spread=every, groups=groups,
        above=every, bin_order=bin_order, mesh=0,
    )  # fmt: skip


@pytest.fixture
def risen(machine: MachineSpec, monkeypatch: pytest.MonkeyPatch) -> Any:
    def of(orders: dict[float, float], **more: float) -> ManyTurns | None:
        monkeypatch.setattr("reconcile.machine.many_turns.rises_by_order", made(machine, orders, **more))
        return many_turns(machine, (object(),), NAMES)  # type: ignore[arg-type]

    return of


def test_it_has_risen_by_a_least_and_ahead_of_all_else(risen: Any) -> None:
    assert risen({4.0: LEAST_DB + 0.01}).rise_db == pytest.approx(LEAST_DB + 0.01)
    assert risen({4.0: LEAST_DB - 0.01}) is None
    seen = risen({4.0: 2.0 * AHEAD + 0.01, 1.37: 2.0})
    assert seen.turns == 4 and seen.elsewhere_db == 2.0
    assert risen({4.0: 2.0 * AHEAD - 0.01, 1.37: 2.0}) is None


def test_it_is_new_up_to_a_level(risen: Any) -> None:
    assert risen({4.0: 9.0}, before=MOST_BEFORE_DB - 0.01) is not None
    assert risen({4.0: 9.0}, before=MOST_BEFORE_DB + 0.01) is None


def test_a_lines_middle_is_at_a_multiple_to_some_thousandths_of_a_turn_or_a_third_of_a_bin(risen: Any) -> None:
    assert risen({4.01: 9.0}).order == 4.0 and risen({3.99: 9.0}).order == 4.0
    assert risen({4.02: 9.0}) is None and risen({3.98: 9.0}) is None
    assert risen({4.02: 9.0}, bin_order=0.06).turns == 4
    assert risen({4.02: 9.0}, bin_order=0.05) is None
    flat = {4.0 + 0.01 * k: 9.0 for k in range(-6, 9)}
    assert risen(flat).turns == 4, "a broad line's middle, whatever its highest point"
    assert risen({4.0 + 0.01 * k: 9.0 for k in range(-3, 8)}) is None
    assert risen({4.0: 9.0, 4.1: 4.4}).turns == 4, "of what is half as high"
    assert risen({4.0: 9.0, 4.1: 4.6}) is None
    assert risen({4.0: 9.0, 4.04: 4.6}).turns == 4, "its centre of gravity"


def test_what_is_within_some_hundredths_of_a_turn_or_half_a_bin_is_at_it(risen: Any) -> None:
    split = {3.95: 9.0, 4.05: 9.0}
    assert risen(split) is None and risen(split, bin_order=0.08) is None
    assert risen(split, bin_order=0.12).turns == 4


def test_what_is_beside_it_is_its_own_foot_up_to_where_another_line_may_be(risen: Any) -> None:
    for foot in (4.0 + APART - 0.015, 8.0 - APART + 0.015):
        assert risen({4.0: 9.0, foot: 4.4}).elsewhere_db == 0.0
    for other in (4.0 + APART + 0.015, 4.0 - APART - 0.015, 8.0 + APART + 0.015, 6.0):
        assert risen({4.0: 9.0, other: 4.4}) is None
    assert risen({4.0: 9.0, 11.9: 8.0}, end=11.95).elsewhere_db == 0.0, "of a multiple that is beyond the end"
    assert risen({4.0: 9.0, 4.0 + APART + 0.015: 4.4}, bin_order=0.16).elsewhere_db == 0.0, "a bin"


def multiples(rises: Rises, near: float, slow: float) -> dict[str, list[int]]:
    both = Ties(reference="a", shafts={"a": 1.0, "b": slow}, families=(), meshes=(), races={})
    found = _multiples(rises, both, near)
    assert max(found)[2:] == ("a", 4), "the largest, of equals that of fewer turns"
    return {shaft: [turns for _, _, name, turns in found if name == shaft] for shaft in "ab"}


def test_multiples_are_those_beyond_what_is_watched_of_any_shaft(machine: MachineSpec) -> None:
    """Four to twelve of each; five of the second are two of the first, and ten are four."""
    rises = made(machine, {4.0: 9.0})()
    assert multiples(rises, NEAR, 0.4) == {"a": [4, 5, 6, 7, 8, 9, 10], "b": [4, 6, 7, 8, 9, 10, 11, MOST_TURNS]}
    assert multiples(made(machine, {4.0: 9.0}, end=14.0)(), NEAR, 0.4)["a"][-1] == MOST_TURNS
    assert 7 in multiples(rises, 0.07, 0.45)["b"] and 7 not in multiples(rises, 0.08, 0.45)["b"], "3.15 beside 3"
    assert multiples(rises, 0.099, 0.4)["b"] and not multiples(rises, 0.101, 0.4)["b"], "too near each other"


def test_multiples_are_looked_at_up_to_an_order(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch, risen: Any
) -> None:
    asked: list[tuple[float, float]] = []

    def spied(_machine: object, _data: object, _tie: object, lowest: float, highest: float) -> None:
        asked.append((lowest, highest))

    assert risen({10.0: 9.0}).turns == 10
    monkeypatch.setattr("reconcile.machine.many_turns.rises_by_order", spied)
    data: tuple[PointData, ...] = (object(),)  # type: ignore[assignment]
    assert many_turns(machine, data, NAMES) is None
    assert asked == [(0.5, HIGHEST_ORDER)] and HIGHEST_ORDER == 14.0


def test_the_largest_multiple_is_told(risen: Any) -> None:
    assert risen({4.0: 9.0 / AHEAD + 0.1, 8.0: 9.0}) is None, "the fourth is no multiple of the eighth"
    assert risen({4.0: 9.0 / AHEAD - 0.1, 8.0: 9.0}).turns == 8
    seen = risen({8.0: 8.0, 4.0: 9.0})
    assert (seen.turns, seen.rise_db) == (4, 9.0)


@pytest.mark.parametrize("harmonic", [1, 2])
def test_a_line_may_be_a_bearings_within_one_and_a_half_times_its_slip(harmonic: int) -> None:
    def of(kind: Kind, slip: float) -> Ties:
        part = Family(kind=kind, site="b", order=2.0, spacing=0.0, sidebands=0, slip=slip)
        return Ties(reference="a", shafts={"a": 1.0}, families=(part,), meshes=(), races={})

    middle, reach = 2.0 * harmonic, NEAR + 1.5 * 0.02 * 2.0 * harmonic
    slipping = of("outer", 0.02)
    for side in (-1.0, 1.0):
        assert _of_a_bearing(middle + side * (reach - 1e-6), slipping, NEAR)
        assert not _of_a_bearing(middle + side * (reach + 1e-6), slipping, NEAR)
    assert not _of_a_bearing(6.0, slipping, NEAR), "the third"
    assert not _of_a_bearing(middle, of("turn", 0.0), NEAR), "a shaft's own turns"
