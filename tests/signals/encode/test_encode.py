"""Files: the same bytes for the same recording, and the same numbers back."""

import io
import json
import time

import numpy as np
import pyarrow.parquet as pq
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.io import loadmat, wavfile

from signals.encode import FORMATS, MEDIA_TYPES, encode
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError, UnknownName
from sim.core.response import Channel


def recording(samples: np.ndarray | None = None, names: tuple[str, str] = ("r1.y.acceleration", "x")) -> Recording:
    values = np.random.default_rng(0).normal(0, 30, (2, 501)) if samples is None else samples
    return Recording(
        sampling_rate_hz=610.35,
        channels=(
            Channel(name=names[0], quantity="acceleration", unit="m/s^2", location="bearing1", axis="y"),
            Channel(name=names[1], quantity="displacement", unit="m", location="pinion", axis="x"),
        ),
        samples=values,
        operating=Operating(shaft="input", speed_hz=30.0),
        tacho=Tacho(shaft="input", pulse_times_s=np.array([0.0, 0.03]), pulses_per_revolution=1),
        notes="grüße",
        start_s=0.25,
    )


@pytest.mark.parametrize("fmt", FORMATS)
def test_bytes_are_the_same_every_time(fmt: str, monkeypatch: pytest.MonkeyPatch) -> None:
    first = encode(recording(), fmt)
    monkeypatch.setattr(time, "time", lambda: 2e9)
    monkeypatch.setattr(time, "localtime", lambda *_: time.gmtime(2e9))
    monkeypatch.setattr(time, "asctime", lambda *_: "another day")
    assert encode(recording(), fmt) == first
    assert fmt in MEDIA_TYPES


def test_npz_reads_back_exactly_without_pickle() -> None:
    source = recording()
    with np.load(io.BytesIO(encode(source, "npz")), allow_pickle=False) as file:
        assert np.array_equal(file["r1.y.acceleration"], source.samples[0])
        assert np.array_equal(file["x"], source.samples[1])
        assert float(file["sampling_rate_hz"]) == 610.35
        description = json.loads(str(file["description"]))
    assert description["operating"] == {"shaft": "input", "speed_hz": 30.0}
    assert description["channels"][0]["unit"] == "m/s^2"
    assert description["tacho"]["pulse_times_s"] == [0.0, 0.03]
    assert description["notes"] == "grüße"


@settings(deadline=None, max_examples=30)
@given(st.lists(st.floats(-1e30, 1e30).filter(lambda v: v == 0 or abs(v) > 1e-30), min_size=1, max_size=20))
def test_csv_reads_back_exactly(values: list[float]) -> None:
    text = encode(recording(np.array([values, values])), "csv").decode()
    lines = text.splitlines()
    assert lines[0] == "time_s,r1.y.acceleration [m/s^2],x [m]"
    rows = [[float(v) for v in line.split(",")] for line in lines[1:]]
    assert [row[1] for row in rows] == values
    assert rows[0][0] == 0.25


def test_parquet_has_units_and_exact_columns() -> None:
    source = recording()
    table = pq.read_table(io.BytesIO(encode(source, "parquet")))
    assert table.schema.field("x").metadata == {b"unit": b"m"}
    assert json.loads(table.schema.metadata[b"sideband"])["sampling_rate_hz"] == 610.35
    assert np.array_equal(table["x"].to_numpy(), source.samples[1])


def test_mat_reads_back_with_valid_names_and_no_clock() -> None:
    source = recording()
    data = encode(source, "mat")
    assert data[:24] == b"MATLAB 5.0 MAT-file, wri"
    assert b"Created on" not in data[:128]
    file = loadmat(io.BytesIO(data))
    assert np.array_equal(file["r1_y_acceleration"].ravel(), source.samples[0])
    assert file["sampling_rate_hz"].item() == 610.35


def test_wav_is_float_and_says_its_scale() -> None:
    source = recording()
    data = encode(source, "wav")
    rate, frames = wavfile.read(io.BytesIO(data))
    assert (rate, frames.dtype, frames.shape) == (610, np.float32, (501, 2))
    assert np.max(np.abs(frames)) == pytest.approx(1.0)
    start = data.index(b"ICMT") + 8
    comment = json.loads(data[start : data.index(b"\0", start)])
    assert comment["sampling_rate_hz"] == 610.35
    for column, channel in enumerate(comment["channels"]):
        assert np.allclose(frames[:, column] * channel["scale"], source.samples[column], rtol=1e-6, atol=1e-6)


def test_uff_58_has_its_records_in_place() -> None:
    source = recording()
    lines = encode(source, "uff").decode("ascii").split("\n")
    assert lines[:2] == ["    -1", "    58"]
    kind, count, even = int(lines[8][:10]), int(lines[8][10:20]), int(lines[8][20:30])
    assert (kind, count, even) == (4, 501, 1)
    assert float(lines[8][30:43]) == 0.25
    assert float(lines[8][43:56]) == pytest.approx(1 / 610.35, rel=1e-5)
    assert lines[9][47:48] == "s" and int(lines[9][:10]) == 17
    body = lines[13 : 13 + 126]
    values = [float(line[i : i + 20]) for line in body for i in range(0, len(line), 20)]
    assert values == pytest.approx(source.samples[0], rel=1e-11)
    assert lines[13 + 126] == "    -1"
    assert sum(line == "    58" for line in lines) == 2


def test_unknown_formats_and_clashing_names_are_refused() -> None:
    with pytest.raises(UnknownName, match="known: csv, npz"):
        encode(recording(), "xlsx")
    with pytest.raises(SpecError, match="rename"):
        encode(recording(names=("a b", "a_b")), "mat")
    with pytest.raises(SpecError, match="rename"):
        encode(recording(names=("description", "b")), "npz")
    with pytest.raises(SpecError, match="finite"):
        encode(recording(np.full((2, 4), np.nan)), "wav")
