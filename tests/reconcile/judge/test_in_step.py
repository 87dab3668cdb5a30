"""Phases count against a baseline, of several sensors, and only while these share their clock."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.judge.in_step import Delay, clock_delays, compared

SHAFTS_HZ = (30.0, 12.9)
LINES_HZ = np.array([k * 690.0 + s for k in range(1, 7) for s in (0.0, *SHAFTS_HZ, *(-f for f in SHAFTS_HZ))])
OWN = np.arange(LINES_HZ.size) % 5 == 0
WATCHED = SimpleNamespace(phased=tuple(range(LINES_HZ.size)), own=OWN)
CHANNELS = 3


def recorded(phase: np.ndarray, power: float = 1.0) -> SimpleNamespace:
    return SimpleNamespace(phase=phase, line=np.full(phase.shape, power))


def point(late_s: float = 0.0, power: float = 1.0, *, based: bool = True, channels: int = CHANNELS) -> SimpleNamespace:
    """The last channel comes later in the test than it did in the baseline."""
    before = np.random.default_rng(1).uniform(-np.pi, np.pi, (channels, LINES_HZ.size))
    after = before.copy()
    after[-1] -= 2 * np.pi * LINES_HZ * late_s
    baseline = recorded(before, power) if based else None
    turns = SimpleNamespace(speed_hz=SHAFTS_HZ[0])
    return SimpleNamespace(test=recorded(after, power), baseline=baseline, lines_hz=LINES_HZ, point=turns)


def delays(*points: SimpleNamespace) -> tuple[Delay, ...]:
    noise = [np.full(p.test.line.shape, 1e-3) for p in points]
    return clock_delays(points, noise, WATCHED)  # type: ignore[arg-type]


def test_a_channel_that_comes_late_is_told_with_its_neighbours_and_its_point() -> None:
    found = delays(point(), point(late_s=0.0123))
    assert {(d.point, d.channel) for d in found} == {(1, 1), (1, 2)}
    times = {d.channel: d.seconds for d in found}
    left = np.exp(2j * np.pi * LINES_HZ * (abs(times[1]) - 0.0123))
    assert abs(left.mean()) > 0.95, times
    assert np.sign(times[1]) == -np.sign(times[2])
    assert not compared([point(), point()], found)  # type: ignore[arg-type]


def test_phases_count_with_a_baseline_and_two_sensors() -> None:
    assert delays(point()) == ()
    assert compared([point()], ())  # type: ignore[list-item]
    assert not compared([point(), point(based=False)], ())  # type: ignore[list-item]
    assert not compared([point(channels=1)], ())  # type: ignore[list-item]


def test_lines_in_the_noise_and_what_has_no_baseline_say_nothing_of_clocks() -> None:
    assert delays(point(late_s=0.0123, power=1e-3)) == ()
    assert delays(point(late_s=0.0123, based=False), point(late_s=0.0123, channels=1)) == ()


def weak_sidebands(speed: float, late_s: float, scatter_rad: float = 0.05) -> SimpleNamespace:
    """The teeth's own lines stand out of the noise at this share of the speed, their sidebands do not."""
    one = point()
    hz = speed * LINES_HZ
    one.test.phase[-1] -= 2 * np.pi * hz * late_s
    one.test.phase[-1] += scatter_rad * np.random.default_rng(int(100 * speed)).standard_normal(hz.size)
    for seen in (one.test, one.baseline):
        seen.line[:, ~OWN] = 1e-3
    turns = SimpleNamespace(speed_hz=speed * SHAFTS_HZ[0])
    return SimpleNamespace(test=one.test, baseline=one.baseline, lines_hz=hz, point=turns)


def test_strong_lines_of_several_speeds_tell_of_one_delay() -> None:
    speeds = (0.75, 1.0, 1.3)
    late = delays(*(weak_sidebands(k, 1.85e-3) for k in speeds))
    assert {(d.point, d.channel) for d in late} == {(0, 1), (0, 2)}
    assert all(abs(d.seconds) == pytest.approx(1.85e-3, rel=0.02) for d in late)
    assert delays(weak_sidebands(1.0, 1.85e-3)) == (), "six lines at one speed say nothing"
    assert delays(*(weak_sidebands(k, 1.85e-3) for k in (1.0, 1.03))) == (), "nor at two that are nearly one"
    assert delays(*(weak_sidebands(k, 0.0) for k in speeds)) == ()
    other = [weak_sidebands(k, s) for k, s in zip(speeds, (1.1e-3, 0.0, 2.3e-3), strict=True)]
    assert delays(*other) == (), "no one delay"
    assert delays(*(weak_sidebands(k, 0.0, 9.0) for k in speeds)) == (), "phases at random"
