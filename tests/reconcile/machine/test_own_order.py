"""What modulates the teeth at an order of no part is told; shafts, balls, one speed alone and forests are not."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pytest

from reconcile.kinematics.families import ties
from reconcile.kinematics.spec import KinematicSpec, of_machine
from reconcile.machine.own_order import OwnOrder, of_no_part, own_order
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import CHANNELS, Modulation, at_hz, at_many, at_order, modulated, steady

NAMES = [c.name for c in CHANNELS]
SPEEDS_HZ = (22.5, 30.0, 39.0)
OUTER, SLOW = 2.57355, 23 / 81


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def told(
    machine: MachineSpec,
    now: Modulation,
    before: Modulation | None = steady,
    speeds_hz: Sequence[float] = SPEEDS_HZ,
) -> OwnOrder | None:
    tests = [modulated(machine, hz, 10 + k, now) for k, hz in enumerate(speeds_hz)]
    baselines = [] if before is None else [modulated(machine, hz, k, before) for k, hz in enumerate(speeds_hz)]
    return own_order(machine, observe(machine, watch_list(machine), tests, baselines, seed=0), NAMES)


@pytest.mark.slow
@pytest.mark.parametrize("order", [1.37, 2.3])
def test_an_order_of_its_own_is_found(machine: MachineSpec, order: float) -> None:
    seen = told(machine, at_order(order, 0.1))
    assert seen is not None
    assert seen.order == pytest.approx(order, abs=0.02)
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


@pytest.mark.slow
def test_two_speeds_of_three_are_enough_and_one_is_not(machine: MachineSpec) -> None:
    from_hz = lambda least: lambda hz: at_order(1.37, 0.1)(hz) if hz > least else steady(hz)  # noqa: E731
    seen = told(machine, from_hz(25.0))
    assert seen is not None and seen.speeds == (2, 3)
    assert {line.speed_hz for line in seen.lines} == {30.0, 39.0}
    assert told(machine, from_hz(35.0)) is None


@pytest.mark.slow
def test_what_a_part_modulates_with_is_none(machine: MachineSpec) -> None:
    orders = (1.0, 2.0, SLOW * 2, 0.985 * OUTER, 1.01 * OUTER * SLOW, OUTER - 1.0, 0.37)
    parts = lambda hz: sum((at_order(order, 0.05)(hz) for order in orders), steady(hz))  # noqa: E731
    assert told(machine, parts) is None
    stranger = told(machine, lambda hz: parts(hz) + at_order(1.9, 0.05)(hz))
    assert stranger is not None and stranger.order == pytest.approx(1.9, abs=0.02), "each of them would be told"


@pytest.mark.slow
def test_forests_and_what_stays_in_hz_or_the_baseline_has_are_none(machine: MachineSpec) -> None:
    assert told(machine, steady) is None
    assert told(machine, at_many) is None
    assert told(machine, at_hz(47.0)) is None
    assert told(machine, at_order(1.37), at_order(1.37)) is None


@pytest.mark.slow
def test_without_speeds_or_baselines_nothing_is_said(machine: MachineSpec) -> None:
    assert told(machine, at_order(1.37), speeds_hz=(30.0,)) is None
    assert told(machine, at_order(1.37), None) is None


@pytest.mark.slow
def test_a_bearing_of_which_no_sizes_are_known_may_turn_at_any_order(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fewer(spec: MachineSpec) -> KinematicSpec:
        known = of_machine(spec)
        return known.model_copy(update={"bearings": known.bearings[1:]})

    monkeypatch.setattr("reconcile.machine.own_order.of_machine", fewer)
    assert told(machine, at_order(1.37)) is None


def test_most_low_orders_are_some_parts(machine: MachineSpec) -> None:
    grid = np.arange(0.4, 3.0, 0.01)
    free = of_no_part(grid, ties(of_machine(machine), "input"), 0.04)
    assert 0.2 < free.mean() < 0.7
    for order in (0.5, 1.0, 2.07, 1.02 * OUTER, 0.98 * OUTER * SLOW, OUTER - 1.0):
        assert not free[int(np.argmin(np.abs(grid - order)))], order
    assert free[int(np.argmin(np.abs(grid - 1.9)))]
