"""A shaft whose second harmonic is at the supply's frequency is no hum, however wrong its speed is stated."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.gate import inspect_measurement
from reconcile.speed.elsewhere import lines_elsewhere
from signals.recording import Recording
from tests.strategies.impulses import RATE_HZ, N, recorded, shaft_lines


def made(speed_hz: float, label_hz: float, hum_hz: float = 0.0, shaft: float = 1.0) -> Recording:
    """A shaft's lines in noise, with hum."""
    rng, t = np.random.default_rng(4), np.arange(N) / RATE_HZ
    hum = sum(0.4 / k * np.sin(2 * np.pi * k * hum_hz * t + k) for k in (1, 2, 3)) if hum_hz else 0.0
    return recorded(shaft * shaft_lines(rng, speed_hz) + 0.3 * rng.standard_normal(N) + hum, label_hz)


def hummed(recording: Recording) -> bool:
    return any(f.kind == "mains_hum" for f in inspect_measurement([], [recording]).findings)


@pytest.mark.parametrize(("speed_hz", "label_hz"), [(24.97, 40.0), (24.97, 31.0), (29.97, 40.0), (29.97, 22.0)])
def test_the_second_harmonic_of_a_shaft_stays_under_a_wrong_label(speed_hz: float, label_hz: float) -> None:
    test = made(speed_hz, label_hz)
    assert not hummed(test)
    far = lines_elsewhere(inspect_measurement([], [test]).tests[0], label_hz)
    assert far is not None and far.speed_hz == pytest.approx(speed_hz, rel=1e-3) and far.harmonics == (1, 2, 3)


@pytest.mark.parametrize(("label_hz", "shaft"), [(24.3, 1.0), (31.0, 1.0), (40.0, 0.0)])
def test_hum_is_told_beside_a_shaft_at_another_speed_and_where_none_is_heard(label_hz: float, shaft: float) -> None:
    assert hummed(made(24.3, label_hz, 50.0, shaft))
