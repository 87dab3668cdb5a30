"""Motion across the load in its other mirror image is read the other way round, and nothing else is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.observe.mirrored import HALF_TURN, Sides, mirrored, sides, turned_round
from reconcile.observe.observation import observe
from reconcile.observe.statistics import Statistics
from reconcile.observe.watch import watch_list
from sim.core.response import Channel
from sim.presets import preset
from tests.reconcile.machine.test_direct import SPEED_HZ, recording, sound

MACHINE = preset("paper-lightly-damped")
WATCHED = watch_list(MACHINE)
OWN = np.asarray(WATCHED.own)[list(WATCHED.phased)]
YXY = Sides(across=(1,), along=(0, 2))


def channel(name: str, axis: str) -> Channel:
    return Channel(name=name, quantity="acceleration", unit="m/s^2", location=name, axis=axis)


def seen(phase: np.ndarray) -> Statistics:
    nothing = np.zeros((3, 1))
    shapes = dict.fromkeys(("line", "floor", "total", "band", "kurtosis", "skewness"), nothing)
    return Statistics(**shapes, depth=nothing, turn=nothing, phase=phase, resolution_hz=1.0, duration_s=1.0)  # type: ignore[arg-type]


def phases(turn: float = 0.0, spread: float = 0.0, seed: int = 1) -> Statistics:
    """Three channels; the second is turned by `turn`, all lines by something of their own."""
    rng = np.random.default_rng(seed)
    phase = np.tile(rng.uniform(-np.pi, np.pi, OWN.size), (3, 1))
    phase[1] += turn
    return seen(phase + spread * rng.standard_normal(phase.shape))


def test_only_what_lies_across_teeth_that_push_along_y_may_be_mirrored() -> None:
    channels = (channel("a", "y"), channel("b", "x"), channel("c", ""), channel("d", "y"))
    assert sides(MACHINE, channels) == Sides(across=(1,), along=(0, 3))
    tilted = MACHINE.model_copy(
        update={"meshes": [m.model_copy(update={"line_of_action": "rotated"}) for m in MACHINE.meshes]}
    )
    assert sides(tilted, channels).across == ()
    assert sides(preset("rotor"), channels).across == (), "a weight alone: no teeth hold it there"


@pytest.mark.parametrize(
    ("turn", "spread", "found"),
    [(np.pi, 0.0, (1,)), (np.pi, 0.1, (1,)), (0.0, 0.1, ()), (0.8 * np.pi, 0.0, ()), (0.5 * np.pi, 0.1, ())],
)
def test_half_a_turn_at_most_lines_is_the_other_image(turn: float, spread: float, found: tuple[int, ...]) -> None:
    assert mirrored(phases(turn, spread, 2), phases(), WATCHED, YXY) == found


def test_a_sensor_along_the_load_is_never_read_the_other_way_round() -> None:
    turned = phases()
    turned = replace(turned, phase=turned.phase + np.pi * np.array([[0.0], [0.0], [1.0]]))
    assert mirrored(turned, phases(), WATCHED, YXY) == (), "the two along the load do not agree"
    assert mirrored(phases(np.pi), phases(), WATCHED, Sides(across=(), along=(0, 1, 2))) == ()
    assert mirrored(phases(np.pi), phases(), WATCHED, Sides(across=(1,), along=())) == ()


def test_lines_at_random_are_no_mirror_image() -> None:
    rng = np.random.default_rng(5)
    found = []
    for _ in range(200):
        test = phases(spread=0.05)
        test.phase[1] = rng.uniform(-np.pi, np.pi, OWN.size)
        found.append(mirrored(test, phases(), WATCHED, YXY))
    assert sum(map(bool, found)) <= 4, "one in a hundred"


def test_lines_out_of_reach_say_nothing() -> None:
    turned = phases(np.pi)
    turned.phase[:, np.flatnonzero(OWN)[2:]] = np.nan
    assert mirrored(turned, phases(), WATCHED, YXY) == ()
    back = turned_round(phases(np.pi), (1,))
    assert mirrored(back, phases(), WATCHED, YXY) == () and HALF_TURN < 1.0


def test_observing_puts_the_test_back_and_its_halves_with_it() -> None:
    """A mesh's harmonics on three channels, the one across with the other sign in the test."""
    names = [channel(f"{p}.acceleration", axis) for p, axis in (("a.y", "y"), ("b.x", "x"), ("c.y", "y"))]
    rate, teeth = recording(sound(1)).sampling_rate_hz, next(g.teeth for g in MACHINE.gears)
    rng = np.random.default_rng(3)

    def made(sign: float) -> object:
        t = np.arange(40_000) / rate
        lines = sum(np.sin(2 * np.pi * k * teeth * SPEED_HZ * t + k) / k for k in range(1, 7))
        rows = np.stack([lines, sign * 0.5 * lines, 0.7 * lines]) + 0.01 * rng.standard_normal((3, t.size))
        return replace(recording(sound(1)), channels=tuple(names), samples=rows)

    (same,) = observe(MACHINE, WATCHED, [made(1.0)], [made(1.0)])  # type: ignore[list-item]
    (other,) = observe(MACHINE, WATCHED, [made(-1.0)], [made(1.0)])  # type: ignore[list-item]
    assert same.mirrored == () and other.mirrored == (1,)
    for test in (other.test, *other.halves):
        apart = np.angle(np.exp(1j * ((test.phase - other.baseline.phase)[1] - (test.phase - other.baseline.phase)[0])))  # type: ignore[union-attr]
        assert np.nanmedian(np.abs(apart[OWN])) < 0.2
