"""What modulates the teeth at an order of no part is told; shafts, balls, one speed alone and forests are not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from reconcile.kinematics.spec import KinematicSpec, of_machine
from reconcile.machine.order_rises import _above_foot
from reconcile.machine.own_order import LEAST_AT_ONE_DB, OwnOrder, _known, _Seen, own_order
from reconcile.machine.sidebands import LEAST_LEVEL_DB
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import (
    CHANNELS,
    Modulation,
    at_hz,
    at_many,
    at_order,
    modulated,
    points_of,
    steady,
)

pytestmark = pytest.mark.slow
NAMES = [c.name for c in CHANNELS]
SPEEDS_HZ = (22.5, 30.0, 39.0)
OUTER, CAGE, SLOW = 2.57355, 0.36765, 23 / 81


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def told(
    machine: MachineSpec,
    now: Modulation,
    before: Modulation | None = steady,
    speeds_hz: Sequence[float] = SPEEDS_HZ,
    **more: object,
) -> OwnOrder | None:
    return own_order(machine, points_of(machine, now, before, speeds_hz, **more), NAMES)  # type: ignore[arg-type]


def all_of(orders: Sequence[float], depth: float = 0.1) -> Modulation:
    return lambda hz: sum((at_order(order, depth)(hz) for order in orders), steady(hz))


@pytest.mark.parametrize("order", [1.37, 1.9, 2.3])
def test_an_order_of_its_own_is_found(machine: MachineSpec, order: float) -> None:
    seen = told(machine, at_order(order, 0.1))
    assert seen is not None
    assert seen.order == pytest.approx(order, abs=0.01)
    assert (seen.shaft, seen.speeds) == ("input", (3, 3))
    assert "at every speed" in seen.text
    for k, speed in enumerate(SPEEDS_HZ):
        mesh = bases_at(machine, speed)["f_m"]
        below, above = seen.lines[2 * k : 2 * k + 2]
        assert (below.frequency_hz, above.frequency_hz) == pytest.approx(
            (mesh - seen.order * speed, mesh + seen.order * speed)
        )
        assert below.change_db > 6
        assert below.locked_to == ""
    assert [(s.site, s.weight) for s in seen.sites(machine)] == [("input", 0.5), ("output", 0.5)]


def test_it_is_found_in_recordings_that_were_observed(machine: MachineSpec) -> None:
    now = at_order(1.9, 0.1)
    tests = [modulated(machine, hz, 10 + k, now) for k, hz in enumerate(SPEEDS_HZ)]
    baselines = [modulated(machine, hz, k, steady) for k, hz in enumerate(SPEEDS_HZ)]
    seen = own_order(machine, observe(machine, watch_list(machine), tests, baselines, seed=0), NAMES)
    assert seen is not None and seen.order == pytest.approx(1.9, abs=0.02)


def test_two_speeds_of_three_are_enough_and_one_is_not(machine: MachineSpec) -> None:
    from_hz = lambda least: lambda hz: at_order(1.37, 0.1)(hz) if hz > least else steady(hz)  # noqa: E731
    seen = told(machine, from_hz(25.0))
    assert seen is not None and seen.speeds == (2, 3)
    assert {line.speed_hz for line in seen.lines} == {30.0, 39.0}
    assert told(machine, from_hz(35.0)) is None


def test_two_points_of_about_one_speed_are_one(machine: MachineSpec) -> None:
    """What stays in Hz has one order at both."""
    near_30 = lambda hz: at_hz(57.0, 0.1)(hz) if hz > 25.0 else steady(hz)  # noqa: E731
    assert told(machine, near_30, speeds_hz=(22.5, 30.0, 30.2), torque_ratios=(1.0, 1.0, 0.5)) is None
    assert told(machine, at_order(1.9, 0.1), speeds_hz=(22.5, 30.0, 30.2)).speeds == (2, 2)  # type: ignore[union-attr]


@pytest.mark.parametrize(("seconds", "slip"), [(1.2, 0.98), (2.0, 1.0), (1.2, 1.02), (2.0, 0.98)])
def test_what_a_part_modulates_with_is_none_nor_is_what_its_line_leaks(
    machine: MachineSpec, seconds: float, slip: float
) -> None:
    for orders in (
        (1.0, 2.0),
        (0.5, 1.5),
        (SLOW, 2 * SLOW, 3 * SLOW),
        (slip * OUTER,),
        (slip * OUTER * SLOW,),
        tuple(k * slip * OUTER * SLOW for k in (1, 2, 3)),
        (slip * OUTER - 1.0, slip * OUTER, slip * OUTER + 1.0),
    ):
        assert told(machine, all_of(orders, 0.2), seconds=seconds) is None, orders


@pytest.mark.parametrize("slip", [0.98, 1.0, 1.02])
def test_what_turns_as_a_cage_does_is_told_as_such(machine: MachineSpec, slip: float) -> None:
    """No known effect of a cage modulates teeth, and a belt may turn as slowly."""
    seen = told(machine, all_of(tuple(k * slip * CAGE for k in (1, 2, 3, 4)), 0.2))
    assert seen is not None and seen.cages == ("bearing1", "bearing2")
    assert any(seen.order == pytest.approx(k * slip * CAGE, abs=0.01) for k in (1, 2))
    assert "only the cage of bearing1 or bearing2 turns so" in seen.follows
    assert seen.beside == "the order of the cage of bearing1 or bearing2"
    weights = {s.site: s.weight for s in seen.sites(machine)}
    assert weights == {"input": 0.25, "output": 0.25, "bearing1": 0.25, "bearing2": 0.25}


def test_near_the_teeth_a_line_is_told_and_a_skirt_is_not(machine: MachineSpec) -> None:
    seen = told(machine, at_order(0.345, 0.1))
    assert seen is not None and seen.order == pytest.approx(0.345, abs=0.015)
    grid = np.arange(0.2, 2.0, 0.01)
    tie = _known(machine)[0]
    assert tie is not None
    skirt, line = 8.0 * np.exp(-(grid - 0.2) / 0.15), 5.0 * (np.abs(grid - 0.34) < 0.025)
    for every, above_db, clear in ((skirt, 6.0, False), (line, 6.0, True), (line, -6.0, False)):
        above = np.full(grid.size, above_db)  # the end of a skirt rises alone, but lies below its foot
        found = _Seen(grid=grid, every=every, above=above, bin_order=0.02, tie=tie, lowest=0.3)
        assert (found.stranger() is not None) is clear


def test_a_line_stands_above_its_foot_and_the_end_of_a_shelf_below() -> None:
    grid = np.arange(0.2, 1.0, 0.01)
    line = 20.0 * (np.abs(grid - 0.5) < 0.03)
    shelf = np.where(grid < 0.345, 30.0, 0.0)
    at = lambda level, order: float(_above_foot(level)[int(np.argmin(np.abs(grid - order)))])  # noqa: E731
    assert at(line, 0.5) == pytest.approx(20.0)
    assert at(shelf, 0.34) == pytest.approx(0.0) and at(shelf, 0.36) == pytest.approx(-30.0)
    assert at(line, 0.25) == 0.0 and _above_foot(np.ones(5)).tolist() == [0.0] * 5


@pytest.mark.parametrize(("foot_db", "told_at"), [(0.0, 0.34), (30.0, None)])
def test_what_has_risen_at_the_end_of_a_skirt_is_none(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch, foot_db: float, told_at: float | None
) -> None:
    """By levels of recordings, as x045 of the proof has them: a line of 20 dB at 0.34 turns, new at every speed, is a
    stranger, and none where test and baseline are louder towards the teeth's line."""

    def levels(_one: object, reached: Sequence[object], grid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        rest = LEAST_LEVEL_DB + np.where(grid < 0.31, foot_db, 0.0)
        test = rest + 20.0 * (np.abs(grid - 0.34) < 0.025)
        return tuple(np.broadcast_to(row, (2 * len(reached), len(NAMES), grid.size)).copy() for row in (test, rest))  # type: ignore[return-value]

    monkeypatch.setattr("reconcile.machine.order_rises.levels_by_order", levels)
    seen = told(machine, steady)
    assert (None if seen is None else round(seen.order, 2)) == told_at


def test_beside_the_parts_a_stranger_is_told(machine: MachineSpec) -> None:
    parts = all_of((SLOW * 2, 0.985 * OUTER, OUTER - 1.0), 0.05)
    assert told(machine, parts) is None
    stranger = told(machine, lambda hz: parts(hz) + at_order(1.9, 0.05)(hz))
    assert stranger is not None and stranger.order == pytest.approx(1.9, abs=0.02)


def test_forests_and_what_stays_in_hz_are_none(machine: MachineSpec) -> None:
    assert told(machine, steady) is None
    assert told(machine, at_many) is None
    assert told(machine, at_hz(57.0)) is None


@pytest.mark.parametrize("before", [0.02, 0.1])
def test_what_the_baseline_has_is_none_even_if_it_has_grown(machine: MachineSpec, before: float) -> None:
    assert told(machine, at_order(1.9, 1.8 * before), at_order(1.9, before)) is None


def test_noise_says_nothing(machine: MachineSpec) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        depth = float(rng.uniform(0.0, 0.002))
        assert told(machine, at_order(1.9, depth), speeds_hz=(22.5, 30.0), seconds=0.6) is None


@pytest.mark.parametrize(("depth", "found"), [(0.2, True), (0.01, False)])
def test_at_one_speed_alone_it_must_stand_out_far(machine: MachineSpec, depth: float, found: bool) -> None:
    """As a belt (j071 of the proof) does; what is enough at two speeds a sound machine has at one."""
    one = told(machine, at_order(1.9, depth), speeds_hz=(30.0,))
    assert (one is not None) is found
    assert told(machine, at_order(1.9, depth), speeds_hz=(22.5, 30.0)) is not None
    if one is not None:
        assert one.order == pytest.approx(1.9, abs=0.02) and one.rise_db > LEAST_AT_ONE_DB
        assert "at the one speed recorded" in one.text and "one speed cannot tell" in one.follows
        assert one.speeds == (1, 1) and {line.speed_hz for line in one.lines} == {30.0}
    near = told(machine, at_order(1.9, depth), speeds_hz=(30.0, 30.2))
    assert (near is not None) is found, "two points of about one speed are one"


def test_at_one_speed_a_forest_and_a_part_are_none(machine: MachineSpec) -> None:
    assert told(machine, at_many, speeds_hz=(30.0,)) is None
    assert told(machine, all_of((1.0, 2.0, OUTER), 0.2), speeds_hz=(30.0,)) is None
    cage = told(machine, at_order(CAGE, 0.2), speeds_hz=(30.0,))
    assert cage is not None and "but the cage of bearing1 or bearing2" in cage.follows


def test_without_baselines_or_teeth_nothing_is_said(machine: MachineSpec) -> None:
    assert told(machine, at_order(1.9), None) is None
    assert told(machine, at_order(1.9), seconds=0.1) is None, "no order is ten bins from the teeth"
    turning = points_of(machine, at_order(1.9))
    for name in ("rotor", "bearing-rig"):
        assert own_order(preset(name), turning, NAMES) is None


def test_a_bearing_of_which_no_sizes_are_known_may_turn_at_any_order(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fewer(spec: MachineSpec) -> KinematicSpec:
        known = of_machine(spec)
        return known.model_copy(update={"bearings": known.bearings[1:]})

    monkeypatch.setattr("reconcile.machine.own_order.of_machine", fewer)
    assert told(machine, at_order(1.9)) is None


def test_the_flat_top_of_a_shafts_strong_line_is_the_shafts(machine: MachineSpec) -> None:
    """What a broken tooth of the proof raises about the second turn, dB: the highest point is not the middle."""
    tie = _known(machine)[0]
    assert tie is not None
    risen = [3, 3, 3, 9, 13, 13, 17, 21, 21, 22, *[21.5] * 10, 20, 20, 14, 12, 12, 7, 4, 3, 3]
    grid = np.arange(0.4, 3.0, 0.01)
    for first, stranger in ((1.86, False), (2.2, True)):
        every = np.zeros(grid.size)
        begin = int(np.argmin(np.abs(grid - first)))
        every[begin : begin + len(risen)] = risen
        seen = _Seen(grid=grid, every=every, above=every, bin_order=0.049, tie=tie)
        assert (seen.stranger() is not None) == stranger


@pytest.mark.parametrize(("middle", "stranger"), [(2.2, False), (3.4, True)])
def test_where_only_a_flank_has_risen_enough_there_is_no_line(
    middle: float, stranger: bool, machine: MachineSpec
) -> None:
    """Beside an eccentric gear (h100 of the proof) the tenth of its turns rose by 2.2 dB, and its flank by 3."""
    tie = _known(machine)[0]
    assert tie is not None
    grid = np.arange(0.4, 3.0, 0.01)
    every = np.zeros(grid.size)
    begin = int(np.argmin(np.abs(grid - 1.86)))
    every[begin : begin + 9] = [3.2, 3.0, 2.8, middle, middle, middle, 2.8, 2.8, 2.8]
    seen = _Seen(grid=grid, every=every, above=every, bin_order=0.049, tie=tie)
    assert (seen.stranger() is not None) == stranger
