"""Units and swaps are seen beside a fault of the machine, and no fault or drift is taken for one."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import permutations

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.signal import butter, sosfilt

from reconcile.gate.compare import compared, swap_order
from reconcile.gate.levels import pairs
from reconcile.gate.robust import robust_unit_gain
from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from signals.recording import Recording
from tests.reconcile.gate.test_gate import RATE_HZ, SPEEDS_HZ, machine
from tests.reconcile.gate.test_units import GRAVITY, judged, scaled
from tests.strategies.brief import recorded, sound, train

UNIT_DB = 20 * np.log10(GRAVITY)
SECONDS = 3.0
"""So long that moments without impacts are left beside large defects."""
BASELINES = tuple(machine(hz, seed, seconds=SECONDS) for seed, hz in enumerate(SPEEDS_HZ))
DEFECTS = [0.0, 20.0, 60.0]
"""Impacts that raise bands by up to 20 dB."""


@cache
def with_defect(defect: float) -> tuple[Recording, ...]:
    return tuple(
        machine(hz, 100 + seed, drift=0.5, defect=defect, seconds=SECONDS) for seed, hz in enumerate(SPEEDS_HZ)
    )


def exchanged(recordings: tuple[Recording, ...], order: tuple[int, ...]) -> tuple[Recording, ...]:
    return tuple(replace(r, samples=r.samples[list(order)]) for r in recordings)


def found(tests: tuple[Recording, ...], baselines: tuple[Recording, ...] = BASELINES):  # type: ignore[no-untyped-def]
    hz = [[r.operating.speed_hz for r in several if r.operating] for several in (tests, baselines)]
    return compared(pairs(tests, baselines, *hz), tests)


@pytest.mark.slow
@pytest.mark.parametrize("defect", DEFECTS)
@pytest.mark.parametrize("row", [0, 1, 2])
@pytest.mark.parametrize("factor", [GRAVITY, 1 / GRAVITY])
@pytest.mark.parametrize("count", [1, 2])
def test_a_unit_is_seen_beside_a_fault_and_nothing_else_is(defect: float, row: int, factor: float, count: int) -> None:
    tests = scaled(with_defect(defect)[:count], (row,), factor)
    told = found(tests, BASELINES[:count])
    assert [(f.kind, f.channel) for f in told] == [("unit_mismatch", f"a{row}")]
    assert told[0].gain_db == pytest.approx(np.sign(factor - 1) * UNIT_DB)


@pytest.mark.slow
@pytest.mark.parametrize("defect", [*DEFECTS, 200.0, 1000.0, 5000.0])
def test_no_fault_however_large_is_a_unit_or_a_swap(defect: float) -> None:
    """Impacts that drown the quiet moments too raise all bands by ten and more."""
    for count in (1, 2):
        told = found(with_defect(defect)[:count], BASELINES[:count])
        assert not [f for f in told if f.kind in ("unit_mismatch", "swapped_channels", "gain_change")]


@pytest.mark.slow
@pytest.mark.parametrize("defect", DEFECTS)
@pytest.mark.parametrize("order", [p for p in permutations(range(3)) if p != (0, 1, 2)])
@pytest.mark.parametrize("count", [1, 2])
def test_a_swap_is_seen_beside_a_fault(defect: float, order: tuple[int, ...], count: int) -> None:
    told = found(exchanged(with_defect(defect)[:count], order), BASELINES[:count])
    if defect == 60.0 and count == 1 and not told:
        return  # one record of a large fault may not tell
    assert {f.kind for f in told} == {"swapped_channels"}
    assert {f.channel for f in told} == {f"a{i}" for i in range(3) if order[i] != i}


@pytest.mark.slow
def test_both_are_mended() -> None:
    whole = with_defect(60.0)
    gate = judged(scaled(whole, (0,), 1 / GRAVITY), BASELINES)
    assert gate.fault is not None and gate.fault.kind == "unit_mismatch"
    assert np.std(gate.tests[0].samples[0]) == pytest.approx(np.std(whole[0].samples[0]), rel=1e-6)
    gate = judged(exchanged(whole, (1, 0, 2)), BASELINES)
    assert gate.fault is not None and gate.fault.kind == "swapped_channels"
    np.testing.assert_array_equal(gate.tests[0].samples, whole[0].samples)


def _fault(rng: np.random.Generator, samples: int, share: float, impacts: bool):  # type: ignore[no-untyped-def]
    """Noise, or impacts a hundredth of a second apart, in bands that cover about `share` of the spectrum."""
    if impacts:
        force = np.zeros(samples)
        force[np.cumsum(rng.uniform(0.008, 0.016, int(samples / RATE_HZ / 0.016)) * RATE_HZ).astype(int)] = 1.0
    else:
        force = rng.standard_normal(samples)
    total, width = np.zeros(samples), 0.1 * RATE_HZ / 2
    for _ in range(round(share / 0.1)):
        low = rng.uniform(0.03, 0.85) * RATE_HZ / 2
        part = sosfilt(butter(2, [low, low + width], "bandpass", fs=RATE_HZ, output="sos"), force)
        total += part / np.std(part)
    return total


@st.composite
def cases(draw: st.DrawFn) -> tuple[tuple[Recording, ...], bool, np.random.Generator]:
    """A repeat whose gains drifted by up to 1.5 dB, with a fault that its channels hear more or less; and whether the
    fault leaves enough of the spectrum, or of the time, to see more than itself."""
    rng = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    share, impacts = draw(st.sampled_from([0.0, 0.2, 0.4])), draw(st.booleans())
    height = draw(st.sampled_from([0.3, 1.0, 3.0]))
    heard = rng.permutation([1.0, 0.5, 0.2])[:, np.newaxis]
    gains = 10 ** (rng.uniform(-1.5, 1.5, 3) / 20)[:, np.newaxis]
    tests = []
    for r in with_defect(0.0):
        fault = height * heard * _fault(rng, r.samples.shape[1], share, impacts)
        tests.append(replace(r, samples=gains * (r.samples + fault)))
    seen = share == 0.0 or (share <= 0.2 and height <= (1.0 if impacts else 0.3))
    return tuple(tests), seen, rng


@pytest.mark.slow
@settings(max_examples=15, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(cases())
def test_drift_and_faults_are_neither_unit_nor_swap_and_hide_neither(case) -> None:  # type: ignore[no-untyped-def]
    tests, seen, rng = case
    told = found(tests)
    assert not [f for f in told if f.kind in ("unit_mismatch", "swapped_channels")], told
    if not seen:
        return
    row, sign = int(rng.integers(3)), rng.choice([-1, 1])
    told = [f for f in found(scaled(tests, (row,), float(GRAVITY**sign))) if f.kind == "unit_mismatch"]
    assert [(f.channel, round(f.gain_db or 0.0, 1)) for f in told] == [(f"a{row}", round(sign * UNIT_DB, 1))]
    a, b = rng.choice(3, 2, replace=False)
    order = [0, 1, 2]
    order[a], order[b] = order[b], order[a]
    hz = [[r.operating.speed_hz for r in several if r.operating] for several in (tests, BASELINES)]
    swapped = exchanged(tests, tuple(order))
    assert swap_order(pairs(swapped, BASELINES, *hz), swapped) == tuple(order)


def test_short_records_and_lone_channels_say_nothing() -> None:
    short = tuple(r.select(end_s=0.05) for r in (*BASELINES[:1], *with_defect(20.0)[:1]))
    (pair,) = pairs(short[1:], short[:1], [20.3], [20.3])
    assert pair.quiet_test.shape == (3, 0) and robust_unit_gain([pair], 0) is None
    alone = tuple(r.select(channels=["a0"]) for r in (*BASELINES[:1], *scaled(with_defect(60.0)[:1], (0,), GRAVITY)))
    (pair,) = pairs(alone[1:], alone[:1], [20.3], [20.3])
    assert robust_unit_gain([pair], 0) is None


@pytest.mark.slow
@pytest.mark.parametrize("change", ["unit", "swap"])
def test_an_inner_race_is_named_at_its_channel_behind_a_unit_or_a_swap(change: str) -> None:
    """Strong impacts, dense enough that no narrow band falls silent: the unit was taken for a loose mount."""
    parts = {"shafts": [{"name": "shaft"}], "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}]}
    rng = np.random.default_rng(1)
    hit = np.array([1.0, 0.4])[:, np.newaxis] * train(rng, 0.992 * 5.4152, 5.0, load=0.8)
    colours = [butter(1, share, output="sos") for share in (0.9, 0.35)]
    base, now = (
        np.array([g * sosfilt(c, sound(s + 10 * k)) for k, (g, c) in enumerate(zip((1.0, 0.6), colours, strict=True))])
        for s in (1, 2)
    )
    rows = now + hit
    rows = rows[[1, 0]] if change == "swap" else rows * np.array([[1 / GRAVITY], [1.0]])
    spec = read_kinematic_spec({"kinematics": parts})
    report = reconcile_kinematics(spec, [recorded(rows)], [recorded(base)], seed=0)
    assert (report.verdict, report.causes[0].term) == ("explained", "inner_spall")
    limits = " ".join(report.where.limits)
    assert ("unit mismatch" if change == "unit" else "swapped channels") in limits
    assert "loose" not in limits
