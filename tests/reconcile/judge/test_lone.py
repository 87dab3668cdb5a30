"""One sensor that changed at one operating point alone is found, and nothing else is taken for it."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest

from reconcile.judge.lone import HEARD_BESIDE, Cell, features_of, lone_cell, loudest_cell
from tests.reconcile.judge.cells import (
    CHANNELS,
    FEATURES,
    FLOOR,
    GROUPS,
    LINES,
    PHASES,
    POINTS,
    SHAPE,
    changed,
    noise,
    space,
    turned,
)

SPACE = space()
EVERY = list(product(range(POINTS), range(CHANNELS)))
FAR = 8.0
"""Deviations of each feature."""


def found(cube: np.ndarray, points: int = POINTS, channels: int = CHANNELS, phases: int = PHASES) -> Cell | None:
    return lone_cell(SPACE, changed(cube, phases), points, channels)


@pytest.mark.parametrize(("point", "channel"), EVERY)
def test_a_sensor_that_changed_at_one_operating_point_alone_is_found(point: int, channel: int) -> None:
    levels = noise(point)
    levels[point, channel, : LINES + FLOOR] += FAR
    assert found(levels) == Cell(point=point, channel=channel)
    assert found(turned(noise(7 + channel), point, channel, FAR)) == Cell(point=point, channel=channel), "phases"


@pytest.mark.parametrize(("point", "channel"), [(1, 0), (1, 2), (0, 1), (2, 1), (0, 0)])
def test_what_shows_at_a_second_sensor_or_operating_point_is_not_alone(point: int, channel: int) -> None:
    cube = noise(5)
    cube[1, 1, :LINES] += FAR
    assert found(cube) == Cell(point=1, channel=1)
    cube[point, channel, LINES : LINES + FLOOR] += 0.5 * FAR
    assert found(cube) is None


def test_phases_of_two_channels_that_are_not_neighbours_are_no_single_one() -> None:
    cube = noise(6)
    cube[1, 0, -PHASES:] += FAR
    cube[2, 1, -PHASES:] += FAR
    assert found(cube) is None


def test_of_sound_machines_hardly_any_has_one() -> None:
    assert sum(found(noise(seed)) is not None for seed in range(200)) <= 4


def test_with_one_sensor_or_operating_point_nobody_can_tell() -> None:
    cube = noise(8)
    cube[1, 1] += FAR
    assert found(cube) is not None
    assert found(cube, points=1, channels=POINTS * CHANNELS) is None
    assert found(cube, points=POINTS * CHANNELS, channels=1) is None


def test_features_that_are_not_compared_tell_nothing() -> None:
    unused = GROUPS.copy()
    unused[features_of(changed(noise(0)), Cell(point=2, channel=2), POINTS, CHANNELS)] = -1
    cube = noise(9)
    cube[1, 1, :LINES] += FAR
    cube[2, 2] += FAR
    assert lone_cell(space(unused), changed(cube), POINTS, CHANNELS) == Cell(point=1, channel=1)
    assert found(cube) is None, "compared, it is a second one"


def test_what_has_risen_a_little_everywhere_else_is_not_silence() -> None:
    """By one deviation: no single group stands out by it, their mean does."""
    told = 0
    for seed in range(40):
        cube = noise(100 + seed)
        cube[..., :LINES] += 1.0
        cube[1, 1, :LINES] += FAR
        told += found(cube) is not None
    assert told <= 4


def test_of_two_sensors_the_phase_between_them_is_neither_s() -> None:
    groups = GROUPS.reshape(POINTS * CHANNELS, -1)[: 2 * POINTS].ravel()
    cube = noise(12)[:, :2]
    levels = cube.copy()
    levels[1, 0, :LINES] += FAR
    both = cube.copy()
    both[1, 0, -PHASES:] += FAR
    both[1, 1, -PHASES:] -= FAR
    pair = space(groups)
    assert lone_cell(pair, changed(levels), POINTS, 2) == Cell(point=1, channel=0)
    assert lone_cell(pair, changed(both), POINTS, 2) is None


@pytest.mark.parametrize("channel", range(CHANNELS))
def test_its_features_are_the_channels_and_the_phases_against_it(channel: int) -> None:
    here = features_of(changed(noise(0)), Cell(point=1, channel=channel), POINTS, CHANNELS).reshape(SHAPE)
    before = (channel - 1) % CHANNELS
    assert here[1, channel].all() and here[1, before, -PHASES:].all() and here.sum() == FEATURES + PHASES
    without = features_of(changed(noise(0), phases=0), Cell(point=1, channel=channel), POINTS, CHANNELS)
    assert without.sum() == FEATURES


def loudest(cube: np.ndarray, points: int = POINTS, channels: int = CHANNELS) -> Cell | None:
    return loudest_cell(SPACE, changed(cube), points, channels)


def heard_beside(point: int, channel: int, share: float) -> np.ndarray:
    """One sensor far out at one operating point, and the next one there by so much of it."""
    cube = noise(point)
    cube[point, channel, :LINES] += 3.0 * FAR
    cube[point, (channel + 1) % CHANNELS, :LINES] += share * 3.0 * FAR
    return cube


@pytest.mark.parametrize(("point", "channel"), EVERY)
def test_what_another_sensor_hears_of_it_at_that_point_leaves_it_the_loudest(point: int, channel: int) -> None:
    cube = heard_beside(point, channel, 0.6 * HEARD_BESIDE)
    assert found(cube) is None, "it is not alone"
    assert loudest(cube) == Cell(point=point, channel=channel)


def test_where_another_sensor_or_operating_point_has_changed_as_well_there_is_none() -> None:
    assert loudest(heard_beside(1, 1, 2.0 * HEARD_BESIDE)) is None
    for share in (1.0, HEARD_BESIDE):
        cube = heard_beside(1, 1, 0.0)
        cube[2, 1, :LINES] += share * 3.0 * FAR
        assert loudest(cube) is None


def test_nothing_that_changed_is_the_loudest_and_two_operating_points_do_not_tell() -> None:
    assert sum(loudest(noise(seed)) is not None for seed in range(200)) <= 2
    assert loudest(heard_beside(1, 1, 0.0)) is not None
    groups = GROUPS[: 2 * CHANNELS * FEATURES]
    cube = heard_beside(1, 1, 0.0)[:2]
    assert loudest_cell(space(groups), changed(cube), 2, CHANNELS) is None
    assert loudest_cell(SPACE, changed(heard_beside(1, 1, 0.0)), POINTS * CHANNELS, 1) is None
