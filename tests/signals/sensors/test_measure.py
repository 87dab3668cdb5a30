"""The whole chain: order, units, reports, seeds, and what another origin allows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signals.recording import Recording
from signals.sensors import Measured, Motion, SensorChain, measure
from signals.sensors.presets import G
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.core.spec import MeasuredSpeed
from tests.signals.sensors.motions import RATE_HZ, SHAFT_HZ, gain_at, motion, tone

N = 20_000
ACC = {"kind": "accelerometer", "name": "acc", "place": {"location": "disc"}}


def run(seen: Motion, *channels: dict, seed: int = 0, **chain: object) -> Measured:
    return measure(seen, SensorChain.model_validate({"channels": list(channels), **chain}), seed=seed)


def still(samples: int = N) -> Motion:
    return motion(disc__y__acceleration=np.zeros(samples))


def test_an_ideal_chain_changes_nothing() -> None:
    x = np.random.default_rng(0).standard_normal(N)
    found = run(motion(disc__y__acceleration=x), ACC)
    assert np.array_equal(found.recording.samples[0], x)
    channel = found.recording.channels[0]
    assert (channel.name, channel.quantity, channel.unit, channel.location, channel.axis) == (
        "acc",
        "acceleration",
        "m/s^2",
        "disc",
        "y",
    )


def test_direction_path_mounting_and_sensor_multiply() -> None:
    frequency = 800.0
    seen = motion(disc__x__acceleration=tone(frequency, N), disc__y__acceleration=3 * tone(frequency, N))
    found = run(
        seen,
        {
            **ACC,
            "place": {"location": "disc", "direction_deg": 30.0},
            "path": {"kind": "modes", "modes": [{"frequency_hz": 800.0, "damping_ratio": 0.1, "gain": 0.4}]},
            "mounting": {"frequency_hz": 4000.0, "damping_ratio": 0.05},
            "sensor": {"sensitivity_v_per_unit": 0.01, "gain_error": 0.02},
        },
    )
    r = frequency / 4000.0
    expected = (math.cos(math.pi / 6) + 3 * math.sin(math.pi / 6)) * 0.4 / 0.2 * 1.02 / abs(1 - r**2 + 0.1j * r)
    assert abs(gain_at(found.recording.samples[0], frequency)) == pytest.approx(expected, rel=1e-4)


def test_volts_and_physical_units_differ_by_the_nominal_sensitivity() -> None:
    x = tone(100.0, N, amplitude=2 * G)
    sensor = {"sensor": {"sensitivity_v_per_unit": 0.1 / G}, "converter": {"bits": 16, "range_v": 1.0}}
    seen = motion(disc__y__acceleration=x)
    found = run(seen, {**ACC, **sensor}, {**ACC, **sensor, "name": "raw", "output": "volts"})
    physical, volts = found.recording.samples
    np.testing.assert_allclose(physical, volts * G / 0.1, rtol=1e-12)
    assert [c.unit for c in found.recording.channels] == ["m/s^2", "V"]
    step = 2.0 / 2**16
    assert found.reports[0].step == pytest.approx(step * G / 0.1) and found.reports[1].step == step
    assert np.abs(volts - x * 0.1 / G).max() <= step / 2 * (1 + 1e-9)


def test_the_converter_clips_after_the_filter_and_the_sensor_before() -> None:
    x = tone(50.0, N, amplitude=10.0)
    seen = motion(disc__y__acceleration=x)
    found = run(
        seen,
        {**ACC, "sensor": {"limit_v": 5.0}, "converter": {"range_v": 8.0}},
        {**ACC, "name": "b", "converter": {"range_v": 8.0}},
        {**ACC, "name": "c", "anti_alias": {"cutoff_hz": 5.0, "order": 8}, "converter": {"range_v": 8.0}},
    )
    limited, clipped, filtered = found.reports
    assert limited.saturated_samples == np.count_nonzero(np.abs(x) > 5) and limited.clipped_samples == 0
    assert clipped.clipped_samples == pytest.approx(np.count_nonzero(np.abs(x) > 8), abs=1)
    assert filtered.clipped_samples == 0


def test_hum_stays_where_it_is_whatever_the_shaft_does_and_noise_passes_the_filter() -> None:
    found = run(
        still(),
        {**ACC, "hum": {"mains_hz": 60.0, "amplitude": 0.5}},
        {**ACC, "name": "n", "noise": {"density_per_sqrt_hz": 0.01}, "anti_alias": {"cutoff_hz": 1000.0, "order": 8}},
    )
    hum, noise = found.recording.samples
    assert abs(gain_at(hum, 60.0)) == pytest.approx(0.5, rel=1e-9)
    # Noise bandwidth of the Butterworth filter: f_c (pi / 2n) / sin(pi / 2n); 4 standard deviations of the estimate.
    bandwidth = 1000.0 * (math.pi / 16) / math.sin(math.pi / 16)
    assert noise.var() == pytest.approx(1e-4 * bandwidth, rel=4 / math.sqrt(bandwidth))


def test_a_clock_error_moves_the_hum_too_as_the_recorder_sees_it() -> None:
    found = run(still(), {**ACC, "hum": {"amplitude": 1.0}}, clock={"rate_error_ppm": 2000.0})
    assert abs(gain_at(found.recording.samples[0], 50.0 / 1.002, last=1.0)) == pytest.approx(1.0, abs=1e-3)


def test_proximity_probe_sees_relative_motion_and_run_out() -> None:
    seen = motion(
        disc__x__displacement=tone(40.0, N, amplitude=1e-5), resonator1__x__displacement=tone(90.0, N, amplitude=2e-6)
    )
    found = run(
        seen,
        {
            "kind": "proximity",
            "name": "p",
            "place": {"location": "disc", "relative_to": "resonator1", "direction_deg": 0.0},
            "probe": {"gap_m": 1e-3, "shaft": "input", "run_out": [{"amplitude_m": 3e-6}]},
        },
    )
    expected = 1e-3 + tone(40.0, N, amplitude=1e-5) - tone(90.0, N, amplitude=2e-6)
    expected += 3e-6 * np.cos(2 * math.pi * SHAFT_HZ * np.arange(N) / RATE_HZ)
    np.testing.assert_allclose(found.recording.samples[0], expected, atol=1e-15)


def test_torque_and_current() -> None:
    t = np.arange(N) / RATE_HZ
    zero = np.zeros(N)
    seen = motion(
        input__theta__displacement=1e-3 * np.sin(20 * t),
        input__theta__velocity=0.02 * np.cos(20 * t),
        disc__theta__displacement=zero,
        disc__theta__velocity=zero,
    )
    current = {"kind": "torque", "name": "i", "shaft": "input", "torque_constant_nm_per_a": 0.5}
    found = run(seen, {"kind": "torque", "name": "t", "shaft": "input"}, current)
    expected = np.sin(20 * t) + 0.01 * np.cos(20 * t)
    np.testing.assert_allclose(found.recording.samples, [expected, 2 * expected], atol=1e-12)
    assert [(c.quantity, c.unit) for c in found.recording.channels] == [("torque", "N m"), ("current", "A")]


def test_tacho_of_a_changing_speed_and_of_torsion() -> None:
    seen = motion(
        speed=MeasuredSpeed(step_s=1.0, ratios=(1.0, 2.0)), disc__theta__displacement=np.full(N, math.radians(18.0))
    )
    tacho = {"kind": "tacho", "shaft": "input", "pulser": {"pulses_per_revolution": 4}}
    found = run(seen, {**tacho, "name": "a"}, {**tacho, "name": "b", "pulser": {"body": "disc"}})
    assert found.recording.tacho is not None and found.recording.tacho.pulses_per_revolution == 4
    times = found.recording.tacho.pulse_times_s
    np.testing.assert_allclose(SHAFT_HZ * (times + times**2 / 2) * 4, np.arange(times.size), atol=1e-5)
    late = np.flatnonzero(np.diff(found.recording.samples[1]) > 0)[0] + 1
    # 18 degrees ahead: the first full turn ends 1/20 of a turn earlier.
    assert SHAFT_HZ * (late / RATE_HZ + (late / RATE_HZ) ** 2 / 2) == pytest.approx(0.95, abs=2e-3)


def test_pulse_times_and_samples_are_on_one_clock() -> None:
    clock = {"rate_error_ppm": 1000.0, "sampling_rate_hz": 10_000.0}
    found = run(still(), {"kind": "tacho", "name": "k", "shaft": "input"}, clock=clock)
    assert found.recording.tacho is not None
    rises = (np.flatnonzero(np.diff(found.recording.samples[0]) > 0) + 1) / 10_000.0
    later = found.recording.tacho.pulse_times_s[1:]
    assert np.all((rises - later >= -1e-9) & (rises - later <= 1.001e-4))
    np.testing.assert_allclose(np.diff(later), 1.001 / SHAFT_HZ)


NOISY = {
    **ACC,
    "preset": "icp-100mv-g",
    "hum": {"amplitude": 0.1},
    "drift": {"walk_per_sqrt_s": 0.1},
    "anti_alias": {"cutoff_hz": 4000.0},
    "dropouts": {"rate_per_s": 5.0},
}
CLOCK = {"sampling_rate_hz": 10_000.0, "jitter_rms_s": 1e-6}


def test_same_motion_chain_and_seed_same_bytes() -> None:
    seen = motion(disc__y__acceleration=tone(300.0, N))
    first, again = (run(seen, NOISY, seed=3, clock=CLOCK).recording for _ in range(2))
    assert first.samples.tobytes() == again.samples.tobytes()
    assert first.samples.shape == (1, N // 2) and first.sampling_rate_hz == 10_000.0
    assert not np.array_equal(run(seen, NOISY, seed=4, clock=CLOCK).recording.samples, first.samples)


def test_a_chains_own_seed_makes_other_noise() -> None:
    chains = [SensorChain.model_validate({"seed": s, "channels": [NOISY]}) for s in (0, 1)]
    a, b = (measure(still(), chain, seed=3).recording.samples for chain in chains)
    assert not np.array_equal(a, b)


@pytest.mark.parametrize("stage", ["hum", "drift", "dropouts"])
def test_switching_one_stage_moves_no_other_numbers(stage: str) -> None:
    """Everything before the converter adds up, so a stage's share is the difference."""
    channel = {**NOISY, "converter": None, "dropouts": None, "preset": None, "noise": {"density_per_sqrt_hz": 0.01}}
    extra = NOISY[stage]
    both = run(still(), {**channel, stage: extra}).recording.samples[0]
    without = run(still(), {**channel, stage: None}).recording.samples[0]
    if stage == "dropouts":
        kept = both == without
        assert 0.5 < kept.mean() < 1
        return
    quiet = {**channel, "noise": None, "hum": None, "drift": None}
    alone = run(still(), {**quiet, stage: extra}).recording.samples[0]
    np.testing.assert_allclose(both - without, alone, atol=1e-9)


