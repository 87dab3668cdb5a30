"""What modulates the teeth many times a turn is told; combs, balls, what is watched elsewhere and one speed are not."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from reconcile.machine.many_turns import (
    ManyTurns,
    many_turns,
)
from reconcile.observe.observation import PointData, observe
from reconcile.observe.watch import bases_at, watch_list
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import (
    CHANNELS,
    TIME,
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
OUTER, SLOW = 2.57355, 23 / 81


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def told(
    machine: MachineSpec,
    now: Modulation,
    before: Modulation | None = steady,
    speeds_hz: Sequence[float] = SPEEDS_HZ,
    **more: Any,
) -> ManyTurns | None:
    return many_turns(machine, points_of(machine, now, before, speeds_hz, **more), NAMES)


def all_of(orders: Sequence[float], depth: float = 0.1) -> Modulation:
    return lambda hz: sum((at_order(order, depth)(hz) for order in orders), steady(hz))


@pytest.mark.parametrize("turns", [4, 6, 8])
def test_many_times_a_turn_is_found(machine: MachineSpec, turns: int) -> None:
    seen = told(machine, at_order(turns, 0.1))
    assert seen is not None
    assert (seen.shaft, seen.turns, seen.order, seen.speeds) == ("input", turns, float(turns), (3, 3))
    assert seen.rise_db > 15.0 and seen.elsewhere_db < 1.0
    assert f"{turns} times a turn of input at every speed, new" in seen.text
    assert len(seen.lines) == 6
    for k, speed in enumerate(SPEEDS_HZ):
        mesh = bases_at(machine, speed)["f_m"]
        below, above = seen.lines[2 * k : 2 * k + 2]
        assert (below.frequency_hz, above.frequency_hz) == pytest.approx((mesh - turns * speed, mesh + turns * speed))
        assert (below.label, above.label) == (f"teeth - {turns}*input", f"teeth + {turns}*input")
        assert below.change_db > 6 and below.speed_hz == speed
        assert below.channel in NAMES and {below.locked_to, above.locked_to} == {"input"}


def test_it_is_found_in_recordings_that_were_observed(machine: MachineSpec) -> None:
    tests = [modulated(machine, hz, 10 + k, at_order(4.0, 0.1)) for k, hz in enumerate(SPEEDS_HZ[:2])]
    baselines = [modulated(machine, hz, k, steady) for k, hz in enumerate(SPEEDS_HZ[:2])]
    seen = many_turns(machine, observe(machine, watch_list(machine), tests, baselines, seed=0), NAMES)
    assert seen is not None and (seen.shaft, seen.turns, seen.speeds) == ("input", 4, (2, 2))


@pytest.mark.parametrize("turns", [4, 6, 10])
def test_of_the_slow_shaft_too(machine: MachineSpec, turns: int) -> None:
    seen = told(machine, at_order(turns * SLOW, 0.1))
    assert seen is not None and (seen.shaft, seen.turns) == ("output", turns)
    assert seen.order == pytest.approx(turns * SLOW)


@pytest.mark.parametrize("order", [1.0, 2.0, 3.0, SLOW, 2 * SLOW, 3 * SLOW])
def test_what_is_watched_elsewhere_is_none(machine: MachineSpec, order: float) -> None:
    assert told(machine, at_order(order, 0.2)) is None


@pytest.mark.parametrize(("teeth", "order"), [(69, 2.0), (46, 2.0), (46, 3.0)])
def test_what_is_watched_of_one_shaft_is_not_told_of_another(machine: MachineSpec, teeth: int, order: float) -> None:
    """At a ratio of 1:3 two turns of the input are six of the output."""
    gears = [gear.model_copy(update={"teeth": teeth}) if gear.teeth == 81 else gear for gear in machine.gears]
    geared = machine.model_copy(update={"gears": gears})
    assert told(geared, at_order(order, 0.2)) is None
    seen = told(geared, at_order(4.0, 0.1))
    assert seen is not None and (seen.shaft, seen.turns) == ("input", 4), "and of both the one with fewer turns"


@pytest.mark.parametrize("order", [0.5, 1.37, 1.67, 1.9, 2.3, 2.335, 4.04, 4.06, 4.2, 6.45])
def test_what_is_no_multiple_is_none(machine: MachineSpec, order: float) -> None:
    """Nor is the flank of a line that stands beside one."""
    assert told(machine, at_order(order, 0.03)) is None
    assert told(machine, at_order(order, 0.2)) is None


def test_a_tooth_strikes_once_a_turn_and_raises_every_multiple(machine: MachineSpec) -> None:
    for depth in (0.02, 0.05, 0.1):
        assert told(machine, all_of(range(1, 11), depth)) is None
        assert told(machine, all_of([k * SLOW for k in range(1, 36)], depth)) is None
    assert told(machine, all_of((3, 4, 5), 0.1)) is None
    assert told(machine, all_of((4, 6), 0.1)) is None, "of two that no common one explains neither stands out"


@pytest.mark.parametrize("orders", [(4.0, 8.0), (4 * SLOW, 8 * SLOW, 12 * SLOW)])
def test_its_own_multiples_do_not_hinder_it(machine: MachineSpec, orders: tuple[float, ...]) -> None:
    seen = told(machine, lambda hz: at_order(min(orders), 0.2)(hz) + all_of(orders, 0.05)(hz))
    assert seen is not None and seen.turns == 4 and seen.elsewhere_db < 1.0


@pytest.mark.parametrize("slip", [0.98, 0.9934, 1.0, 1.02])
@pytest.mark.parametrize("harmonic", [1, 2])
def test_balls_that_pass_are_none(machine: MachineSpec, slip: float, harmonic: int) -> None:
    """With some slip the outer race's first line is nine turns of the slow shaft."""
    assert told(machine, at_order(harmonic * slip * OUTER, 0.2)) is None
    assert told(machine, at_order(harmonic * slip * OUTER * SLOW, 0.2)) is None


