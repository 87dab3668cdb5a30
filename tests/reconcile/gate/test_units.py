"""A channel in another unit is told from a loose sensor, and every channel that shares a fault is named."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.gate import Gate, inspect_measurement
from reconcile.gate.lines import common_unit_gains
from reconcile.gate.units import edge_unit_gain, even_unit_gain, lowest_share, unit_of
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from signals.recording import Recording
from tests.reconcile.gate.test_gate import BASELINES, SPEEDS_HZ, machine, trials
from tests.strategies.brief import RATE_HZ, recorded, sound, train

GRAVITY = 9.80665
SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)


def scaled(recordings: tuple[Recording, ...], rows: tuple[int, ...], factor: float) -> tuple[Recording, ...]:
    found = []
    for r in recordings:
        samples = r.samples.copy()
        samples[list(rows)] *= factor
        found.append(replace(r, samples=samples))
    return tuple(found)


def judged(tests: tuple[Recording, ...], baselines: tuple[Recording, ...] = BASELINES) -> Gate:
    return inspect_measurement(baselines, tests, mesh_orders=(23.0,), orders=(3.58, 5.42))


@pytest.mark.slow
@pytest.mark.parametrize("factor", [1 / GRAVITY, GRAVITY])
@pytest.mark.parametrize("defect", [0.0, 60.0])
def test_g_described_as_metres_is_a_unit(factor: float, defect: float) -> None:
    """One record at a speed 2 % off: lines move between bands, which is no filter of the mount."""
    test = machine(1.02 * SPEEDS_HZ[0], 100, drift=1.0, defect=defect)
    gate = inspect_measurement(BASELINES[:1], scaled((test,), (1,), factor), mesh_orders=(23.0,), orders=(3.58, 5.42))
    assert gate.fault is not None
    assert (gate.fault.kind, gate.fault.channel) == ("unit_mismatch", "a1")
    assert "g against m/s^2" in gate.fault.detail
    said = "numbers are g described as m/s^2" if factor < 1 else "numbers are m/s^2 described as g"
    assert said in gate.fault.detail
    assert np.std(gate.tests[0].samples[1]) == pytest.approx(np.std(test.samples[1]), rel=1e-6)


def test_a_slope_over_the_bands_is_a_mount() -> None:
    """Its median is the unit's ratio."""
    bands = np.linspace(-5.0, -34.66, 40)
    assert even_unit_gain([np.stack([np.zeros((2, 40)), np.stack([bands, bands])])], 1) is None


def test_all_louder_or_one_alone_is_no_unit_by_its_bulk() -> None:
    rough = np.full((2, 40), 19.3) + np.random.default_rng(0).normal(0, 1, (2, 40))
    quiet = np.zeros((2, 40))
    assert even_unit_gain([np.stack([rough, quiet])], 0) == pytest.approx(19.3, abs=0.5)
    assert even_unit_gain([np.stack([rough, quiet + 8.0])], 0) is None
    assert even_unit_gain([rough[np.newaxis]], 0) is None
    assert unit_of(28.1) == "inch against mm"
    assert unit_of(12.0) is None


@pytest.mark.slow
def test_every_channel_of_a_fault_is_named() -> None:
    units = judged(scaled(trials(), (0, 2), 1 / GRAVITY))
    assert units.fault is not None
    assert (units.fault.kind, units.fault.channel) == ("unit_mismatch", "a0")
    assert units.fault.detail.endswith("; also on a2")
    silent = judged(scaled(trials(), (0, 1), 0.0))
    assert silent.fault is not None
    assert (silent.fault.kind, silent.fault.channel) == ("silence", "a0")
    assert silent.fault.detail.endswith("; also on a1")
    whole = judged(scaled(trials(), (0, 1, 2), 0.0))
    assert whole.fault is not None and whole.fault.detail.endswith("; also on a1, a2")
    alone = judged(scaled(trials(), (1,), 0.0))
    assert alone.fault is not None and "also on" not in alone.fault.detail


@pytest.mark.slow
def test_a_defect_behind_a_wrong_unit_is_still_named() -> None:
    rng = np.random.default_rng(1)
    hit = np.array([1.0, 0.3, 0.1])[:, np.newaxis] * train(rng, 0.992 * 3.5848, 1.0)
    rows = np.array([sound(s) for s in (2, 12, 22)])
    factors = np.array([1 / GRAVITY, 1.0, 1.0])[:, np.newaxis]
    baseline = recorded([sound(s) for s in (1, 11, 21)])
    named = reconcile_kinematics(SPEC, [recorded(factors * (rows + hit))], [baseline], seed=0)
    assert (named.verdict, named.causes[0].term) == ("explained", "outer_spall")
    quiet = reconcile_kinematics(SPEC, [recorded(factors * rows)], [baseline], seed=0)
    assert quiet.verdict == "measurement_fault"
    assert quiet.fault is not None and quiet.fault.kind == "unit_mismatch"
    assert "described as m/s^2" in quiet.sentence


def lines(middle_db: float, scatter_db: float = 1.0, count: int = 9) -> np.ndarray:
    return middle_db + scatter_db * np.linspace(-2.0, 2.0, count)


