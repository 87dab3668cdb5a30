"""The response of two resonances, also where a fit runs off."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.driven.channels import Driven
from reconcile.driven.model import Model, ready
from reconcile.driven.second import _both, driven_band, second
from sim.core.response import Channel

OMEGA = np.linspace(0.0, 3000.0, 301)


def test_each_resonance_adds_its_own_response() -> None:
    first, other = [np.log(400.0), 0.02, 1e-6], [np.log(900.0), 0.03, 2e-7]
    found = _both(np.array([*first, *other]), OMEGA, 0)
    assert found[0] == pytest.approx(1.2e-6), "the static gains add"
    assert np.abs(found[40]) == pytest.approx(1e-6 / 0.04, rel=0.02), "a gain over twice the damping ratio"
    assert np.allclose(_both(np.array([*other, *first]), OMEGA, 1), 1j * OMEGA * found)


@pytest.mark.parametrize("away", [-567246.0, 567246.0])
def test_a_frequency_that_runs_off_stays_a_number(away: float) -> None:
    found = _both(np.array([np.log(400.0), 0.02, 1e-6, away, 0.02, 1e-7]), OMEGA, 0)
    assert np.all(np.isfinite(found))


def test_the_band_that_drives_ends_where_only_noise_is_left() -> None:
    pushed = np.where((OMEGA > 50.0) & (OMEGA < 1000.0), 1.0, 1e-3)
    low, high = driven_band(OMEGA, pushed)
    assert low == pytest.approx(60.0)
    assert high == pytest.approx(990.0)


@pytest.mark.slow
@pytest.mark.parametrize(("place", "told"), [(30.0, True), (3.0, False)])
def test_no_resonance_is_told_where_nothing_drives(place: float, told: bool) -> None:
    rng, n, rate = np.random.default_rng(5), 12000, 500.0
    hz = np.fft.rfftfreq(n, 1 / rate)
    drive = np.fft.irfft(np.where((hz > 8.0) & (hz < 100.0), np.exp(2j * np.pi * rng.uniform(size=hz.size)), 0.0), n)
    own = Model(stiffness=(2 * np.pi * 60.0) ** 2, damping=20.0, gain=1.0)
    x = np.array([np.log(2 * np.pi * 60.0), 10.0 / (2 * np.pi * 60.0), 1.0 / own.stiffness])
    other = np.array([np.log(2 * np.pi * place), 0.05, 0.3 / own.stiffness])
    response = _both(np.concatenate([x, other]), np.asarray(2 * np.pi * hz), 0)
    motion = np.fft.irfft(np.fft.rfft(drive) * response, n)
    channels = {
        "drive_channel": Channel(name="force", quantity="force", unit="N", location="mass"),
        "answer_channel": Channel(name="motion", quantity="displacement", unit="m", location="mass"),
    }
    data = Driven(step_s=1 / rate, drive=drive, answer=motion, prescribed=False, **channels)
    run = ready(data, own.memory_s)
    found = second(own, run, run)
    assert (found is not None) == told
    if found is not None:
        assert found.second_hz == pytest.approx(place, rel=0.02)
