"""Rotors whose bearings rattle: louder in one record than in the next, silent by degrees, at times in free flight."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import butter, iirpeak, lfilter, sosfilt

from reconcile.gate.compare import compared
from reconcile.gate.findings import Finding
from reconcile.gate.levels import pairs
from reconcile.gate.samples import FREE_FALL_M_PER_S2, sample_findings
from signals.recording import Operating, Recording
from sim.core.response import Channel

RATE_HZ, SECONDS = 20_000.0, 1.2
SPEEDS_HZ = (24.0, 30.0, 40.0)
JITTER_DB = (-1.5, 2.0, -1.0)
pytestmark = pytest.mark.slow


def rotor(speed_hz: float, seed: int, level_db: float = 0.0) -> Recording:
    """A line of the shaft and broad rattle at three sensors, all of it louder by `level_db`."""
    rng = np.random.default_rng(seed)
    t = np.arange(int(RATE_HZ * SECONDS)) / RATE_HZ
    rows = [np.sin(2 * np.pi * speed_hz * t + k) + 0.3 * rng.standard_normal(t.size) for k in range(3)]
    channels = tuple(Channel(name=f"a{k}", quantity="acceleration", unit="m/s^2", location=f"b{k}") for k in range(3))
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=channels,
        samples=10 ** (level_db / 20) * np.asarray(rows),
        operating=Operating(shaft="input", speed_hz=speed_hz),
    )


BASELINES = tuple(rotor(hz, k) for k, hz in enumerate(SPEEDS_HZ))
TESTS = tuple(rotor(hz, 10 + k, JITTER_DB[k]) for k, hz in enumerate(SPEEDS_HZ))


def found(change, rows=(0,)) -> tuple[Finding, ...]:  # type: ignore[no-untyped-def]
    tests = []
    for k, one in enumerate(TESTS):
        samples = one.samples.copy()
        for row in rows:
            samples[row] = change(samples[row], k)
        tests.append(replace(one, samples=samples))
    return compared(pairs(tests, BASELINES, SPEEDS_HZ, SPEEDS_HZ), tests)


def test_records_of_other_levels_have_no_fault() -> None:
    assert found(lambda x, _: x) == ()


@pytest.mark.parametrize("factor", [2.0, 0.5])
def test_a_gain_is_told_beside_a_level_that_all_channels_share(factor: float) -> None:
    (one,) = found(lambda x, _: factor * x)
    assert (one.kind, one.channel, one.fault) == ("gain_change", "a0", True)
    assert one.gain_db == pytest.approx(20 * np.log10(factor), abs=0.3)


def test_a_gain_of_its_own_at_each_speed_is_none() -> None:
    assert found(lambda x, k: (0.5, 2.0, 3.0)[k] * x) == ()


def test_whose_gain_it_is_must_be_told_by_channels_that_agree() -> None:
    assert found(lambda x, _: 2.0 * x, rows=(0, 1)) == ()


def peaked(x: np.ndarray, _k: int) -> np.ndarray:
    """22 dB at 3.8 kHz, nine times higher than wide."""
    b, a = iirpeak(3_800.0, 9.0, fs=RATE_HZ)
    return x + 11.6 * lfilter(b, a, x)


def test_a_narrow_peak_of_a_loose_sensor_is_told_beside_such_levels() -> None:
    (one,) = found(peaked)
    assert (one.kind, one.channel, one.fault) == ("loose_sensor", "a0", True)
    place = re.search(r"around ([\d.]+) Hz", one.detail)
    assert place is not None and float(place[1]) == pytest.approx(3_800.0, rel=0.08)


def test_a_peak_that_moves_with_the_speed_is_no_sensor() -> None:
    def moving(x: np.ndarray, k: int) -> np.ndarray:
        b, a = iirpeak(110.0 * SPEEDS_HZ[k], 9.0, fs=RATE_HZ)
        return x + 11.6 * lfilter(b, a, x)

    assert found(moving) == ()


def test_a_bearing_that_fell_silent_is_no_loose_sensor() -> None:
    def silenced(x: np.ndarray, k: int) -> np.ndarray:
        return 10 ** ((-33.0, -40.0, -48.0)[k] / 20) * x

    assert found(silenced) == ()


def test_silence_by_degrees_is_no_dropout_and_a_gap_is_one() -> None:
    rng = np.random.default_rng(3)
    n, block = int(RATE_HZ * SECONDS), 40
    sizes = np.geomspace(0.012, 1.0, n // block)
    rattle = rng.standard_normal(n) * np.repeat(rng.permutation(np.maximum(sizes, 0.012)), block)[:n]
    one = rotor(30.0, 1)
    rattling = replace(one, samples=np.asarray([rattle, *one.samples[1:]]))
    assert not [f for f in sample_findings(rattling, "test 1") if f.kind == "dropouts"]
    gap = one.samples.copy()
    gap[0, 6000:6200] *= 1e-3
    assert [f.channel for f in sample_findings(replace(one, samples=gap), "test 1") if f.kind == "dropouts"] == ["a0"]


@pytest.mark.parametrize("share", [0.02, 0.03])
def test_a_gap_that_is_not_quite_silent_is_one_too(share: float) -> None:
    one = rotor(30.0, 1)
    samples = one.samples.copy()
    for start in (3_000, 9_010, 15_020):
        samples[0, start : start + 200] *= share
    found = [f.channel for f in sample_findings(replace(one, samples=samples), "test 1") if f.kind == "dropouts"]
    assert found == ["a0"]


ONE_END, BOTH = (1,), (1, -1)


@pytest.mark.parametrize(
    ("end", "ends", "unit", "told"),
    [
        (FREE_FALL_M_PER_S2, ONE_END, "m/s^2", []),
        (FREE_FALL_M_PER_S2, BOTH, "m/s^2", ["clipped"]),
        (FREE_FALL_M_PER_S2, ONE_END, "m/s", ["clipped"]),
        (9.0, ONE_END, "m/s^2", ["clipped"]),
        (7.0, ONE_END, "m/s^2", ["clipped"]),
    ],
)
def test_a_plateau_of_one_end_at_the_weight_s_acceleration_is_free_flight(
    end: float, ends: tuple[int, ...], unit: str, told: list[str]
) -> None:
    one = rotor(30.0, 1)
    samples = one.samples.copy()
    samples[0] = 10.0 * samples[0] + 1e-3 * np.random.default_rng(4).standard_normal(samples.shape[1])
    for sign in ends:
        samples[0] = np.where(sign * samples[0] < -end, -sign * end + 1e-3 * samples[1], samples[0])
    channels = tuple(replace(c, unit=unit) for c in one.channels)
    found = sample_findings(replace(one, samples=samples, channels=channels), "test 1")
    assert [f.kind for f in found] == told


def lined(one: Recording, k: int, noise: float = 0.0) -> Recording:
    """With lines of the first channel from 3 to 5 kHz, and more noise between them."""
    t = np.arange(one.samples.shape[1]) / RATE_HZ
    samples = one.samples.copy()
    samples[0] += sum(0.12 * np.sin(2 * np.pi * hz * t + hz) for hz in np.arange(3_000.0, 5_000.0, 2 * SPEEDS_HZ[k]))
    band = butter(4, [3_000.0, 5_000.0], "bandpass", fs=RATE_HZ, output="sos")
    samples[0] += noise * sosfilt(band, np.random.default_rng(70 + k).standard_normal(t.size))
    return replace(one, samples=samples)


@pytest.mark.parametrize("noise", [0.0, 0.9])
def test_noise_that_leaves_the_lines_is_no_loose_sensor(noise: float) -> None:
    before = [lined(one, k) for k, one in enumerate(BASELINES)]
    tests = [lined(one, k, noise) for k, one in enumerate(TESTS)]
    assert compared(pairs(tests, before, SPEEDS_HZ, SPEEDS_HZ), tests) == ()
