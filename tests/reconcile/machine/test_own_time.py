"""What modulates the teeth at one frequency in Hz at every speed is told; orders, hum and forests of lines are not."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.atlas.plan import Point
from reconcile.machine.own_time import (
    AHEAD,
    AT_ONE_DB,
    BESIDE,
    FAINT_DB,
    LOW,
    LOWEST_HZ,
    OWN_HZ,
    SEPARATE_HZ,
    STEP_HZ,
    SUPPLY_AT_TWO_DB,
    SUPPLY_FAINT_DB,
    OwnTime,
    _an_order,
    _falls,
    _Search,
    own_time,
)
from reconcile.observe.extract import USABLE
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import (
    CHANNELS,
    RATE_HZ,
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
SPEEDS_HZ = (22.5, 30.0)


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def told(
    machine: MachineSpec,
    now: Modulation,
    before: Modulation | None = steady,
    speeds_hz: Sequence[float] = SPEEDS_HZ,
    hum: float = 0.0,
) -> OwnTime | None:
    return own_time(machine, points_of(machine, now, before, speeds_hz, hum=hum), NAMES)


def test_it_is_found_in_recordings_that_were_observed(machine: MachineSpec) -> None:
    tests = [modulated(machine, hz, 10 + k, at_hz(100.0)) for k, hz in enumerate(SPEEDS_HZ)]
    baselines = [modulated(machine, hz, k, steady) for k, hz in enumerate(SPEEDS_HZ)]
    seen = own_time(machine, observe(machine, watch_list(machine), tests, baselines, seed=0), NAMES)
    assert seen is not None and seen.hz == pytest.approx(100.0, abs=0.7)


@pytest.mark.parametrize(("hz", "supply_hz"), [(100.0, 50.0), (60.0, 60.0), (37.0, None)])
def test_a_frequency_of_its_own_is_found(machine: MachineSpec, hz: float, supply_hz: float | None) -> None:
    speeds_hz = (22.5, 31.0)
    seen = told(machine, at_hz(hz), speeds_hz=speeds_hz)
    assert seen is not None
    assert seen.hz == pytest.approx(hz, abs=0.7)
    assert seen.supply_hz == supply_hz
    assert {line.locked_to for line in seen.lines} == {"mains" if supply_hz else ""}
    assert {line.channel for line in seen.lines} <= set(NAMES)
    for k, speed in enumerate(speeds_hz):
        mesh = bases_at(machine, speed)["f_m"]
        below, above = seen.lines[2 * k : 2 * k + 2]
        assert (below.frequency_hz, above.frequency_hz) == pytest.approx((mesh - seen.hz, mesh + seen.hz))
        assert below.speed_hz == speed
        assert below.change_db > 6


def test_a_speed_at_which_the_path_is_deaf_does_not_hide_it(machine: MachineSpec) -> None:
    speeds_hz = (22.5, 30.0, 39.0)
    seen = told(machine, lambda hz: (at_hz(100.0) if hz > 25.0 else steady)(hz), speeds_hz=speeds_hz)
    assert seen is not None and seen.hz == pytest.approx(100.0, abs=0.7)
    assert seen.speeds == (2, 3) and "at 2 of 3 speeds" in seen.text
    assert {line.speed_hz for line in seen.lines} == {30.0, 39.0}
    assert told(machine, lambda hz: (at_hz(100.0) if hz > 35.0 else steady)(hz), speeds_hz=speeds_hz) is None
    # 90 Hz is the third order at one speed and the fourth at another
    both = {30.0: at_order(3.0), 22.5: at_order(4.0), 39.0: steady}
    assert told(machine, lambda hz: both[hz](hz), speeds_hz=speeds_hz) is None
    races = lambda hz: at_order(2.57355)(hz) + at_order(4.42645)(hz)  # noqa: E731
    assert told(machine, races, speeds_hz=speeds_hz) is None, "the races' lines meet at 100 Hz at two speeds"
    high = lambda hz: at_order(7.0)(hz) + at_order(8.0)(hz)  # noqa: E731
    assert told(machine, high, speeds_hz=(21.0, 24.0, 33.0)) is None, "orders 7 and 8 meet at 168 Hz"
    every = told(machine, at_hz(100.0), speeds_hz=speeds_hz)
    assert every is not None and every.speeds == (3, 3) and "at every speed" in every.text


@pytest.mark.parametrize(("faint", "found"), [(0.0, False), (0.0005, False), (0.001, True), (0.003, True)])
def test_where_parts_meet_at_two_speeds_a_third_that_shows_it_faintly_decides(
    machine: MachineSpec, faint: float, found: bool
) -> None:
    """100 Hz is the inner race's at 22.5 Hz, the outer one's at 39 Hz, and none of theirs at 30 Hz."""
    inner, outer = 4.42645 * 22.5, 2.57355 * 39.0
    assert abs(inner - 100.0) < OWN_HZ and abs(outer - 100.0) < OWN_HZ
    depth = {22.5: 0.1, 30.0: faint, 39.0: 0.1}
    seen = told(machine, lambda hz: at_hz(100.0, depth[hz])(hz), speeds_hz=(22.5, 30.0, 39.0))
    if not found:
        assert seen is None
        return
    assert seen is not None and seen.hz == pytest.approx(100.0, abs=0.7)
    assert seen.speeds == (2, 3) and seen.rise_db > 15.0, "by the speeds that show it clearly"
    assert {line.speed_hz for line in seen.lines} == {22.5, 39.0}


def test_faintly_is_above_what_sound_machines_come_to_and_ahead_of_all_else_there() -> None:
    grid = np.arange(LOWEST_HZ, 260.0, STEP_HZ)
    best = int(np.argmin(np.abs(grid - 100.0)))

    def everywhere(least_db: float, *, beside_db: float = 0.0, off_hz: float = 40.0) -> bool:
        mean = np.zeros((3, grid.size))
        mean[:, int(np.argmin(np.abs(grid - 100.0 - off_hz)))] = beside_db
        mean[:, best] = [20.0, least_db, 20.0]
        return _Search(data=(), shafts=(), parts=(), mean=mean, grid=grid)._everywhere(best)

    assert everywhere(FAINT_DB) and not everywhere(FAINT_DB - 0.01)
    assert everywhere(1.0, beside_db=1.0 / AHEAD) and not everywhere(1.0, beside_db=1.0 / AHEAD + 0.01)
    assert everywhere(1.0, beside_db=5.0, off_hz=SEPARATE_HZ - STEP_HZ), "its own foot"
    assert not everywhere(1.0, beside_db=5.0, off_hz=-SEPARATE_HZ - STEP_HZ)


@pytest.mark.parametrize(("hz", "told_so"), [(100.0, True), (60.0, True), (120.0, True), (85.0, False)])
def test_at_a_supplys_frequency_less_is_enough(hz: float, told_so: bool) -> None:
    """As j057 of the proof: 17, 1.9 and 0.6 dB, where parts of bearings stand at two of the speeds."""
    grid = np.arange(LOWEST_HZ, 260.0, STEP_HZ)
    points = [
        SimpleNamespace(point=Point(speed_hz=s), lines_hz=np.array([s]), spectra=(SimpleNamespace(speed_hz=s),))
        for s in (22.5, 30.0, 39.0)
    ]

    def found(levels_db: Sequence[float], elsewhere_db: float = 0.0) -> bool:
        mean = np.zeros((3, grid.size))
        mean[:, np.abs(grid - hz) < 0.9] = np.array(levels_db)[:, None]
        mean[:, np.abs(grid - 177.0) < 0.9] = elsewhere_db
        search = _Search(data=points, shafts=(), parts=(), mean=mean, grid=grid, supply=True)  # type: ignore[arg-type]
        least = np.sort(mean, axis=0)[-2]
        return search.standing(least, SUPPLY_AT_TWO_DB, at_two=True) is not None

    assert found([0.6, 17.0, 1.9]) is told_so
    assert not found([0.6, 17.0, 1.4]), "less than is asked at two speeds"
    assert not found([0.6, 17.0, 1.9], elsewhere_db=1.0) and not found([0.6, 17.0, 1.9], elsewhere_db=20.0)


def test_a_supply_confirms_by_less_too() -> None:
    grid = np.arange(LOWEST_HZ, 260.0, STEP_HZ)
    best = int(np.argmin(np.abs(grid - 100.0)))
    for supply, least_db, sure in (
        (True, SUPPLY_FAINT_DB, True),
        (True, SUPPLY_FAINT_DB - 0.01, False),
        (False, SUPPLY_FAINT_DB, False),
    ):
        mean = np.zeros((3, grid.size))
        mean[:, best] = [20.0, least_db, 2.0]
        assert _Search(data=(), shafts=(), parts=(), mean=mean, grid=grid, supply=supply)._everywhere(best) is sure


def test_what_turns_with_a_shaft_is_none(machine: MachineSpec) -> None:
    assert told(machine, steady) is None
    # 90 Hz is the fourth order at one speed and the third at the other
    both = told(machine, lambda hz: at_order(3.0)(hz) + at_order(4.0)(hz))
    assert both is None
    assert told(machine, at_order(2.7)) is None
    assert told(machine, at_many) is None
    assert told(machine, at_hz(60.0)) is None, "the second order of one of two speeds"


def test_what_a_bearing_modulates_with_is_none(machine: MachineSpec) -> None:
    """At 20 Hz its third line is where the second is at 30 Hz."""
    outer, slipped = 2.57355, 0.983
    several = lambda hz: sum(at_order(k * slipped * outer)(hz) for k in (1, 2, 3))  # noqa: E731
    assert told(machine, several, speeds_hz=(20.0, 30.0)) is None
    assert told(machine, at_hz(150.0), speeds_hz=(21.7, 31.7)) is not None


def test_harmonics_that_not_all_speeds_reach_are_left_out(machine: MachineSpec) -> None:
    fast = RATE_HZ * USABLE / (2.5 * 23)
    seen = told(machine, at_hz(100.0), speeds_hz=(22.5, fast))
    assert seen is not None and seen.hz == pytest.approx(100.0, abs=0.7)


def test_hum_that_was_added_and_what_the_baseline_has_are_none(machine: MachineSpec) -> None:
    assert told(machine, steady, hum=0.5) is None
    assert told(machine, at_hz(100.0), at_hz(100.0)) is None


def test_without_a_baseline_nothing_is_said(machine: MachineSpec) -> None:
    assert told(machine, at_hz(100.0), None) is None


@pytest.mark.parametrize(
    ("hz", "speed_hz", "found"),
    [(100.0, 30.0, True), (120.0, 36.0, True), (77.0, 30.0, False), (100.0, 39.0, False), (100.0, 25.0, False)],
)
def test_at_one_speed_a_supply_is_told_where_no_part_turns_so(
    machine: MachineSpec, hz: float, speed_hz: float, found: bool
) -> None:
    """At 39 Hz the outer race passes at 100 Hz, at 25 Hz it is the fourth turn."""
    seen = told(machine, at_hz(hz, 0.2), speeds_hz=(speed_hz,))
    assert (seen is not None) is found
    if seen is not None:
        assert "at the one speed recorded" in seen.text and "another tells" in seen.follows
        assert seen.speeds == (1, 1) and seen.rise_db > AT_ONE_DB
    assert told(machine, at_hz(hz, 0.003), speeds_hz=(speed_hz,)) is None, "too faint for one speed"
    assert told(machine, at_many, speeds_hz=(speed_hz,)) is None
    louder = lambda at: at_hz(hz, 0.1)(at) + at_hz(56.0, 0.3)(at)  # noqa: E731
    assert told(machine, louder, speeds_hz=(speed_hz,)) is None, "more has risen elsewhere"


def test_at_one_speed_what_a_part_may_bring_is_no_supplys(
    machine: MachineSpec, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A lone high multiple of a shaft; a sideband of a race that has risen; bearings whose sizes are not known."""
    assert told(machine, at_hz(100.0, 0.2), speeds_hz=(12.5,)) is None, "the eighth turn"
    inner = 4.42645 * 30.0
    struck = lambda at: at_hz(inner, 0.2)(at) + at_hz(inner - 30.0, 0.1)(at) + at_hz(inner + 30.0, 0.1)(at)  # noqa: E731
    assert told(machine, struck, speeds_hz=(30.0,)) is None
    monkeypatch.setattr("reconcile.machine.own_time.parts_of", lambda _: ())
    assert told(machine, at_hz(100.0, 0.2), speeds_hz=(30.0,)) is None