ACCELERATIONS = ["acceleration"] * 3


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_lines_and_floor_of_nearly_all_channels_that_moved_by_a_ratio_are_a_unit(sign: float) -> None:
    """Beside a fault that raises or drowns the lines of one channel."""
    moved = sign * 19.83
    floors = [moved + 1.5, moved - 1.0, moved]
    expected = pytest.approx(sign * 20 * np.log10(GRAVITY))
    all_moved = [lines(moved - 2.5), lines(moved + 1.0), lines(moved)]
    assert common_unit_gains(all_moved, floors, ACCELERATIONS) == (expected,) * 3
    loud = [lines(moved), lines(8.0, 5.0), lines(moved + 2.0)]
    assert common_unit_gains(loud, floors, ACCELERATIONS) == (expected,) * 3
    other = [lines(moved), lines(0.5), lines(moved + 2.0)]
    assert common_unit_gains(other, floors, ACCELERATIONS) == (expected, None, expected)
    good = [lines(moved), lines(8.0, 5.0), lines(moved + 2.0)]  # a channel whose floor stayed is not scaled
    assert common_unit_gains(good, [moved, 0.3, moved], ACCELERATIONS) == (expected, None, expected)


@pytest.mark.parametrize(
    ("channels", "floors", "quantities"),
    [
        ([lines(-19.8)], [-19.8], ["acceleration"]),
        ([lines(-19.8), lines(0.0), lines(0.5)], [-19.8, 0.0, 0.5], ACCELERATIONS),
        ([lines(-19.8), lines(19.8), lines(0.5)], [-19.8, 19.8, 0.0], ACCELERATIONS),
        ([lines(-12.0), lines(-12.5), lines(-12.0)], [-12.0] * 3, ACCELERATIONS),
        ([lines(-19.8, 6.0), lines(-19.8, 6.0), lines(0.0)], [-19.8, -19.8, 0.0], ACCELERATIONS),
        ([lines(-19.8, count=4)] * 3, [-19.8] * 3, ACCELERATIONS),
        ([lines(-19.8), lines(-19.8)], [-19.8] * 2, ["force", "torque"]),
        ([lines(19.8), lines(19.8)], [-0.5, 0.2], ACCELERATIONS[:2]),
    ],
    ids=["alone", "one of three", "both ways", "no ratio", "scattered", "few", "other quantities", "floor stayed"],
)
def test_other_moves_of_lines_are_no_unit(
    channels: list[np.ndarray], floors: list[float], quantities: list[str]
) -> None:
    assert common_unit_gains(channels, floors, quantities) == (None,) * len(channels)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [10.0, 0.1])
def test_an_unbalance_that_grew_tenfold_is_no_unit(factor: float) -> None:
    """Its lines move by 20 dB at all sensors, the noise does not."""
    time_s = np.arange(2 * int(RATE_HZ)) / RATE_HZ

    def rotor(seed: int, level: float) -> Recording:
        rng = np.random.default_rng(seed)
        turning = sum(np.sin(2 * np.pi * 30.0 * k * time_s + k) / k for k in (1, 2, 3))
        samples = level * np.array([[1.0], [0.6]]) * turning + 0.02 * rng.normal(size=(2, time_s.size))
        return recorded(samples, speed_hz=30.0)

    gate = inspect_measurement([rotor(k, 1.0) for k in (1, 2, 3)], [rotor(k, factor) for k in (4, 5, 6)])
    assert not [f for f in gate.findings if f.kind == "unit_mismatch"] and gate.fault is None


def pitted(gain_db: float, *, seed: int = 0, share: float = 1.0) -> list[np.ndarray]:
    """Changes, dB, (2 channels, mean and floor, bands): a pit raised most bands of the first and half of the second."""
    rng = np.random.default_rng(seed)
    rise = np.stack([np.clip(60 * rng.random((2, 40)) - 12, 0, None), np.clip(60 * rng.random((2, 40)) - 30, 0, None)])
    return [gain_db + share * rise + 0.5 * rng.standard_normal(rise.shape)]


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("gain_db", [-19.83, 19.83])
def test_the_lower_edge_beside_a_pit_tells_a_unit(gain_db: float, seed: int) -> None:
    found = edge_unit_gain(pitted(gain_db, seed=seed), ACCELERATIONS[:2])
    assert found == pytest.approx(gain_db, abs=0.01)
    assert np.max(lowest_share(pitted(gain_db, seed=seed), 1)) < gain_db + 2.0


@pytest.mark.parametrize("seed", range(5))
def test_no_edge_at_a_ratio_is_no_unit(seed: int) -> None:
    one = pitted(-19.83, seed=seed)
    assert edge_unit_gain(pitted(0.0, seed=seed), ACCELERATIONS[:2]) is None
    assert edge_unit_gain(pitted(-12.0, seed=seed), ACCELERATIONS[:2]) is None
    assert edge_unit_gain([d[:1] for d in one], ACCELERATIONS[:1]) is None  # alone
    assert edge_unit_gain(one, ["acceleration", "velocity"]) is None
    assert edge_unit_gain([d + np.array([0.0, 19.83])[:, None, None] for d in one], ACCELERATIONS[:2]) is None
    exchanged = [-d for d in pitted(0.0, seed=seed)]  # the baseline has the pit: no edge below
    assert edge_unit_gain(exchanged, ACCELERATIONS[:2]) is None


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize(("ratio", "within_db"), [(1000.0, 0.8), (25.4, 0.8), (9.80665, 1.8)])
def test_a_gain_is_a_unit_within_what_channels_keep(ratio: float, within_db: float, sign: float) -> None:
    """Gains of sound channels repeat to a fraction of a dB; g against m/s^2, the likeliest slip, may drift besides."""
    for off, told in ((0.0, True), (within_db - 0.1, True), (within_db + 0.1, False)):
        for side in (-1.0, 1.0):
            gain_db = sign * (20 * np.log10(ratio) + side * off)
            assert (unit_of(gain_db) is not None) is told, (ratio, off, side)