def test_another_channel_beside_changes_nothing() -> None:
    seen = motion(disc__y__acceleration=tone(300.0, N))
    alone = run(seen, NOISY, clock=CLOCK).recording.samples[0]
    beside = run(seen, {**NOISY, "name": "first"}, NOISY, clock=CLOCK).recording.samples
    assert np.array_equal(beside[1], alone) and not np.array_equal(beside[0], alone)


@given(scale=st.floats(-3, 3), seed=st.integers(0, 20))
def test_without_limits_the_chain_is_linear_in_the_motion(scale: float, seed: int) -> None:
    x = np.random.default_rng(seed).standard_normal(500)
    free = {**NOISY, "preset": None, "dropouts": None}
    zero, one, scaled = (
        run(motion(disc__y__acceleration=z), free, clock=CLOCK).recording.samples[0] for z in (0 * x, x, scale * x)
    )
    np.testing.assert_allclose(scaled - zero, scale * (one - zero), atol=1e-9)


def test_dropouts_are_reported_with_their_number() -> None:
    gaps = {"gaps": [{"start_s": 0.2, "duration_s": 0.1}], "fill": "nan"}
    found = run(motion(disc__y__acceleration=tone(50.0, N)), {**ACC, "dropouts": gaps})
    lost = np.isnan(found.recording.samples[0])
    assert found.reports[0].lost_samples == lost.sum() == 2000 and lost[4000:6000].all()