def test_a_high_multiple_of_the_slow_shaft_lies_near_any_frequency(machine: MachineSpec) -> None:
    """100 Hz is the 13th multiple of the gear's shaft at one speed and the 10th at the other."""
    slow = 23 / 81
    speeds_hz = (100.0 / 13 / slow, 100.0 / 10 / slow)
    seen = told(machine, at_hz(100.0), speeds_hz=speeds_hz)
    assert seen is not None and seen.hz == pytest.approx(100.0, abs=0.7)
    for every in (1, 2, 3, 4, 6):
        assert told(machine, lobes(every), speeds_hz=speeds_hz) is None, f"every {every}th multiple"


def lobes(every: int) -> Modulation:
    """Every so many multiples of the gear's shaft: one broken tooth, or several evenly spaced."""
    return lambda hz: 0.25 * sum(at_order(k * 23 / 81)(hz) for k in range(every, 37, every))


@pytest.mark.parametrize("speeds_hz", [(20.0, 30.0), (22.5, 30.0), (20.0, 30.0, 40.0)])
@pytest.mark.parametrize("every", [2, 3, 4])
def test_several_damaged_teeth_are_no_frequency_of_its_own(
    machine: MachineSpec, every: int, speeds_hz: tuple[float, ...]
) -> None:
    """Where speeds stand in a small ratio, multiples of the slow shaft meet at one frequency."""
    assert told(machine, lobes(every), speeds_hz=speeds_hz) is None


