"""Noise that a machine adds (friction of poor lubrication) is no loose sensor: lines stay, other sensors rise too."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.signal import iirpeak, lfilter

from reconcile.gate.compare import compared
from reconcile.gate.levels import pairs
from reconcile.gate.lines import stayed, strong_lines
from signals.recording import Recording
from tests.strategies.impulses import RATE_HZ, SPEED_HZ, N, recorded, shaft_lines

pytestmark = pytest.mark.slow
MODES_HZ = ((2_900.0, 6_100.0), (2_300.0, 7_000.0))


def motor(seed: int, *, friction: tuple[float, float] = (0.0, 0.0)) -> np.ndarray:
    """Two sensors with lines of the shaft and noise; `friction` comes through modes of each sensor's place."""
    rng = np.random.default_rng(seed)
    rows = []
    for modes, share in zip(MODES_HZ, friction, strict=True):
        noise = rng.standard_normal(N)
        rung = sum(8.0 * lfilter(*iirpeak(hz, 12.0, fs=RATE_HZ), noise) for hz in modes) + noise
        rows.append(shaft_lines(rng) + 0.25 * rng.standard_normal(N) + share * rung)
    return np.asarray(rows)


def told(rows: np.ndarray) -> list[tuple[str, str, bool]]:
    tests: list[Recording] = [recorded(rows)]
    found = compared(pairs(tests, [recorded(motor(1))], [SPEED_HZ], [SPEED_HZ]), tests)
    return [(f.kind, f.channel, f.fault) for f in found]


@pytest.mark.parametrize("share", [0.05, 0.1, 0.25])
def test_friction_that_both_sensors_hear_is_no_loose_sensor(share: float) -> None:
    assert told(motor(2, friction=(share, share))) == []


@pytest.mark.parametrize("row", [0, 1])
def test_friction_that_one_sensor_hears_leaves_the_lines_in_it(row: int) -> None:
    assert told(motor(2, friction=(0.4, 0.0) if row == 0 else (0.0, 0.4))) == []


@pytest.mark.parametrize("hz", [1_500.0, 3_800.0])
@pytest.mark.parametrize("row", [0, 1])
def test_a_loose_sensor_is_told_still(row: int, hz: float) -> None:
    rows = motor(2)
    rows[row] += 11.6 * lfilter(*iirpeak(hz, 9.0, fs=RATE_HZ), rows[row])
    assert told(rows) == [("loose_sensor", f"a{row}", True)]


@pytest.mark.parametrize("length", [N, N // 4])
def test_what_lines_and_noise_did_is_read_from_records_of_any_length(length: int) -> None:
    before, after = (recorded(x).series("a0") for x in (motor(1), motor(3, friction=(0.5, 0.0))[:, :length]))
    found = strong_lines(after, before)
    assert found.hz[:3] == pytest.approx([SPEED_HZ, 2 * SPEED_HZ, 3 * SPEED_HZ], abs=0.3)
    assert found.change_db[:3] == pytest.approx(0.0, abs=1.5)
    assert found.floor_db[:3] == pytest.approx(10 * np.log10(1 + (0.5 / 0.25) ** 2), abs=2.5)


def alike(seed: int, *, noise: float = 0.25, gain: float = 1.0, load: float = 1.0) -> np.ndarray:
    """Two sensors of lines and white noise: `noise` of the first, `load` on all lines, `gain` of the whole first."""
    rng = np.random.default_rng(seed)
    rows = [load * shaft_lines(rng) + level * rng.standard_normal(N) for level in (noise, 0.25)]
    return np.asarray([gain * rows[0], rows[1]])


def told_of(test: np.ndarray, base: np.ndarray) -> list[tuple[str, str]]:
    tests = [recorded(test)]
    found = compared(pairs(tests, [recorded(base)], [SPEED_HZ], [SPEED_HZ]), tests)
    return [(f.kind, f.channel) for f in found if f.fault]


@pytest.mark.parametrize("noise", [0.12, 0.17, 0.36, 0.5, 0.7])
@pytest.mark.parametrize("load", [0.8, 1.0, 1.3])
def test_noise_of_the_background_s_own_spectrum_is_no_gain(noise: float, load: float) -> None:
    assert told_of(alike(2, noise=noise, load=load), alike(1)) == []


@pytest.mark.parametrize("gain", [0.5, 0.7, 1.4, 2.0, 2.8])
@pytest.mark.parametrize("load", [0.7, 1.0, 1.4])
def test_a_gain_is_told_still_at_another_load(gain: float, load: float) -> None:
    assert told_of(alike(2, gain=gain, load=load), alike(1)) == [("gain_change", "a0")]


def test_lines_that_are_few_or_scatter_deny_no_gain() -> None:
    other = np.array([0.1, -0.2, 0.0])
    assert stayed(6.0, 0, [np.array([0.1, -0.2, 0.1]), other], [6.0, 0.0])
    assert not stayed(6.0, 0, [np.array([0.1, -0.2]), other], [6.0, 0.0])
    assert not stayed(6.0, 0, [np.array([-6.0, 0.0, 6.0]), other], [6.0, 0.0])
    assert not stayed(6.0, 0, [np.array([0.1, -0.2, 0.1]), other - 6.0], [6.0, 0.0]), "the load took what it gave"