def test_the_description_holds_the_whole_chain() -> None:
    found = run(motion(disc__y__acceleration=tone(50.0, N)), NOISY, {"kind": "tacho", "name": "k", "shaft": "input"})
    document = found.recording.chain
    assert document is not None
    assert SensorChain.model_validate(document["chain"]).channels[0].name == "acc"
    assert document["tacho"]["truncated"] == 0 and len(document["tacho"]["pulse_times_s"]) == 25
    assert document["channels"][0]["sources"] == {"disc.y.acceleration": 1.0}


def test_a_measured_recording_can_be_the_source() -> None:
    x = tone(120.0, 4000)
    channel = Channel(name="DE", quantity="acceleration", unit="m/s^2", location="drive end")
    recording = Recording(sampling_rate_hz=RATE_HZ, channels=(channel,), samples=x[None])
    found = run(Motion(recording=recording), {**ACC, "place": {"mix": [{"channel": "DE"}]}, "hum": {"amplitude": 0.3}})
    assert abs(gain_at(found.recording.samples[0], 50.0)) == pytest.approx(0.3, rel=1e-9)
    assert found.recording.origin == "measured"
    with pytest.raises(SpecError, match="nothing turns"):
        run(Motion(recording=recording), {"kind": "tacho", "name": "k", "shaft": "input"})


def test_missing_samples_of_the_source_are_refused_with_their_place() -> None:
    x = tone(50.0, N)
    x[77] = np.nan
    with pytest.raises(SpecError, match="sample 77"):
        run(motion(disc__y__acceleration=x), ACC)
