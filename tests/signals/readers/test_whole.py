"""What looks damaged and is not: lengths left open, user blocks, byte order marks, data that look like borders."""

from __future__ import annotations

import struct

import numpy as np
import pytest

from signals.ingest import parse, read_description
from signals.readers.damage import damage
from signals.readers.guard import load_apart
from signals.readers.load import load
from sim.core.errors import SpecError
from tests.signals.readers.test_guard import ABOUT, WHOLE, X


@pytest.mark.slow
@pytest.mark.parametrize(
    ("length", "extra"),
    [
        (0xFFFFFFFF, b""),
        (0xFFFFFFFF, b"\0\0\0"),
        (0xFFFFFFFF - 36, b"\0\0\0"),
        (0x7FFFFFFF, b""),
        (0x7FFFF000, b"\0\0\0"),
    ],
)
def test_a_recorder_that_left_the_length_open_is_read_to_the_end(tmp_path, length: int, extra: bytes) -> None:
    WHOLE["r.wav"](tmp_path / "r.wav")
    content = bytearray((tmp_path / "r.wav").read_bytes())
    at = content.index(b"data") + 4
    content[at : at + 4] = struct.pack("<I", length)
    (tmp_path / "r.wav").write_bytes(content + extra)  # a frame that was begun
    assert damage(tmp_path / "r.wav") == ""
    about = read_description({"sampling_rate_hz": 1000, "channels": [{"name": "a", "unit": "1", "column": 1}]})
    for loader in (load, load_apart):
        found = parse(about, tmp_path / "r.wav", loader=loader).recording
        np.testing.assert_array_equal(found.samples[0], X.astype(np.float32))


@pytest.mark.slow
@pytest.mark.parametrize("block", [0, 512, 65536])
@pytest.mark.parametrize("name", ["r.h5", "r.mat"])
def test_an_hdf5_file_may_begin_after_a_user_block(tmp_path, name: str, block: int) -> None:
    with pytest.importorskip("h5py").File(tmp_path / name, "w", userblock_size=block) as file:
        file["a"] = X
    if name == "r.mat":
        with (tmp_path / name).open("r+b") as stream:
            stream.write(b"MATLAB 7.3 MAT-file"[: block or 0])
    assert parse(ABOUT, tmp_path / name).recording.samples.shape == (1, X.size)
    whole = (tmp_path / name).read_bytes()
    (tmp_path / name).write_bytes(whole[:-9])
    with pytest.raises(SpecError, match="cut short"):
        parse(ABOUT, tmp_path / name)


@pytest.mark.slow
@pytest.mark.parametrize("newline", [b"\n", b"\r\n"])
def test_a_universal_file_may_begin_with_a_byte_order_mark(tmp_path, newline: bytes) -> None:
    WHOLE["r.uff"](tmp_path / "r.uff")
    (tmp_path / "r.uff").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "r.uff").read_bytes().replace(b"\n", newline))
    np.testing.assert_allclose(parse(ABOUT, tmp_path / "r.uff").recording.samples[0] / 9.80665, X, rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("line", "newline"),
    [(b"    -1", b"\n"), (b"    -1", b"\r\n"), (b"        -1", b"\n"), (b"    -1" + b" " * 74, b"\r\n")],
)
def test_a_line_of_minus_one_within_a_dataset_is_no_border(tmp_path, line: bytes, newline: bytes) -> None:
    WHOLE["r.uff"](tmp_path / "r.uff")
    whole = (tmp_path / "r.uff").read_bytes()
    other = b"    -1\n   151\nmodel\n%s\nmore\n    -1\n" % line
    for content in (other + whole, whole + other):
        (tmp_path / "r.uff").write_bytes(content.replace(b"\n", newline))
        assert damage(tmp_path / "r.uff") == ""
        np.testing.assert_allclose(parse(ABOUT, tmp_path / "r.uff").recording.samples[0] / 9.80665, X, rtol=1e-9)
    for cut in (whole + b"    -1\n", other + whole[:-7], other + whole[: len(whole) // 2]):
        (tmp_path / "r.uff").write_bytes(cut.replace(b"\n", newline))
        assert "no end" in damage(tmp_path / "r.uff")


@pytest.mark.slow
def test_lines_between_universal_datasets_are_left_to_the_parser(tmp_path) -> None:
    WHOLE["r.uff"](tmp_path / "r.uff")
    whole = (tmp_path / "r.uff").read_bytes()
    (tmp_path / "r.uff").write_bytes(b"    -1\n   151\nmodel\n    -1\nby hand\n" + whole + b"the end\n")
    assert damage(tmp_path / "r.uff") == ""
    assert parse(ABOUT, tmp_path / "r.uff").recording.samples.shape == (1, X.size)


@pytest.mark.parametrize(
    ("head", "said"),
    [
        (b"PK\x03\x04\x14\0", "archive"),
        (b"\xef\xbb\xbf\n<!DOCTYPE html><html>", "HTML page"),
        (b"a,b\n1,2\n", ""),
        (b"<header>\n1\n", ""),
    ],
)
def test_what_is_no_text_under_a_text_name_is_told(tmp_path, head: bytes, said: str) -> None:
    (tmp_path / "r.csv").write_bytes(head + b"1,2\n" * 20)
    found = damage(tmp_path / "r.csv")
    assert said in found and bool(found) == bool(said)
