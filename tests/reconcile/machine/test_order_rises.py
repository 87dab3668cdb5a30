"""Rises at every distance in turns of the drive shaft: where, from when on and at which speeds, by closed forms."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from reconcile.kinematics.families import Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.order_rises import HALF, STEP, Rises, coarsest_bin, rises_by_order
from reconcile.machine.sidebands import HIGHEST_SHARE, LEAST_LEVEL_DB, MOST_LEVEL_DB
from reconcile.observe.extract import USABLE
from reconcile.observe.watch import bases_at
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.teeth import RATE_HZ, SECONDS, TIME, at_order, points_of, steady

SPEEDS_HZ = (22.5, 30.0, 39.0)
NAMES = ("a", "b")


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


@pytest.fixture(scope="module")
def tie(machine: MachineSpec) -> Ties:
    return ties(of_machine(machine), "input")


def made(levels: list[list[float]], groups: list[list[int]], before: float = LEAST_LEVEL_DB) -> Rises:
    """`levels[k]` at the orders of a short grid, on all four sidebands and both sensors alike."""
    each = tuple(np.broadcast_to(np.array(row), (4, 2, len(row))).copy() for row in levels)
    largest = np.sort([np.max([levels[k] for k in group], axis=0) for group in groups], axis=0)
    data: Any = [SimpleNamespace(spectra=(SimpleNamespace(speed_hz=20.0 + k), None)) for k in range(len(levels))]
    return Rises(
        data=data,
        grid=np.arange(len(levels[0]), dtype=np.float64),
        each=each,
        before=tuple(np.full(one.shape, before) for one in each),
        every=largest[-2],
        spread=largest[-2],
        above=largest[-2],
        groups=groups,
        bin_order=0.02,
        mesh=3,
    )


def test_a_speed_shows_it_from_half_of_the_rise_on() -> None:
    rises = made([[0.0, 8.0], [0.0, 6.0], [0.0, HALF * 6.0 + 0.01], [0.0, HALF * 6.0 - 0.01]], [[0], [1], [2], [3]])
    assert rises.every[1] == 6.0
    assert rises.risen(1) == [0, 1, 2] and rises.speeds(1) == (3, 4)


def test_points_of_one_speed_count_once() -> None:
    rises = made([[8.0], [6.0], [0.0], [7.0], [0.0]], [[0, 1], [2, 3], [4]])
    assert rises.risen(0) == [0, 1, 3] and rises.speeds(0) == (2, 3)


def test_a_rise_is_the_mean_of_sidebands_and_sensors() -> None:
    rises = made([[8.0], [8.0]], [[0], [1]])
    rises.each[1][0, 0, 0] = -60.0
    assert rises.risen(0) == [0], "(7 * 8 - 60) / 8 is less than half"


def test_what_was_there_before_is_told_above_what_chance_reaches() -> None:
    rises = made([[8.0, 0.0], [8.0, 0.0]], [[0], [1]], before=LEAST_LEVEL_DB)
    assert rises.level_before_db(0) == pytest.approx(0.0)
    rises.before[0][..., 0] += 3.0
    rises.before[1][0, 0, 0] += 8.0
    assert rises.level_before_db(0) == pytest.approx(0.5 * (3.0 + 8.0 / 8))
    assert rises.level_before_db(1) == pytest.approx(0.0)
    quiet = made([[8.0], [8.0], [0.0]], [[0], [1], [2]], before=LEAST_LEVEL_DB)
    quiet.before[2][...] += 9.0
    assert quiet.level_before_db(0) == pytest.approx(0.0), "by the speeds that show it"
    line = made([[0.0, 8.0], [0.0, 8.0], [0.0, 0.0]], [[0], [1], [2]], before=LEAST_LEVEL_DB)
    assert line.line_before_db(1) == 0.0
    line.before[2][..., 1] += 9.0
    assert line.line_before_db(1) == pytest.approx(9.0), "a line at a speed that does not show it now"
    line.before[2][..., 0] += 20.0
    assert line.line_before_db(1) == pytest.approx(0.0), "the skirt of the teeth's line"


def test_lines_are_those_of_the_teeth_at_the_speeds_that_show_it(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[tuple[float, int, float, str, str]] = []

    def listed(one: Any, mesh: int, rises: np.ndarray, hz: float, told: str, locked: str, _names: object) -> list[str]:
        asked.append((hz, mesh, float(rises.mean()), told, locked))
        return [f"{told} at {one.spectra[0].speed_hz:g}"]

    monkeypatch.setattr("reconcile.machine.order_rises.risen_lines", listed)
    lines: Any = made([[0.0, 8.0], [0.0, 0.0], [0.0, 6.0]], [[0], [1], [2]]).lines(1, 4.0, "4*input", NAMES)
    assert lines == ("4*input at 20", "4*input at 22")
    assert asked == [(80.0, 3, 8.0, "4*input", ""), (88.0, 3, 6.0, "4*input", "")]


def test_the_coarsest_bin_is_in_turns_of_the_drive_shaft() -> None:
    def recorded(samples: int, speed_hz: float) -> Any:
        return SimpleNamespace(samples=np.zeros((2, samples)), rate_hz=1000.0, speed_hz=speed_hz)

    data: Any = [
        SimpleNamespace(spectra=(recorded(1000, 20.0), recorded(500, 25.0))),
        SimpleNamespace(spectra=(recorded(2000, 4.0), None)),
    ]
    assert coarsest_bin(data[:1]) == pytest.approx(2.0 / 25.0)
    assert coarsest_bin(data) == pytest.approx(0.5 / 4.0)


@pytest.mark.slow
def test_the_second_largest_of_speeds_counts(machine: MachineSpec, tie: Ties) -> None:
    """Levels end at what chance reaches and at what proves no more, so that a strong line's rise is known."""
    shown = {22.5: steady, 30.0: at_order(4.0, 0.6), 39.0: at_order(4.0, 0.6)}
    rises = rises_by_order(machine, points_of(machine, lambda hz: shown[hz](hz)), tie, 0.5, 14.0)
    assert rises is not None
    four = int(np.argmin(np.abs(rises.grid - 4.0)))
    each = [float(one[..., four].mean()) for one in rises.each]
    assert each[0] < 1.0 and rises.every[four] == pytest.approx(sorted(each)[1])
    assert 20.0 < rises.every[four] <= MOST_LEVEL_DB - LEAST_LEVEL_DB
    assert rises.every[np.abs(rises.grid - 4.0) > 0.15].max() < 1.0
    assert (rises.risen(four), rises.speeds(four)) == ([1, 2], (2, 3))
    assert rises.level_before_db(four) < 0.5
    lines = rises.lines(four, 4.0, "4*input", NAMES)
    assert [(one.label, one.speed_hz) for one in lines] == [
        (f"teeth {side} 4*input", hz) for hz in (30.0, 39.0) for side in "-+"
    ]
    wanted = [bases_at(machine, hz)["f_m"] + side * 4.0 * hz for hz in (30.0, 39.0) for side in (-1, 1)]
    assert [one.frequency_hz for one in lines] == pytest.approx(wanted)


