"""Prescribed motion of made resistances under noise: what is sound stays quiet, what is no law gets no name."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.prescribed.motion import smooth
from reconcile.driven.prescribed.resistance import GRADUAL, Motion, path_force, resistance
from reconcile.driven.prescribed.soft import allowed_widths
from reconcile.verdict import Report
from signals.recording import Recording
from sim.core.response import Channel
from sim.presets import preset

RATE = 500.0
SPEC = preset("oscillator")
CHANNELS = (
    Channel(name="displacement", quantity="displacement", unit="m", location="input"),
    Channel(name="force", quantity="force", unit="N", location="output"),
)
Law = Callable[[Motion], np.ndarray]


def swing(size_m: float, hz: float = 1.0, seconds: float = 10.0) -> Motion:
    t = np.arange(int(seconds * RATE)) / RATE
    x = size_m * np.sin(2 * math.pi * hz * t) * (1 + 0.01 * np.sin(2 * math.pi * 0.07 * t))
    return Motion(displacement=x, velocity=np.gradient(x, 1 / RATE), step_s=1 / RATE)


def answered(law: Law, noise: float = 0.01, moved_m: float = 1e-5, hz: float = 1.0) -> Report:
    """The report on two runs of 8 and 12 mm; noise on force (of its spread) and displacement."""
    runs = []
    for seed, size in enumerate((0.008, 0.012)):
        rng, motion = np.random.default_rng([7, seed]), swing(size, hz)
        force = law(motion)
        force = force + noise * force.std() * rng.standard_normal(force.size)
        x = motion.displacement + moved_m * rng.standard_normal(force.size)
        runs.append(Recording(sampling_rate_hz=RATE, channels=CHANNELS, samples=np.vstack([x, force])))
    return reconcile_driven(SPEC, runs, seed=1)


def plain(m: Motion) -> np.ndarray:
    return np.asarray(4e5 * m.displacement + 2e3 * m.velocity)


def stops(m: Motion) -> np.ndarray:
    beyond = np.maximum(m.displacement - 0.004, 0.0)
    return np.asarray(2e4 * m.displacement + 1e6 * beyond + 500 * m.velocity)


def gradual(m: Motion) -> np.ndarray:
    """Sliders behind springs of their own, other than those that are tried."""
    parts = [path_force({"friction": f, "elastic": 3e5, "asymmetry": 0.0}, m) for f in np.linspace(100.0, 1600.0, 8)]
    return np.asarray(np.sum(parts, axis=0) + 500 * m.velocity)


def test_noise_on_a_slow_motion_is_left_out_of_its_rate() -> None:
    motion = swing(0.008)
    noisy = motion.displacement + 1e-5 * np.random.default_rng(0).standard_normal(motion.displacement.size)
    off = np.gradient(noisy, 1 / RATE) - motion.velocity
    kept = np.gradient(smooth(noisy, 1 / RATE), 1 / RATE) - motion.velocity
    assert off.std() > 3e-3
    assert kept[50:-50].std() < 1e-4


def test_a_motion_without_noise_and_one_of_all_frequencies_stay_as_they_are() -> None:
    rng = np.random.default_rng(0)
    for x in (swing(0.008).displacement, np.cumsum(rng.standard_normal(4000)) * 1e-4):
        assert np.max(np.abs(smooth(x, 1 / RATE) - x)) < 0.02 * np.ptp(x)


@pytest.mark.slow
@pytest.mark.parametrize(("noise", "moved_m", "hz"), [(0.01, 1e-5, 1.0), (0.15, 1e-5, 1.0), (0.03, 1e-6, 2.0)])
def test_noise_on_the_motion_of_a_spring_and_damper_is_no_backlash(noise: float, moved_m: float, hz: float) -> None:
    report = answered(plain, noise, moved_m, hz)
    assert report.verdict == "nothing_missing"
    assert not report.causes


@pytest.mark.slow
def test_a_stop_of_one_side_is_named_with_its_gap() -> None:
    report = answered(stops)
    assert report.verdict == "explained"
    sizes = {c.severity.name: c.severity.value for c in report.causes if c.named and c.severity is not None}
    assert sizes == {
        "contact": pytest.approx(1e6, rel=0.03),
        "gap_up": pytest.approx(0.004, abs=5e-5),
    }
    assert "downwards" not in report.sentence


@pytest.mark.slow
def test_friction_that_sets_in_gradually_gets_no_name() -> None:
    report = answered(gradual)
    assert report.verdict == "unknown_physics"
    assert not any(c.named for c in report.causes)
    assert "What is missing" not in report.sentence
    assert "sets in gradually" in report.sentence
    assert report.pictures["law"]


@pytest.mark.slow
def test_dry_friction_has_its_size_and_no_travel() -> None:
    report = answered(lambda m: 4e5 * m.displacement + 1500 * np.tanh(m.velocity / 0.002))
    assert report.verdict == "explained"
    assert "dry friction" in report.sentence
    assert "after a reversal" not in report.sentence
    severity = report.causes[0].severity
    assert severity is not None
    assert severity.value == pytest.approx(1500.0, rel=0.02)


@pytest.mark.slow
def test_dry_friction_that_is_developed_slowly_gets_no_size() -> None:
    report = answered(lambda m: 4e5 * m.displacement + 1500 * np.tanh(m.velocity / 0.02))
    assert report.verdict == "unknown_physics"
    assert "damping" in report.sentence


@pytest.mark.slow
def test_drag_is_named_though_the_placebo_is_drag_elsewhere() -> None:
    report = answered(lambda m: 4e5 * m.displacement + 2e5 * m.velocity * np.abs(m.velocity))
    assert report.verdict == "explained"
    assert "quadratic damping" in report.sentence


@pytest.mark.slow
def test_a_zero_that_wanders_is_a_fault_of_the_measurement() -> None:
    report = answered(lambda m: plain(m) + 0.5 * plain(m).std() * np.linspace(0.0, 1.0, m.displacement.size))
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert (report.fault.kind, report.fault.channel) == ("drift", "force")


def test_play_that_is_passed_with_the_force_held_has_its_width() -> None:
    """What moves the slider is held by friction: dragged by the play's ends, then a spring that starts softly."""
    motion = swing(0.010)
    dragged, place = np.empty(motion.displacement.size), 0.0
    for i, x in enumerate(motion.displacement):
        place = min(max(place, x - 0.0015), x + 0.0015)
        dragged[i] = place
    behind = Motion(displacement=dragged, velocity=motion.velocity, step_s=motion.step_s)
    values = {"stiffness": 3e4, "damping": 800.0, "offset": 0.0, "reach": 0.004}
    values |= dict.fromkeys(GRADUAL.names[1:], 600.0)
    force = resistance(GRADUAL, values, behind)
    found = allowed_widths(motion, force, 500, 0.0)
    assert found.low_m <= 0.003 <= found.high_m
    assert found.high_m - found.low_m < 0.001


def test_friction_without_play_allows_none() -> None:
    motion = swing(0.010)
    force = gradual(motion) + np.random.default_rng(0).normal(0.0, 50.0, motion.displacement.size)
    assert allowed_widths(motion, force, 500, 0.0).low_m == 0.0
