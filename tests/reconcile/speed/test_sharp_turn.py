"""A turn's own line that is sharp is not left for what stands near its high harmonics, as on rotors without teeth."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.speed.estimate import HARMONICS, estimate_speed, line_logs
from reconcile.speed.refine import refined
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ, SECONDS, STATED_HZ = 20_000.0, 1.2, 30.0


def rotor(speed_hz: float, clutter: float, seed: int, wander: float = 0.0) -> Recording:
    """The turn's line 30 dB out of the noise; one of two sensors has a line at `clutter` times the eighth harmonic."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(RATE_HZ * SECONDS)) / RATE_HZ
    turn = 2 * np.pi * speed_hz * (t + wander * np.sin(2 * np.pi * 2.0 * t) / (4 * np.pi))
    rows = 0.2 * rng.standard_normal((2, t.size)) + 0.08 * np.sin(turn)
    rows[0] += 0.06 * np.sin(2 * np.pi * 8.0 * clutter * speed_hz * t + 1.0)
    channels = tuple(
        Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location=f"bearing{k + 1}") for k in range(2)
    )
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=channels,
        samples=rows,
        operating=Operating(shaft="input", speed_hz=STATED_HZ),
    )


@pytest.mark.slow
@pytest.mark.parametrize("clutter", [0.983, 0.988, 1.012, 1.017])
@pytest.mark.parametrize("speed_hz", [29.92, 30.18])
def test_a_line_near_the_eighth_harmonic_does_not_lead_away(speed_hz: float, clutter: float) -> None:
    recording = rotor(speed_hz, clutter, 3)
    found, half = refined(line_logs(recording), speed_hz * (1.0 + 0.5 * (clutter - 1.0)), HARMONICS)
    assert abs(found / speed_hz - 1.0) < 0.004
    assert half < 0.01 * speed_hz


@pytest.mark.slow
def test_the_eighth_harmonic_itself_makes_the_speed_finer() -> None:
    found = estimate_speed(rotor(30.1, 1.0, 4))
    assert found.method == "harmonics"
    assert found.speed_hz == pytest.approx(30.1, rel=1e-3)


@pytest.mark.slow
def test_a_line_that_wander_spreads_keeps_its_wide_interval() -> None:
    recordings = [rotor(30.1, 1.0, 5, wander) for wander in (0.0, 0.08)]
    sharp, spread = (refined(line_logs(r), 30.1, (1.0,))[1] for r in recordings)
    assert sharp < 0.35 * 0.8333 + 1e-9 < spread
