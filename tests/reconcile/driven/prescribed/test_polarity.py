"""Prescribed motion: a force is turned round where it would feed the motion, whatever springs and masses do."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from reconcile.driven.channels import Driven, FloatArray, driven_of
from reconcile.driven.prescribed.faults import held_motions
from signals.recording import Recording
from sim.core.response import Channel
from sim.presets import preset

pytestmark = pytest.mark.slow  # each run of a motion is fitted

RATE, LENGTH_S = 512.0, 15.0
SPEC = preset("oscillator")
CHANNELS = (
    Channel(name="displacement", quantity="displacement", unit="m", location="input"),
    Channel(name="force", quantity="force", unit="N", location="output"),
)
Law = Callable[[FloatArray, FloatArray, FloatArray], FloatArray]


def damper(_x: FloatArray, v: FloatArray, _a: FloatArray) -> FloatArray:
    return 2e3 * v


def rubbing(_x: FloatArray, v: FloatArray, _a: FloatArray) -> FloatArray:
    return np.asarray(2e3 * v + 200.0 * np.tanh(v / 0.002))


def carried(x: FloatArray, v: FloatArray, a: FloatArray) -> FloatArray:
    """A mass that turns the sign of its spring from 2.3 Hz on."""
    return 40.0 * a + 8e3 * x + 500.0 * v


def damped(x: FloatArray, v: FloatArray, _a: FloatArray) -> FloatArray:
    return 8e3 * x + 150.0 * v


def spring(x: FloatArray, _v: FloatArray, _a: FloatArray) -> FloatArray:
    return 8e3 * x


def moved(law: Law, hz: float, seed: int, *, size_m: float = 0.008, sign: float = 1.0, late: int = 0) -> Driven:
    rng = np.random.default_rng(seed)
    t = np.arange(int(RATE * LENGTH_S)) / RATE
    phases = rng.uniform(0.0, 6.0, 2)
    x = size_m * (np.sin(2 * math.pi * hz * t + phases[0]) + 0.3 * np.sin(2 * math.pi * 1.37 * hz * t + phases[1]))
    v = np.gradient(x, 1 / RATE)
    force = sign * np.roll(law(x, v, np.gradient(v, 1 / RATE)), late)
    force = force + 0.01 * force.std() * rng.standard_normal(t.size)
    samples = np.vstack([x + 1e-6 * rng.standard_normal(t.size), force])
    return driven_of(Recording(sampling_rate_hz=RATE, channels=CHANNELS, samples=samples), SPEC, motion_drives=True)


@pytest.mark.parametrize("seed", [100, 101, 102])
@pytest.mark.parametrize("law", [damper, rubbing])
def test_what_only_dissipates_has_its_sign(law: Law, seed: int) -> None:
    tests = [moved(law, 1.0, 10 * seed + k, size_m=size) for k, size in ((1, 0.008), (2, 0.012))]
    for rested in ([], [moved(damper, 1.0, seed)]):
        assert not held_motions(tests, rested).faults


def test_a_mass_above_its_spring_is_no_turned_force() -> None:
    tests = [moved(carried, hz, 2) for hz in (1.0, 4.0)]
    for rested in ([], [moved(carried, 1.0, 1)]):
        assert not held_motions(tests, rested).faults


@pytest.mark.parametrize("law", [damper, rubbing, carried, damped])
def test_a_force_that_feeds_the_motion_is_turned_round(law: Law) -> None:
    right, wrong = (moved(law, 1.0, 5, sign=sign) for sign in (1.0, -1.0))
    for rested in ([], [moved(law, 1.0, 6)]):
        held = held_motions([wrong, right], rested)
        assert [(f.kind, f.recordings) for f in held.faults] == [("polarity", ("test 1",))]
        assert "would feed the motion" in held.faults[0].detail
        assert np.allclose(held.data[0].answer, -wrong.answer)
        assert not held.undecided


def test_a_spring_alone_is_held_against_the_baselines_where_the_frequencies_are_the_same() -> None:
    wrong = moved(spring, 1.0, 5, sign=-1.0)
    held = held_motions([wrong], [moved(spring, 1.0, 6)])
    assert [f.detail for f in held.faults] == ["test 1: by baseline 1 force or displacement has the opposite sign"]
    assert not held_motions([wrong], [moved(spring, 4.0, 6)]).faults, "a mass may move with it"
    assert not held_motions([moved(spring, 1.0, 5)], [moved(spring, 1.0, 6)]).faults


@pytest.mark.parametrize("late", [1, 2, 6])
def test_a_springs_force_that_comes_late_is_not_turned(late: int) -> None:
    tests = [moved(spring, 4.0, 5, late=late)]
    assert not held_motions(tests, [moved(spring, 4.0, 6)]).faults
    if late == 1:
        assert not held_motions(tests, []).faults
