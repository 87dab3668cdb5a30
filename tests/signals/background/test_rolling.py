import numpy as np
import pytest

from signals.background import Carrier, rolling_noise

TURNS = 2 * np.pi * 25 * np.arange(48_000) / 48_000


def test_noise_has_unit_power_whatever_it_follows():
    carriers = [Carrier(phase_rad=TURNS, depth=0.6), Carrier(phase_rad=3.6 * TURNS, depth=0.5)]
    assert np.std(rolling_noise(np.random.default_rng(0), TURNS.size, carriers)) == pytest.approx(1.0, rel=1e-9)


def test_its_power_has_the_carriers_lines_and_only_those():
    carriers = [Carrier(phase_rad=4 * TURNS, depth=0.5)]
    power = np.mean(rolling_noise(np.random.default_rng(1), TURNS.size, carriers) ** 2, axis=0)
    lines = np.abs(np.fft.rfft(power)) / (power.size / 2)
    assert lines[100] == pytest.approx(0.5, abs=0.04)
    assert lines[200] == pytest.approx(0.15, abs=0.04)
    assert max(lines[150], lines[137], lines[90]) < 0.05
