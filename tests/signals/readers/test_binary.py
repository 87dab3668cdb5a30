"""npz, mat (level 5), wav and JSON: their forms, bombs, and files that are broken on purpose."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat, wavfile

from signals.ingest import Bounds, parse, read_description
from signals.readers.npz import open_file as open_npz
from signals.readers.wave import open_file as open_wav
from sim.core.errors import SidebandError, SpecError
from tests.strategies.bombs import repeated

X = np.random.default_rng(3).normal(size=500)
ABOUT = read_description({"sampling_rate_hz": 1000, "channels": [{"name": "a", "unit": "g"}]})


def refused(path: Path, reason: str, bounds: Bounds | None = None) -> None:
    with pytest.raises(SpecError, match=reason) as caught:
        parse(ABOUT, path, bounds)
    assert "\n" not in str(caught.value) and "Traceback" not in str(caught.value)


def npy(array: np.ndarray) -> bytes:
    stream = io.BytesIO()
    np.save(stream, array)
    return stream.getvalue()


def test_an_array_that_is_there_twice_is_refused_not_chosen(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "r.npz", "w") as archive, pytest.warns(UserWarning, match="Duplicate"):
        archive.writestr("a.npy", npy(X))
        archive.writestr("a.npy", npy(2 * X))
    refused(tmp_path / "r.npz", "it holds a.npy more than once")


@pytest.mark.parametrize("rate", [np.nan, np.inf, 0.0, -1000.0, True])
def test_a_rate_that_is_none_is_refused(rate: float, tmp_path: Path) -> None:
    np.savez(tmp_path / "r.npz", a=X, sampling_rate_hz=np.array(rate))
    refused(tmp_path / "r.npz", "its sampling_rate_hz is .*, not a number above 0")
    np.savez(tmp_path / "r.npz", a=X, sampling_rate_hz=np.array([1000]))
    assert parse(ABOUT, tmp_path / "r.npz").recording.sampling_rate_hz == 1000.0


@pytest.mark.slow
def test_a_zip_bomb_is_refused_by_its_directory(tmp_path) -> None:
    path = tmp_path / "bomb.npz"
    path.write_bytes(repeated(npy(np.zeros(1_000_000)), 48))
    assert path.stat().st_size < 1_000_000
    refused(path, "too large once unpacked", Bounds(unpacked_bytes=200_000_000))


def test_members_that_lie_about_their_size_are_refused(tmp_path) -> None:
    path = tmp_path / "r.npz"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("a.npy", npy(X).replace(b"(500,), }" + b" " * 12, b"(500000000000,), }   "))
    refused(path, "does not fit")


def test_python_objects_are_never_loaded(tmp_path) -> None:
    np.savez(tmp_path / "r.npz", a=np.array([{"x": 1}], dtype=object))
    refused(tmp_path / "r.npz", "never loaded")


def test_too_many_members(tmp_path) -> None:
    np.savez(tmp_path / "r.npz", **{f"x{i}": X[:1] for i in range(12)})
    refused(tmp_path / "r.npz", "too many arrays", Bounds(members=10))


def test_fortran_order_and_small_types_are_read(tmp_path) -> None:
    matrix = np.asfortranarray(np.arange(20, dtype=np.int16).reshape(10, 2))
    np.savez_compressed(tmp_path / "r.npz", m=matrix)
    with open_npz(tmp_path / "r.npz", Bounds()) as contents:
        np.testing.assert_array_equal(contents.entries["m"].load(), matrix)


@pytest.mark.slow
def test_complex_numbers_are_refused(tmp_path) -> None:
    np.savez(tmp_path / "r.npz", a=X + 1j)
    refused(tmp_path / "r.npz", "complex")
    savemat(tmp_path / "r.mat", {"a": X + 1j})
    refused(tmp_path / "r.mat", "complex")


@pytest.mark.slow
def test_mat_vectors_structures_and_rates(tmp_path) -> None:
    savemat(tmp_path / "r.mat", {"a": X, "s": {"field": 1}, "sampling_rate_hz": 512.0})
    about = read_description({"channels": [{"name": "a", "unit": "g"}]})
    found = parse(about, tmp_path / "r.mat").recording
    assert found.sampling_rate_hz == 512
    np.testing.assert_allclose(found.samples[0], X * 9.80665)


@pytest.mark.slow
def test_a_mat_that_unpacks_to_too_much_is_refused(tmp_path) -> None:
    savemat(tmp_path / "r.mat", {"a": np.zeros(4_000_000)}, do_compression=True)
    assert (tmp_path / "r.mat").stat().st_size < 100_000
    refused(tmp_path / "r.mat", "too large", Bounds(unpacked_bytes=10_000_000))


@pytest.mark.parametrize("bits", [8, 16, 24, 32])
def test_wav_of_whole_numbers_is_a_share_of_full_scale(tmp_path, bits: int) -> None:
    wanted = np.clip(X / 4, -0.99, 0.99)
    stored = np.round(wanted * (2 ** (bits - 1) - 1)).astype(np.int64)
    data = (stored + 128).astype(np.uint8).tobytes() if bits == 8 else stored.astype("<i4").tobytes()
    if bits > 8:
        data = np.frombuffer(data, np.uint8).reshape(-1, 4)[:, : bits // 8].tobytes()
    width = bits // 8
    layout = struct.pack("<HHIIHH", 1, 1, 1000, 1000 * width, width, bits)
    body = b"WAVE" + b"fmt " + struct.pack("<I", 16) + layout + b"data" + struct.pack("<I", len(data)) + data
    (tmp_path / "r.wav").write_bytes(b"RIFF" + struct.pack("<I", len(body)) + body)
    with open_wav(tmp_path / "r.wav", Bounds()) as contents:
        assert (list(contents.entries), contents.rate_hz) == (["channel"], 1000.0)
        np.testing.assert_allclose(contents.entries["channel"].load(), wanted, atol=1.6 / 2 ** (bits - 1))


def test_wav_channels_by_name_or_number(tmp_path) -> None:
    wavfile.write(tmp_path / "r.wav", 800, np.stack([X, 2 * X], axis=1).astype(np.float32))
    entries = [{"name": "one", "column": 1, "unit": "1"}, {"name": "two", "column": "channel2", "unit": "1"}]
    found = parse(read_description({"channels": entries}), tmp_path / "r.wav").recording
    assert found.sampling_rate_hz == 800
    np.testing.assert_array_equal(found.samples[0], found.samples[1])


def test_json_rows_and_nulls(tmp_path) -> None:
    (tmp_path / "d.json").write_text(json.dumps({"data": [[i, i * i] for i in range(10)], "a": [1, None] * 5}))
    entries = [{"name": "y", "column": "data[:,1]", "unit": "1"}, {"name": "a", "unit": "1"}]
    found = parse(read_description({"sampling_rate_hz": 1, "channels": entries}), tmp_path / "d.json").recording
    np.testing.assert_array_equal(found.samples[0], np.arange(10) ** 2)
    assert np.isnan(found.samples[1, 1])
    (tmp_path / "d.json").write_text('{"a": [[1, 2], [3]]}')
    refused(tmp_path / "d.json", "cannot be read")


def npz(path: Path) -> None:
    np.savez_compressed(path, a=X)


def values(path: Path) -> None:
    path.write_text(json.dumps({"a": X.tolist()}))


def text(path: Path) -> None:
    path.write_text("a,b\n" + "".join(f"{x},{x}\n" for x in X))


def wav(path: Path) -> None:
    wavfile.write(path, 1000, X.astype(np.float32))


WRITERS: dict[str, Callable[[Path], None]] = {"r.npz": npz, "r.wav": wav, "r.json": values, "r.csv": text}
"""Formats that are read in this process; the others are in test_further_formats.py."""


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITERS)
@given(data=st.data())
def test_a_damaged_file_is_read_or_refused_and_nothing_else(tmp_path_factory, name: str, data: st.DataObject) -> None:
    path = tmp_path_factory.mktemp("f") / name
    WRITERS[name](path)
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 6))):
        place = data.draw(st.integers(0, min(len(content) - 1, 400)) | st.integers(0, len(content) - 1))
        content[place] = data.draw(st.integers(0, 255))
    path.write_bytes(content[: data.draw(st.integers(0, len(content)) | st.just(len(content)))])
    try:
        parse(ABOUT, path, Bounds(values=1_000_000, unpacked_bytes=10_000_000))
    except SidebandError as error:
        assert len(str(error)) < 2000
