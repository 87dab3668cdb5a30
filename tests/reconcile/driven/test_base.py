"""A mass on a base that is moved: its damper acts on the relative motion."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.base import ASSUMED, derived, from_base
from reconcile.driven.channels import driven_of
from reconcile.driven.measured import look
from signals.recording import Recording
from sim.core.response import Channel
from sim.presets import preset

SPEC = preset("oscillator")
RATE, OMEGA, DAMPING = 500.0, 2 * math.pi * 20.0, 0.1
UNITS = ("m", "m/s", "m/s^2")


def shaken(order: int, seed: int = 1, n: int = 8000) -> Recording:
    """Base and mass, both absolute, of random motion up to 60 Hz that repeats; damping is a tenth of critical."""
    rng = np.random.default_rng(seed)
    hz = np.fft.rfftfreq(n, 1 / RATE)
    phase = np.exp(2j * np.pi * rng.uniform(size=hz.size))
    base = np.where((hz > 2.0) & (hz < 60.0), phase, 0.0) * (2j * np.pi * hz) ** order / (5.0 + hz) ** 2
    w = 2 * np.pi * hz
    passed = (OMEGA**2 + 2j * DAMPING * OMEGA * w) / (OMEGA**2 - w**2 + 2j * DAMPING * OMEGA * w)
    samples = np.vstack([np.fft.irfft(base, n), np.fft.irfft(base * passed, n)])
    samples /= samples[0].std()
    samples += 0.002 * rng.standard_normal(samples.shape) * samples.std(axis=1, keepdims=True)
    quantity = ("displacement", "velocity", "acceleration")[order]
    channels = tuple(
        Channel(name=name, quantity=quantity, unit=UNITS[order], location=place)
        for name, place in (("base", "input"), ("mass", "output"))
    )
    return Recording(sampling_rate_hz=RATE, channels=channels, samples=samples)


@pytest.mark.slow
@pytest.mark.parametrize("order", [0, 1, 2])
def test_the_damper_of_a_moved_base_is_in_the_model(order: int) -> None:
    given = driven_of(shaken(order), SPEC)
    seen = look(from_base(given))
    assert look(given).left > 0.02, "as a force the base's motion pulls by the spring alone"
    assert seen.left < 0.01
    assert math.sqrt(seen.model.stiffness) == pytest.approx(OMEGA, rel=0.005)
    assert seen.model.damping == pytest.approx(2 * DAMPING * OMEGA, rel=0.02)
    assert seen.model.gain == pytest.approx(1.0, rel=0.01)


@pytest.mark.slow
def test_a_sound_mass_on_a_moved_base_lacks_nothing_and_the_view_is_said() -> None:
    report = reconcile_driven(SPEC, [shaken(2, seed) for seed in (1, 2)], seed=1)
    assert report.verdict == "nothing_missing", report.sentence
    assert any(ASSUMED in said for said in report.undecidable)


def test_a_force_stays_a_force_and_unlike_motions_as_they_are() -> None:
    given = driven_of(shaken(2), SPEC)
    pushed = replace(given, drive_channel=replace(given.drive_channel, quantity="force", unit="N"))
    mixed = replace(given, drive_channel=replace(given.drive_channel, quantity="velocity", unit="m/s"))
    assert from_base(pushed) is pushed
    assert from_base(mixed) is mixed


def test_derivatives_of_a_sine_and_a_line() -> None:
    t = np.arange(1000) / RATE
    x = 2.0 * t + np.sin(2 * math.pi * 11.0 * t)
    w = 2 * math.pi * 11.0
    middle = slice(50, -50)
    assert np.allclose(derived(x, 1 / RATE, 1)[middle], (2.0 + w * np.cos(w * t))[middle], atol=0.02 * w)
    assert np.allclose(derived(x, 1 / RATE, 2)[middle], (-w * w * np.sin(w * t))[middle], atol=0.02 * w * w)
