"""Defects of recordings: found where they are, and not found where they are not."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from signals.checks import Finding, inspect
from signals.hum import find_hum
from signals.recording import Recording
from signals.series import Series
from signals.timebase import read_time_base, require_uniform
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE = 1000.0
T = np.arange(5000) / RATE


def found(samples: np.ndarray) -> dict[str, Finding]:
    channel = Channel(name="a", quantity="acceleration", unit="g", location="bearing1")
    recording = Recording(sampling_rate_hz=RATE, channels=(channel,), samples=samples[np.newaxis], start_s=10.0)
    findings = inspect(recording)
    assert len({f.kind for f in findings}) == len(findings)
    return {f.kind: f for f in findings}


def signal(seed: int = 0) -> np.ndarray:
    return np.sin(2 * np.pi * 31 * T) + 0.3 * np.random.default_rng(seed).standard_normal(T.size)


def test_a_sound_signal_has_no_findings() -> None:
    assert found(signal()) == {}


def test_not_finite_samples_are_placed() -> None:
    samples = signal()
    samples[100:103] = np.nan
    samples[4000] = np.inf
    finding = found(samples)["not_finite"]
    assert (finding.count, finding.samples) == (2, 4)
    assert [(p.first, p.stop) for p in finding.places] == [(100, 103), (4000, 4001)]
    assert finding.places[0].start_s == pytest.approx(10.1)


def test_a_channel_that_never_moves_is_constant() -> None:
    assert set(found(np.full(100, 2.5))) == {"constant"}


def test_stuck_and_dropped_stretches_are_placed_and_told_apart() -> None:
    samples = signal()
    samples[1000:1100] = samples[1000]
    samples[2000:2050] = 0.0
    findings = found(samples)
    assert set(findings) == {"stuck", "dropout"}
    assert [(p.first, p.stop) for p in findings["stuck"].places] == [(1000, 1100)]
    assert [(p.first, p.stop) for p in findings["dropout"].places] == [(2000, 2050)]


@pytest.mark.parametrize("side", [1, -1])
def test_clipping_is_found_on_either_side(side: int) -> None:
    samples = np.minimum(side * 2 * np.sin(2 * np.pi * 7.3 * T), 1.5) * side
    findings = found(samples)
    assert set(findings) == {"clipping"}
    assert findings["clipping"].count == pytest.approx(7.3 * 5, abs=1)


@settings(deadline=None, max_examples=40)
@given(bits=st.integers(9, 16), frequency=st.floats(0.5, 100.0), seed=st.integers(0, 99))
def test_a_quantised_sine_is_not_clipped(bits: int, frequency: float, seed: int) -> None:
    """A converter repeats its largest value at the crest of a slow sine; that is not clipping."""
    phase = np.random.default_rng(seed).uniform(0, 6.28)
    samples = np.round(np.sin(2 * np.pi * frequency * T + phase) * 2 ** (bits - 1)) / 2 ** (bits - 1)
    assert "clipping" not in found(samples)


def test_uniform_stamps_give_their_rate_even_with_few_digits() -> None:
    assert require_uniform(np.arange(1000) / 48_000.0) == pytest.approx(48_000.0)
    assert require_uniform(np.round(np.arange(1000) * 0.01, 4)) == pytest.approx(100.0)


def test_irregular_stamps_are_described_and_refused() -> None:
    times = np.arange(100) * 0.01
    times[50:] += 0.05
    times[70] = times[69]
    times[80] = times[79] - 0.002
    base = read_time_base(times)
    assert not base.uniform
    assert (base.repeated, base.backward, base.first_place) == (1, 1, 50)
    assert base.gaps >= 1
    assert base.longest_step_s == pytest.approx(0.06)
    with pytest.raises(SpecError, match="irregular from sample 50 on"):
        require_uniform(times)
    with pytest.raises(SpecError, match="time stamps"):
        read_time_base(np.array([0.0, np.nan, 1.0]))


def _humming(*lines: tuple[float, float]) -> Series:
    noise = 0.1 * np.random.default_rng(1).standard_normal(T.size)
    tones = sum((a * np.sin(2 * np.pi * hz * T) for hz, a in lines), start=np.zeros(T.size))
    return Series(samples=noise + tones, sampling_rate_hz=RATE, unit="g", name="a")


def test_hum_is_found_unless_the_shaft_explains_it() -> None:
    series = _humming((50.01, 0.3), (100.02, 0.2))
    one, two = find_hum(series)
    assert (one.mains_hz, one.harmonic, two.harmonic) == (50.0, 1, 2)
    assert two.amplitude_peak == pytest.approx(0.2, rel=0.1)
    assert find_hum(series, expected_hz=[25.005 * k for k in range(1, 10)]) == ()
    assert find_hum(_humming()) == ()


def test_one_line_at_some_harmonic_of_the_mains_is_a_coincidence() -> None:
    assert find_hum(_humming((298.95, 0.5))) == find_hum(_humming((180.0, 0.5))) == ()
    assert {(h.mains_hz, h.harmonic) for h in find_hum(_humming((180.0, 0.5), (300.0, 0.5)))} == {(60.0, 3), (60.0, 5)}
    found = find_hum(_humming((50.0, 0.5), (298.95, 0.5)))
    assert [(h.mains_hz, h.harmonic) for h in found] == [(50.0, 1)]


def test_a_harmonic_where_the_machine_has_a_line_too_is_told_where_the_rest_is() -> None:
    found = find_hum(_humming((50.0, 0.5), (100.0, 0.4), (150.0, 0.3)), [30.0 * k for k in range(1, 20)])
    assert [(h.harmonic, h.shared) for h in found] == [(1, False), (2, False), (3, True)]
