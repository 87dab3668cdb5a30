"""Nothing is missing only where noise that is known apart explains what a linear model leaves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.noise import Noise
from reconcile.driven.rest import band_hz, unexplained
from signals.recording import Recording
from sim.presets import preset
from tests.reconcile.driven.made import FREQUENCY, MASS, RATE, recording

SPEC = preset("oscillator")
STIFFNESS = MASS * (2 * np.pi * FREQUENCY) ** 2


def noisy(seed: int, motion: float, force: float = 0.0) -> Recording:
    """White noise on motion and force, over their own sizes."""
    made = recording(None, seed=seed, n=6000, noise=0.002)
    rng = np.random.default_rng(seed)
    size = made.samples.std(axis=1)[:, None] * np.array([[force], [motion]])
    return replace(made, samples=made.samples + size * rng.normal(size=made.samples.shape))


@pytest.mark.slow
@pytest.mark.parametrize(("motion", "baseline"), [(0.05, True), (0.2, False), (0.6, True), (0.6, False)])
def test_white_noise_on_the_motion_is_noise_and_its_limit_is_told(motion: float, baseline: bool) -> None:
    rested = [recording(None, seed=50, n=6000, noise=0.01)] if baseline else []
    report = reconcile_driven(SPEC, [noisy(31, motion), noisy(32, motion)], rested)
    assert report.verdict == "nothing_missing"
    assert (motion < 0.1) or any("stays unseen" in said for said in report.where.limits)


@pytest.mark.slow
def test_an_unmeasured_broad_force_is_no_noise() -> None:
    """A force of half the measured one's size, over its own band, that the force channel does not hold."""
    made = [recording(None, seed=s, n=6000, noise=0.01) for s in (61, 62)]
    other = [recording(None, seed=s, n=6000, noise=0.0, size=0.5) for s in (63, 64)]
    tests = [
        replace(a, samples=np.vstack([a.samples[0], a.samples[1] + b.samples[1]]))
        for a, b in zip(made, other, strict=True)
    ]
    alone = reconcile_driven(SPEC, tests)
    beside = reconcile_driven(SPEC, tests, [recording(None, seed=65, n=6000, noise=0.01)])
    assert alone.verdict == "not_decidable"
    assert beside.verdict == "unknown_physics"
    assert "leaves 4" in beside.sentence
    assert beside.where.sites
    assert not alone.where.sites


@pytest.mark.parametrize(
    ("left", "motion", "baseline", "expected"),
    [
        (0.04, 0.001, None, False),
        (0.08, 0.001, None, True),
        (0.08, 0.078, 0.01, False),
        (0.04, 0.001, 0.01, True),
        (0.04, 0.001, 0.03, False),
        (0.008, 0.001, 0.001, False),
    ],
)
def test_what_counts_as_noise(left: float, motion: float, baseline: float | None, expected: bool) -> None:
    assert unexplained(Noise(left=left, motion=motion, force=0.0, baseline=baseline)) is expected


def test_the_band_of_an_error_is_told() -> None:
    t = np.arange(4000) / RATE
    low, high = band_hz(np.sin(2 * np.pi * 40.0 * t) + 0.01 * np.cos(2 * np.pi * 90.0 * t), 1 / RATE)
    assert low == pytest.approx(40.0, abs=0.5)
    assert high == pytest.approx(40.0, abs=0.5)
