"""A strong line of the signal itself that no part makes is told; modulated teeth and multiples of a shaft are not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from reconcile.machine.own_line import OwnLine, own_line
from reconcile.machine.strange import strange, with_strange
from reconcile.observe.observation import observe
from reconcile.observe.watch import watch_list
from signals.series import FloatArray
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import CHANNELS, TIME, at_order, modulated, steady
from tests.reconcile.machine.test_strange import said

pytestmark = pytest.mark.slow
SPEEDS_HZ = (22.5, 30.0, 39.0)
Adds = Callable[[float], FloatArray]


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def turning(order: float, level: float = 0.6) -> Adds:
    return lambda hz: level * np.sin(2 * np.pi * order * hz * TIME)


def told(machine: MachineSpec, adds: Adds, *, only_hz: float | None = None, based: bool = True) -> OwnLine | None:
    tests, baselines = [], []
    for k, hz in enumerate(SPEEDS_HZ):
        one = modulated(machine, hz, 10 + k, steady)
        there = only_hz is None or hz == only_hz
        tests.append(replace(one, samples=one.samples + (adds(hz) if there else 0.0)))
        baselines.append(modulated(machine, hz, k, steady))
    data = observe(machine, watch_list(machine), tests, baselines if based else [], seed=0)
    found = own_line(machine, data, CHANNELS)
    if found is not None:
        assert strange(machine, data, CHANNELS, ()) == found, "nothing else tells it"
    return found


@pytest.mark.parametrize("order", [0.44, 1.75, 7.3])
def test_a_line_of_its_own_is_told(machine: MachineSpec, order: float) -> None:
    seen = told(machine, turning(order))
    assert seen is not None
    assert seen.strongest.order == pytest.approx(order, rel=0.02)
    assert seen.speeds == (3, 3) and "at every speed" in seen.text
    assert ("Whirl" in seen.follows) == (order == 0.44)
    for line in seen.lines:
        assert line.frequency_hz == pytest.approx(order * line.speed_hz, rel=0.02)


def test_vanes_that_pass_are_told_as_a_multiple_of_the_shaft(machine: MachineSpec) -> None:
    seen = told(machine, turning(7.0))
    assert seen is not None and seen.strongest.multiple == ("input", 7.0)
    assert "7 vanes" in seen.follows and "No part" not in seen.follows


@pytest.mark.parametrize(
    "adds", [turning(23.0), turning(2.0), turning(23 / 81), turning(0.5), steady, turning(1.75, level=0.02)]
)
def test_what_a_shaft_makes_and_what_is_faint_is_none(machine: MachineSpec, adds: Adds) -> None:
    assert told(machine, adds) is None


def test_beside_a_name_it_is_not_told(machine: MachineSpec) -> None:
    seen = told(machine, turning(7.3))
    assert with_strange(said("explained"), seen, machine, {}) == said("explained"), "it may be a multiple of its lines"
    report = with_strange(said("nothing_missing"), seen, machine, {})
    assert report.verdict == "unknown_physics" and "7.3 times the speed of input" in report.sentence


def test_one_speed_of_three_and_no_baseline_are_not_enough(machine: MachineSpec) -> None:
    assert told(machine, turning(1.75), only_hz=30.0) is None
    assert told(machine, turning(1.75), based=False) is None


def test_teeth_that_are_modulated_are_another_matter(machine: MachineSpec) -> None:
    tests = [modulated(machine, hz, 10 + k, at_order(1.37, 0.1)) for k, hz in enumerate(SPEEDS_HZ)]
    baselines = [modulated(machine, hz, k, steady) for k, hz in enumerate(SPEEDS_HZ)]
    assert own_line(machine, observe(machine, watch_list(machine), tests, baselines, seed=0), CHANNELS) is None