def test_only_a_low_multiple_is_an_order_by_itself() -> None:
    """And one among neighbours that rose as much, within what a strong line leaks."""
    grid = np.arange(LOWEST_HZ, 260.0, STEP_HZ)

    def order(number: int, *, beside: float, off_hz: float = 0.0) -> bool:
        hz = number * 10.0 + off_hz
        risen = 8.0 * (np.abs(grid - hz) < 1.0)
        for k in (number - 1, number + 1):
            risen = np.maximum(risen, beside * (np.abs(grid - 10.0 * k) < 1.0))
        return _an_order(10.0, hz, risen, grid)

    assert order(LOW, beside=0.0) and not order(LOW + 1, beside=0.0)
    assert order(LOW + 1, beside=8.0 * BESIDE + 0.1) and not order(LOW + 1, beside=8.0 * BESIDE - 0.1)
    assert not order(LOW, beside=0.0, off_hz=OWN_HZ + 0.3) and order(LOW, beside=8.0, off_hz=OWN_HZ + 0.3)
    assert not order(LOW + 1, beside=8.0, off_hz=4.5)
    one_side = 8.0 * ((np.abs(grid - 110.0) < 1.0) | (np.abs(grid - 120.0) < 1.0))
    assert not _an_order(10.0, 110.0, one_side, grid), "both neighbours"
    assert _an_order(10.0, 250.0, 8.0 * ((np.abs(grid - 250.0) < 1.0) | (np.abs(grid - 240.0) < 1.0)), grid), "one only"


def test_what_rises_towards_the_teeth_s_lines_is_their_skirt_and_no_frequency() -> None:
    grid = np.arange(LOWEST_HZ, 60.0, STEP_HZ)
    skirt = 4.0 * np.exp(-(grid - LOWEST_HZ) / 6.0)
    peak = 4.0 * np.exp(-((grid - 30.0) ** 2))
    assert not _falls(grid, skirt, int(np.argmax(skirt)), LOWEST_HZ)
    assert not _falls(grid, skirt, 3, LOWEST_HZ + 1.2)
    assert _falls(grid, skirt + peak, int(np.argmin(np.abs(grid - 30.0))), 30.0)
    broad = 4.0 * (np.abs(grid - 30.0) < 2.5)
    assert _falls(grid, broad, int(np.argmin(np.abs(grid - 32.2))), 30.0), "of a broad line any point may be highest"
    assert _falls(grid, broad, int(np.argmin(np.abs(grid - 27.8))), 30.0)
