"""Records of any lengths are compared band by band; noise that a fault adds at one bearing is no unit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from scipy.signal import butter, fftconvolve, firwin2, sosfilt

from reconcile.gate import Finding
from reconcile.gate.compare import compared
from reconcile.gate.levels import QUIET_BANDS, channel_levels, pairs
from reconcile.gate.lines import denied, line_changes
from reconcile.gate.units import possible, unit_finding, unit_of
from signals.recording import Operating, Recording
from sim.core.response import Channel
from tests.reconcile.gate.test_units import GRAVITY, scaled

RATE_HZ = 20480.0
SPEEDS_HZ = (25.0, 35.0)
ENOUGH = 16_000
"""Samples from which on a record has wide bands."""
UNIT_DB = 20 * np.log10(GRAVITY)


def fan(samples: int, speed_hz: float, seed: int, *, noise=None, quantity: str = "acceleration") -> Recording:  # type: ignore[no-untyped-def]
    """Three sensors hear shaft and blades, and noise that falls by 6 dB an octave from 600 Hz on; `noise` is added to
    the first, 14 and 25 dB less of it to the others."""
    rng = np.random.default_rng(seed)
    angle = 2 * np.pi * speed_hz * np.arange(samples) / RATE_HZ
    colour = butter(1, 600.0, fs=RATE_HZ, output="sos")
    rows = [
        0.3 * sum(np.sin(k * angle + k + c) / k for k in (1, 2, 3, 20, 40))
        + sosfilt(colour, rng.standard_normal(samples))
        for c in range(3)
    ]
    if noise is not None:
        rows = [row + 10 ** (-share / 20) * noise for row, share in zip(rows, (0, 14, 25), strict=True)]
    unit = {"acceleration": "m/s^2", "velocity": "m/s"}[quantity]
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=tuple(
            Channel(name=f"c{c}", quantity=quantity, unit=unit, location=f"bearing{c + 1}", axis="y") for c in range(3)
        ),
        samples=np.asarray(rows),
        operating=Operating(shaft="s", speed_hz=speed_hz),
    )


def told(tests: tuple[Recording, ...], baselines: tuple[Recording, ...]) -> tuple[Finding, ...]:
    return compared(pairs(tests, baselines, SPEEDS_HZ, SPEEDS_HZ), tests)


def repeats(lengths: list[int]) -> tuple[tuple[Recording, ...], tuple[Recording, ...]]:
    """(baselines, tests) of four lengths."""
    made = [fan(n, SPEEDS_HZ[i % 2], i) for i, n in enumerate(lengths)]
    return tuple(made[:2]), tuple(made[2:])


@pytest.mark.slow
@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(st.lists(st.integers(2_000, 60_000), min_size=4, max_size=4))
@example([40_960, 40_999, 40_960, 40_999])
@example([40_960, 40_960, 40_999, 3_000])
def test_records_of_any_lengths_are_compared(lengths: list[int]) -> None:
    baselines, tests = repeats(lengths)
    repeated = told(tests, baselines)
    assert not [f for f in repeated if f.fault], repeated
    if min(lengths[0], lengths[2]) < ENOUGH and min(lengths[1], lengths[3]) < ENOUGH:
        return
    units = told(scaled(tests, (1,), GRAVITY), baselines)
    assert [(f.kind, f.channel) for f in units] == [("unit_mismatch", "c1")]
    assert units[0].gain_db == pytest.approx(UNIT_DB)


@pytest.mark.slow
@settings(max_examples=12, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True)
@given(st.integers(1_000, 60_000), st.integers(1_000, 60_000))
@example(6_000, 60_000)
@example(40_999, 40_960)
def test_bands_of_one_place_are_held_against_each_other(test: int, baseline: int) -> None:
    """A short record has no narrow low bands: those of the other are left out, not shifted."""
    now, then = fan(test, 25.0, 0), fan(baseline, 25.0, 1)
    (pair,) = pairs((now,), (then,), (25.0,), (25.0,))
    assert pair.test.shape == pair.baseline.shape == (3, 2, pair.band.size)
    own, other = channel_levels(now, "c0"), channel_levels(then, "c0")
    for levels, held in ((own, pair.test), (other, pair.baseline)):
        at = np.searchsorted(levels.band, pair.band)
        np.testing.assert_array_equal(levels.band[at], pair.band)
        np.testing.assert_array_equal(held[0, 1], levels.floor_db[at])
    many = QUIET_BANDS if min(test, baseline) >= ENOUGH else 0
    assert pair.quiet_change.shape == pair.crest_change.shape == (3, many)
    np.testing.assert_allclose(np.median(pair.test - pair.baseline), 0.0, atol=1.0)


def test_a_loose_sensor_is_seen_by_records_of_different_lengths() -> None:
    baselines, tests = repeats([60_000, 60_000, 60_000, 12_000])
    ring = butter(1, [2400.0, 3400.0], "bandpass", fs=RATE_HZ, output="sos")
    loose = tuple(
        replace(r, samples=np.vstack([r.samples[:1] + 6 * sosfilt(ring, r.samples[:1]), r.samples[1:]])) for r in tests
    )
    (found,) = told(loose, baselines)
    assert (found.kind, found.channel, found.fault) == ("loose_sensor", "c0", True)
    hz, gain_db = np.array(found.transfer_db).T
    assert 2400.0 < hz[int(np.argmax(gain_db))] < 3400.0


def rough(seed: int, low_db: float, high_db: float, samples: int):  # type: ignore[no-untyped-def]
    """Stationary noise whose level wanders over the spectrum."""
    rng = np.random.default_rng(seed)
    level = 10 ** (rng.uniform(low_db, high_db, 14) / 20)
    shaped = fftconvolve(rng.standard_normal(samples + 1024), firwin2(513, np.linspace(0, 1, 14), level), "same")
    return shaped[512 : 512 + samples]


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("rise_db", [(14.0, 30.0), (18.0, 40.0), (18.0, 32.0), (18.0, 24.0)])
@pytest.mark.parametrize("lines", [0.3, 0.0])
def test_noise_at_one_bearing_is_no_unit(seed: int, rise_db: tuple[float, float], lines: float) -> None:
    """Over white noise, with lines of the machine or (if uneven) without."""
    if lines == 0.0 and rise_db[0] == 18.0 and rise_db[1] < 40.0:
        return  # noise that rises by ten alike in most bands, where there is no line, looks as a unit does
    samples = 40_960
    baselines, tests = [], []
    for i, hz in enumerate(SPEEDS_HZ):
        angle = 2 * np.pi * hz * np.arange(samples) / RATE_HZ
        sound = lines * sum(np.sin(k * angle) / k for k in (1, 2, 3, 20, 40, 60))
        white = 0.3 * np.random.default_rng(10 + 2 * seed + i).standard_normal((2, 3, samples))
        fault = np.array([1.0, 0.2, 0.056])[:, np.newaxis] * 0.3 * rough(seed, *rise_db, samples)
        like = fan(samples, hz, i)
        baselines.append(replace(like, samples=sound + white[0]))
        tests.append(replace(like, samples=sound + white[1] + fault))
    found = told(tuple(tests), tuple(baselines))
    assert not [f for f in found if f.kind in ("unit_mismatch", "gain_change") and f.fault], found


def test_lines_deny_a_gain_that_only_the_noise_had() -> None:
    before = fan(40_960, 25.0, 0)
    same = line_changes(fan(50_000, 25.3, 1).series("c0"), before.series("c0"))
    assert same.size >= 2 and abs(float(np.median(same))) < 1.5
    assert denied(UNIT_DB, same) and not denied(5.0, same) and not denied(-UNIT_DB, same)
    raised = scaled((fan(50_000, 25.3, 1),), (0,), GRAVITY)[0]
    assert not denied(UNIT_DB, line_changes(raised.series("c0"), before.series("c0")))
    silent = replace(before, samples=np.random.default_rng(0).standard_normal((3, 40_960)))
    assert line_changes(before.series("c0"), silent.series("c0")).size == 0
    assert not denied(UNIT_DB, np.zeros(0))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("quantity", "factor", "kind"),
    [
        ("acceleration", GRAVITY, "unit_mismatch"),
        ("acceleration", 25.4, "gain_change"),
        ("velocity", 25.4, "unit_mismatch"),
        ("velocity", GRAVITY, "gain_change"),
        ("velocity", 1e-3, "unit_mismatch"),
    ],
)
def test_only_units_of_the_quantity_are_told(quantity: str, factor: float, kind: str) -> None:
    baselines, tests = (
        tuple(fan(40_000, hz, seed + i, quantity=quantity) for i, hz in enumerate(SPEEDS_HZ)) for seed in (0, 2)
    )
    (found,) = told(scaled(tests, (0,), factor), baselines)
    assert (found.kind, found.channel, found.fault) == (kind, "c0", True)


def test_possible_units() -> None:
    assert unit_of(28.1, np.inf, possible("acceleration")) == "g against m/s^2"
    assert unit_of(20.0, np.inf, possible("displacement")) == "inch against mm"
    assert unit_of(60.0, ratios=possible("voltage")) == unit_of(60.0, ratios=possible("force")) == "V against mV"
    assert unit_of(60.0, ratios=possible("")) == "m against mm"
    assert unit_of(28.1, ratios=possible("")) == "inch against mm"


def test_the_spread_over_the_bands_is_told() -> None:
    said = unit_finding(20.0, "g against m/s^2", "c0", np.linspace(10.0, 30.0, 101)).detail
    assert "changed by +12.0 to +28.0 dB" in said and "+19.8 dB is the ratio of g against m/s^2" in said
    assert "all bands" not in said