@pytest.mark.parametrize("turns", [5, 7, 9])
def test_a_multiple_that_may_be_a_bearings_second_line_cannot_be_told(machine: MachineSpec, turns: int) -> None:
    """Twice 2.574, 3.513 and 4.426, within their slip."""
    assert told(machine, at_order(turns, 0.1)) is None


def test_what_the_baseline_has_is_none_even_if_it_has_grown(machine: MachineSpec) -> None:
    assert told(machine, at_order(4.0, 0.2), at_order(4.0, 0.2)) is None
    assert told(machine, at_order(4.0, 0.2), at_order(4.0, 0.03)) is None


def above(least_hz: float) -> Modulation:
    return lambda hz: at_order(4.0, 0.1)(hz) if hz > least_hz else steady(hz)


def test_one_speed_of_three_may_be_a_resonance(machine: MachineSpec) -> None:
    seen = told(machine, above(25.0))
    assert seen is not None and seen.speeds == (2, 3) and "input at 2 of 3 speeds" in seen.text
    assert {line.speed_hz for line in seen.lines} == {30.0, 39.0}
    assert told(machine, above(35.0)) is None


def with_line(machine: MachineSpec, order: float, now: Modulation) -> tuple[PointData, ...]:
    """A line of something else at so many orders, beside the second harmonic of the teeth."""
    data = points_of(machine, now, speeds_hz=SPEEDS_HZ)
    for one, hz in zip(data, SPEEDS_HZ, strict=True):
        test: Any = one.spectra[0]
        test.samples = test.samples + 0.5 * np.sin(2 * np.pi * order * hz * TIME)
    return data


def test_a_line_of_something_else_on_one_sideband_is_none_and_hides_none(machine: MachineSpec) -> None:
    assert many_turns(machine, with_line(machine, 2 * 23 - 4.0, steady), NAMES) is None
    seen = many_turns(machine, with_line(machine, 2 * 23 - 1.37, at_order(4.0, 0.02)), NAMES)
    assert seen is not None and seen.turns == 4 and seen.rise_db < 12.0 and seen.elsewhere_db < 1.0


def test_what_stays_in_hz_and_forests_are_none(machine: MachineSpec) -> None:
    """120 Hz are four turns at one speed alone."""
    assert told(machine, at_hz(120.0, 0.1)) is None
    assert told(machine, at_many) is None


def test_noise_says_nothing(machine: MachineSpec) -> None:
    rng = np.random.default_rng(3)
    for _ in range(12):
        depth = float(rng.uniform(0.0, 0.002))
        assert told(machine, at_order(4.0, depth), speeds_hz=(22.5, 30.0), seconds=1.0) is None


def test_without_speeds_baselines_or_teeth_nothing_is_said(machine: MachineSpec) -> None:
    four = at_order(4.0, 0.1)
    assert told(machine, four, speeds_hz=(30.0,)) is None
    assert told(machine, four, speeds_hz=(30.0, 30.5)) is None
    assert told(machine, four, None) is None
    assert many_turns(machine, (), NAMES) is None
    turning = points_of(machine, four)
    for name in ("rotor", "bearing-rig"):
        assert many_turns(preset(name), turning, NAMES) is None
    assert many_turns(machine.model_copy(update={"operating": None}), turning, NAMES) is None
    untied = machine.model_copy(update={"meshes": []})
    assert many_turns(untied, turning, NAMES) is None, "shafts that nothing ties"


def test_the_text_and_the_stage_say_what_is_seen() -> None:
    seen = ManyTurns(shaft="input", turns=4, order=4.0, rise_db=9.0, elsewhere_db=0.5, speeds=(3, 3))
    assert seen.text == "the teeth's lines are modulated 4 times a turn of input at every speed, new since the baseline"
    assert "input at 2 of 3 speeds, new" in replace(seen, speeds=(2, 3)).text
    assert seen.stage == {"name": "many turns", "turns": 4, "shaft": "input", "rise_db": 9.0, "elsewhere_db": 0.5}