@pytest.mark.slow
def test_a_line_on_one_sideband_is_no_modulation(machine: MachineSpec, tie: Ties) -> None:
    """Without the sideband that rose most, at each speed, nothing has; of what modulates five of six are left."""
    data = points_of(machine, steady, speeds_hz=SPEEDS_HZ[:2])
    for one, hz in zip(data, SPEEDS_HZ, strict=False):
        now: Any = one.spectra[0]
        now.samples = now.samples + 0.5 * np.sin(2 * np.pi * (2 * 23 - 4) * hz * TIME)
    both = [
        rises_by_order(machine, points, tie, 0.5, 14.0)
        for points in (data, points_of(machine, at_order(4.0, 0.6), speeds_hz=SPEEDS_HZ[:2]))
    ]
    for rises, left in zip(both, (False, True), strict=True):
        assert rises is not None
        four = int(np.argmin(np.abs(rises.grid - 4.0)))
        assert rises.every[four] > 4.0
        assert rises.spread[four] > 15.0 if left else rises.spread[four] < 1.0
        each = [np.sort(one[..., four].mean(axis=1))[:-1].mean() for one in rises.each]
        assert rises.spread[four] == pytest.approx(min(each)), "the second of two speeds"


@pytest.mark.slow
def test_what_the_baseline_has_is_a_level_and_no_rise(machine: MachineSpec, tie: Ties) -> None:
    both = at_order(4.0, 0.6)
    rises = rises_by_order(machine, points_of(machine, both, both), tie, 0.5, 14.0)
    assert rises is not None
    four = int(np.argmin(np.abs(rises.grid - 4.0)))
    assert abs(rises.every[four]) < 0.5
    assert 20.0 < rises.level_before_db(four) <= MOST_LEVEL_DB - LEAST_LEVEL_DB


