"""From a description and a file to a recording: SI, alignment, rates, stamps, tacho, and every refusal."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from signals.checks import inspect
from signals.encode import describe, encode
from signals.ingest import Bounds, parse, read_description, read_recording
from signals.recording import Operating, Recording, Tacho
from signals.units import UNITS
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE, N = 1000.0, 400


@pytest.fixture
def samples() -> np.ndarray:
    return np.random.default_rng(1).normal(size=(2, N))


@pytest.fixture
def archive(tmp_path: Path, samples: np.ndarray) -> Path:
    np.savez(tmp_path / "r.npz", a=samples[0], b=samples[1], both=samples.T, short=samples[0, :50], words=np.array("x"))
    return tmp_path / "r.npz"


def refusal(call: Any, *arguments: Any, **options: Any) -> str:
    with pytest.raises(SpecError) as caught:
        call(*arguments, **options)
    return str(caught.value)


def test_samples_come_out_in_si_with_their_place(read, archive, samples) -> None:
    found = read(archive).recording
    np.testing.assert_array_equal(found.samples, [samples[0] * 9.80665, samples[1]])
    assert [c.unit for c in found.channels] == ["m/s^2", "m/s^2"]
    assert [(c.location, c.axis) for c in found.channels] == [("bearing1", "x"), ("bearing1", "y")]
    assert found.operating == Operating(shaft="input", speed_hz=25, torque_nm=3)
    assert (found.condition, found.origin, found.sampling_rate_hz) == ("baseline", "measured", RATE)


@pytest.mark.parametrize("column", ["both[:,1]", "both[:, 1]", "both[1]", "both.2"])
def test_a_part_of_a_matrix_is_a_channel(read, archive, samples, column: str) -> None:
    found = read(archive, channels=[{"name": "x", "column": column, "unit": "1"}]).recording
    np.testing.assert_array_equal(found.samples[0], samples[1])


def test_a_matrix_without_an_index_is_refused_with_what_to_write(read, archive) -> None:
    text = refusal(read, archive, channels=[{"name": "x", "column": "both", "unit": "1"}])
    assert "channels.0.column" in text and "both[:,0]" in text
    text = refusal(read, archive, channels=[{"name": "x", "column": "both[:,2]", "unit": "1"}])
    assert "beyond" in text and "0 to 1" in text


def test_what_is_not_in_the_file_is_named_with_what_is(read, archive) -> None:
    text = refusal(read, archive, channels=[{"name": "x", "unit": "g"}, {"name": "y", "unit": "g"}])
    assert "channels.0.column" in text and "channels.1.column" in text and "both[0] to both[1]" in text


def test_channels_of_unequal_length_are_refused(read, archive) -> None:
    text = refusal(read, archive, channels=[{"name": "a", "unit": "g"}, {"name": "short", "unit": "g"}])
    assert "unequal length" in text and "short: 50" in text


def test_texts_are_no_samples(read, archive) -> None:
    assert "words" in refusal(read, archive, channels=[{"name": "words", "unit": "g"}])


def test_a_missing_rate_is_never_guessed(read, archive) -> None:
    text = refusal(read, archive, sampling_rate_hz=...)
    assert "sampling_rate_hz" in text and "never guessed" in text


def test_a_rate_in_the_file_is_stated_and_must_agree(read, archive, samples, tmp_path) -> None:
    np.savez(tmp_path / "own.npz", a=samples[0], b=samples[1], sampling_rate_hz=RATE)
    assert read(tmp_path / "own.npz", sampling_rate_hz=...).recording.sampling_rate_hz == RATE
    assert "does not agree" in refusal(read, tmp_path / "own.npz", sampling_rate_hz=1024.0)


@pytest.mark.parametrize("unit", ["not stated", "furlong", ""])
def test_an_unknown_unit_is_refused(read, archive, unit: str) -> None:
    assert "channels.0.unit" in refusal(read, archive, channels=[{"name": "a", "unit": unit}])
    assert "channels.0.unit" in refusal(read, archive, channels=[{"name": "a"}])


def test_a_quantity_in_a_unit_of_another_is_refused(read, archive) -> None:
    text = refusal(read, archive, channels=[{"name": "a", "quantity": "acceleration", "unit": "mm/s"}])
    assert "channels.0.quantity" in text and "velocity" in text


@pytest.mark.parametrize("slip", ["accel", "aceleration"])
def test_a_quantity_that_a_slip_stands_for_is_refused_and_another_is_the_users_own(read, archive, slip: str) -> None:
    assert "acceleration?" in refusal(read, archive, channels=[{"name": "a", "quantity": slip, "unit": "g"}])
    for own in ("angular velocity", "acceleration_env", "strain"):
        found = read(archive, channels=[{"name": "a", "quantity": own, "unit": "1"}]).recording
        assert found.channels[0].quantity == own


def test_volts_become_what_the_sensor_senses(read, archive, samples) -> None:
    sensor = {"value": 100, "unit": "mV/g"}
    entry = {"name": "a", "quantity": "acceleration", "unit": "V", "sensitivity": sensor}
    found = read(archive, channels=[entry]).recording
    assert found.channels[0].unit == "m/s^2"
    np.testing.assert_allclose(found.samples[0], samples[0] / 0.1 * 9.80665, rtol=1e-14)
    entry["sensitivity"] = {"value": 10.22, "unit": "mV/(m/s^2)"}
    np.testing.assert_allclose(read(archive, channels=[entry]).recording.samples[0], samples[0] / 0.01022, rtol=1e-14)
    entry["sensitivity"] = 100
    assert "never guessed" in refusal(read, archive, channels=[entry])
    entry |= {"unit": "g"}
    np.testing.assert_array_equal(read(archive, channels=[entry]).recording.samples[0], samples[0] * 9.80665)


@pytest.mark.parametrize(
    ("quantity", "levels"), [("acceleration", "accelerations"), (" Velocity", "velocities"), ("force", "forces")]
)
@pytest.mark.parametrize("unit", ["V", "mV"])
def test_volts_of_no_stated_sensitivity_stay_volts_and_are_told(
    read, archive, samples, quantity: str, levels: str, unit: str
) -> None:
    entry = {"name": "a", "quantity": quantity, "unit": unit}
    found = read(archive, channels=[{"name": "b", "unit": "g"}, entry])
    assert found.recording.channels[1].unit == "V"
    np.testing.assert_allclose(found.recording.samples[1], samples[0] * UNITS[unit].factor, rtol=1e-14)
    (said,) = found.remarks
    assert said == f"channels.1: a is in V: no sensitivity is stated, so levels are not {levels}"


@pytest.mark.parametrize(
    "changes", [{"unit": "g"}, {"sensitivity": {"value": 100, "unit": "mV/g"}}, {"quantity": ""}, {"quantity": "probe"}]
)
def test_no_remark_where_the_level_is_known_or_volts_are_meant(read, archive, changes: dict[str, Any]) -> None:
    entry = {"name": "a", "quantity": "acceleration", "unit": "V", **changes}
    assert read(archive, channels=[entry]).remarks == ()


def test_uncalibrated_is_said_and_stays(read, archive, samples) -> None:
    found = read(archive, channels=[{"name": "a", "quantity": "acceleration", "unit": "uncalibrated"}]).recording
    assert found.channels[0].unit == "uncalibrated"
    np.testing.assert_array_equal(found.samples[0], samples[0])


def test_nan_is_kept_and_found_with_its_place(read, archive, samples, tmp_path) -> None:
    samples[0, 17:20] = np.nan
    np.savez(tmp_path / "nan.npz", a=samples[0], b=samples[1])
    (finding,) = inspect(read(tmp_path / "nan.npz").recording)
    assert (finding.channel, finding.kind, finding.samples) == ("a", "not_finite", 3)
    assert (finding.places[0].first, finding.places[0].stop) == (17, 20)


def test_tacho_from_a_channel_a_column_times_or_an_array(read, tmp_path) -> None:
    t = np.arange(2000) / RATE
    pulses = (np.mod(25 * t + 0.013, 1) < 0.2).astype(float)
    listed = [0.04 * k for k in range(1, 40)]
    np.savez(tmp_path / "p.npz", a=np.sin(t), b=pulses, pulse=pulses, when=np.array(listed))
    wheel = {"name": "b", "quantity": "voltage", "unit": "V"}
    channels = [{"name": "a", "quantity": "acceleration", "unit": "g"}, wheel]
    for source in ({"channel": "b"}, {"column": "pulse"}, {"channel": "pulse"}):
        tacho = read(tmp_path / "p.npz", channels=channels, tacho={"shaft": "input", **source}).recording.tacho
        np.testing.assert_allclose(np.diff(tacho.pulse_times_s), 0.04, atol=1e-9)
    for times in (listed, "when"):
        tacho = read(tmp_path / "p.npz", tacho={"shaft": "input", "pulse_times_s": times}).recording.tacho
        np.testing.assert_array_equal(tacho.pulse_times_s, listed)
    back = {"shaft": "input", "pulse_times_s": [0.1, 0.3, 0.2]}
    assert "pulse 2 is not after" in refusal(read, tmp_path / "p.npz", tacho=back)
    assert "exactly one" in refusal(read, tmp_path / "p.npz", tacho={"shaft": "input"})
    late = {"shaft": "input", "pulse_times_s": [1e3, 1e3 + 1.0]}
    assert "lie outside the recording" in refusal(read, tmp_path / "p.npz", tacho=late)


def test_sizes_are_refused_before_anything_is_read(read, archive) -> None:
    size = archive.stat().st_size
    assert "too large" in refusal(read, archive, Bounds(file_bytes=size - 1))
    assert "too many samples" in refusal(read, archive, Bounds(values=2 * N - 1))
    assert read(archive, Bounds(values=2 * N, file_bytes=size))


def test_unknown_formats_and_missing_files_are_refused(read, tmp_path) -> None:
    (tmp_path / "r.xls").write_bytes(b"x")
    assert ".npz" in refusal(read, tmp_path / "r.xls")
    assert "no such file" in refusal(read, tmp_path / "nowhere.npz")


@pytest.mark.slow
@pytest.mark.parametrize("fmt", ["csv", "npz", "mat", "wav"])
@pytest.mark.parametrize("name", ["a", "resonator1.y.acceleration", "a [x]"])
def test_what_the_encoders_write_comes_back(tmp_path, samples, fmt: str, name: str) -> None:
    recording = Recording(
        sampling_rate_hz=610.35,
        channels=(
            Channel(name=name, quantity="acceleration", unit="m/s^2", location="bearing1", axis="x"),
            Channel(name="z", quantity="angle", unit="rad", location="gear"),
        ),
        samples=samples,
        operating=Operating(shaft="input", speed_hz=20.0),
        tacho=Tacho(shaft="input", pulse_times_s=np.array([0.3, 0.35]), pulses_per_revolution=3),
        start_s=0.25,
    )
    (tmp_path / f"r.{fmt}").write_bytes(encode(recording, fmt))
    (tmp_path / "r.json").write_text(json.dumps(describe(recording)))
    found = read_recording(tmp_path / "r.json")
    tolerance = 1e-6 if fmt == "wav" else 0
    np.testing.assert_allclose(found.samples, recording.samples, rtol=tolerance, atol=tolerance)
    assert found.channels == recording.channels
    assert (found.sampling_rate_hz, found.start_s, found.operating) == (610.35, 0.25, recording.operating)
    np.testing.assert_array_equal(found.tacho.pulse_times_s, [0.3, 0.35])


@given(unit=st.sampled_from(sorted(UNITS)), value=st.floats(-1e6, 1e6).filter(lambda v: v == 0 or abs(v) > 1e-12))
def test_conversion_is_one_line(tmp_path_factory, unit: str, value: float) -> None:
    path = tmp_path_factory.mktemp("u") / "r.npz"
    np.savez(path, a=np.full(8, value))
    about = read_description({"sampling_rate_hz": 10, "channels": [{"name": "a", "unit": unit}]})
    found = parse(about, path).recording
    assert found.samples[0, 0] == value * UNITS[unit].factor + UNITS[unit].offset
    assert found.channels[0].unit == UNITS[unit].si
