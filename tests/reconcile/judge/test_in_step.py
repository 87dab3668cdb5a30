"""Phases count against a baseline, of several sensors, and only while these share their clock."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from reconcile.judge.in_step import Delay, clock_delays, compared

SHAFTS_HZ = (30.0, 12.9)
LINES_HZ = np.array([k * 690.0 + s for k in range(1, 7) for s in (0.0, *SHAFTS_HZ, *(-f for f in SHAFTS_HZ))])
WATCHED = SimpleNamespace(phased=tuple(range(LINES_HZ.size)))
CHANNELS = 3


def recorded(phase: np.ndarray, power: float = 1.0) -> SimpleNamespace:
    return SimpleNamespace(phase=phase, line=np.full(phase.shape, power))


def point(late_s: float = 0.0, power: float = 1.0, *, based: bool = True, channels: int = CHANNELS) -> SimpleNamespace:
    """The last channel comes later in the test than it did in the baseline."""
    before = np.random.default_rng(1).uniform(-np.pi, np.pi, (channels, LINES_HZ.size))
    after = before.copy()
    after[-1] -= 2 * np.pi * LINES_HZ * late_s
    baseline = recorded(before, power) if based else None
    return SimpleNamespace(test=recorded(after, power), baseline=baseline, lines_hz=LINES_HZ)


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