@pytest.mark.slow
def test_over_a_quieter_floor_what_was_there_before_is_not_new(machine: MachineSpec, tie: Ties) -> None:
    """A baseline in which noise hides it; nor is it where the noise is the test's."""
    both = at_order(4.0, 0.02)
    for loud in (0, 1):
        data = points_of(machine, both, both, SPEEDS_HZ[:2])
        for k, one in enumerate(data):
            noisy: Any = one.spectra[loud]
            noisy.samples = noisy.samples + 0.7 * np.random.default_rng(k).normal(size=noisy.samples.shape)
        rises = rises_by_order(machine, data, tie, 0.5, 14.0)
        assert rises is not None
        assert rises.every[np.abs(rises.grid - 4.0) < 0.05].max() < 1.0


@pytest.mark.slow
def test_orders_end_where_another_harmonic_of_the_teeth_is_nearer(machine: MachineSpec, tie: Ties) -> None:
    data = points_of(machine, steady, speeds_hz=SPEEDS_HZ[:2])
    for asked, end in ((4.0, 4.0), (14.0, HIGHEST_SHARE * 23)):
        rises = rises_by_order(machine, data, tie, 0.5, asked)
        assert rises is not None
        assert rises.grid[0] == 0.5 and np.diff(rises.grid) == pytest.approx(STEP)
        assert end - 1.01 * STEP < rises.grid[-1] < end
        assert {one.shape[-1] for one in (*rises.each, *rises.before, rises.every, rises.spread)} == {rises.grid.size}
        assert rises.bin_order == pytest.approx(1.0 / SECONDS / SPEEDS_HZ[0])
    assert rises_by_order(machine, data, tie, 4.0, 4.0) is None, "no order"


@pytest.mark.slow
def test_sidebands_beyond_the_band_are_left_out(machine: MachineSpec, tie: Ties) -> None:
    """Of the teeth's third harmonic those up to four turns are in the band, those up to ten are not."""
    fast = RATE_HZ * USABLE / (3 * 23 + 6.0)
    data = points_of(machine, steady, speeds_hz=(22.5, fast))
    near, far = (rises_by_order(machine, data, tie, 0.5, highest) for highest in (4.0, 14.0))
    assert near is not None and far is not None
    assert (near.each[0].shape[0], far.each[0].shape[0]) == (6, 4)
    assert rises_by_order(machine, points_of(machine, steady, speeds_hz=(22.5, 600.0)), tie, 0.5, 14.0) is None


@pytest.mark.slow
def test_one_speed_no_baseline_and_no_teeth_say_nothing(machine: MachineSpec, tie: Ties) -> None:
    for speeds_hz in ((30.0,), (30.0, 30.5)):
        assert rises_by_order(machine, points_of(machine, steady, speeds_hz=speeds_hz), tie, 0.5, 14.0) is None
    assert rises_by_order(machine, points_of(machine, steady, None), tie, 0.5, 14.0) is None
    toothless = Ties(reference="input", shafts={"input": 1.0}, families=(), meshes=(), races={})
    assert rises_by_order(machine, points_of(machine, steady), toothless, 0.5, 14.0) is None
