"""A stranger's file is read apart: what breaks, hangs or grows there is a refusal here."""

from __future__ import annotations

import gzip
import io
import os
import re
import time
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io.wavfile
from scipy.io import savemat

from signals.encode import encode
from signals.ingest import Bounds, parse, read_description
from signals.readers.contents import TEXTS
from signals.readers.formats import FORMATS
from signals.readers.guard import load_apart, load_carefully
from signals.readers.load import Want, load
from signals.recording import Recording
from sim.core.errors import SpecError
from sim.core.response import Channel

X = np.random.default_rng(3).normal(size=500)
ABOUT = read_description({"sampling_rate_hz": 1000, "channels": [{"name": "a", "unit": "g"}]})
BREAKS_AT, BREAKS_WITH = 177, 54
"""Changing this byte of a level 5 file makes SciPy 1.17 read through a wild pointer (found by damaging bytes)."""


def breaking(path: Path) -> Path:
    stream = io.BytesIO()
    savemat(stream, {"a": X})
    content = bytearray(stream.getvalue())
    content[BREAKS_AT] = BREAKS_WITH
    path.write_bytes(content)
    return path


@pytest.mark.slow
def test_apart_is_the_same_as_here(tmp_path) -> None:
    np.savez(tmp_path / "r.npz", a=X, time_s=np.arange(500.0), sampling_rate_hz=50.0)
    wanted = [Want(field="f", column="a")]
    here, apart = (door(tmp_path / "r.npz", wanted, True, Bounds()) for door in (load, load_apart))
    np.testing.assert_array_equal(here.wanted[0].samples, apart.wanted[0].samples)
    np.testing.assert_array_equal(here.times["time_s"].samples, apart.times["time_s"].samples)
    assert here.rate_hz == apart.rate_hz == 50.0
    (tmp_path / "r.csv").write_text("a\n" + "1.25\n" * 20 + "1.")
    here, apart = (door(tmp_path / "r.csv", wanted, True, Bounds()) for door in (load, load_apart))
    assert here.remarks == apart.remarks and "cut short" in here.remarks[0]


@pytest.mark.slow
def test_refusals_come_through_word_by_word(tmp_path) -> None:
    np.savez(tmp_path / "r.npz", b=X)
    told = []
    for door in (load, load_apart):
        with pytest.raises(SpecError) as caught:
            door(tmp_path / "r.npz", [Want(field="channels.0.column", column="a")], False, Bounds())
        told.append(str(caught.value))
    assert told[0] == told[1]


@pytest.mark.slow
@pytest.mark.parametrize("loader", [load_apart, load_carefully])
def test_a_parser_that_breaks_down_is_a_refusal(tmp_path, loader) -> None:
    path = breaking(tmp_path / "r.mat")
    with pytest.raises(SpecError, match=r"r.mat: cannot be read") as caught:
        parse(ABOUT, path, loader=loader)
    assert "\n" not in str(caught.value)


@pytest.mark.slow
def test_memory_is_bounded(tmp_path) -> None:
    # compressed zeros that claim to be small enough to be tried
    savemat(tmp_path / "r.mat", {"a": np.zeros(30_000_000)}, do_compression=True)
    bounds = Bounds(memory_bytes=350 * 2**20)
    with pytest.raises(SpecError, match="memory"):
        parse(ABOUT, tmp_path / "r.mat", bounds, load_apart)


@pytest.mark.slow
def test_time_is_bounded(tmp_path) -> None:
    os.mkfifo(tmp_path / "r.csv")  # nobody ever writes to it
    begin = time.monotonic()
    with pytest.raises(SpecError, match="longer than 1 s"):
        parse(ABOUT, tmp_path / "r.csv", Bounds(seconds=1), load_apart)
    assert time.monotonic() - begin < 60


@pytest.mark.slow
def test_nothing_is_left_behind(tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with pytest.raises(SpecError):
        parse(ABOUT, breaking(tmp_path / "r.mat"), loader=load_apart)
    assert [f.name for f in tmp_path.iterdir()] == ["r.mat"]


def _wav(path: Path) -> None:
    scipy.io.wavfile.write(path, 1000, np.stack([X, X], axis=1).astype(np.float32))


def _hdf5(path: Path) -> None:
    with pytest.importorskip("h5py").File(path, "w") as file:
        file["a"] = X


def _tdms(path: Path) -> None:
    nptdms = pytest.importorskip("nptdms")
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([nptdms.ChannelObject("rig", "a", X, {"wf_increment": 1e-3})])


def _mdf(path: Path) -> None:
    asammdf = pytest.importorskip("asammdf")
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(X, np.arange(X.size) / 1000, name="a")])
        file.save(path, overwrite=True)


def _uff(path: Path) -> None:
    pytest.importorskip("pyuff")
    channels = (Channel(name="a", quantity="", unit="g", location=""),)
    path.write_bytes(encode(Recording(sampling_rate_hz=1e3, channels=channels, samples=X[None, :]), "uff"))


WHOLE = {
    "level5.mat": lambda path: savemat(path, {"a": X}),
    "packed.mat": lambda path: savemat(path, {"a": X}, do_compression=True),
    "level4.mat": lambda path: savemat(path, {"a": X}, format="4"),
    "r.npz": lambda path: np.savez(path, a=X),
    "r.wav": _wav,
    "r.parquet": lambda path: pq.write_table(pa.table({"a": X}), path),
    "r.h5": _hdf5,
    "r.tdms": _tdms,
    "r.mf4": _mdf,
    "r.uff": _uff,
    "r.flac": lambda path: pytest.importorskip("soundfile").write(path, X / 8, 1000),
}
LIBRARIES = re.compile(
    r"numpy|scipy|zip file|utf-8|eof =|sblock|thrift|magic|seek|reshape|understood|Segment|Error|Exception|\[Errno",
    re.I,
)
"""Words of parsers, which say nothing to the person with the file."""


@pytest.mark.slow
@pytest.mark.parametrize("name", WHOLE)
def test_a_file_that_was_cut_or_is_another_kind_is_told_so_in_plain_words(tmp_path, name: str) -> None:
    path = tmp_path / name
    WHOLE[name](path)
    whole = path.read_bytes()
    about = read_description(
        {
            "sampling_rate_hz": 1000,
            "channels": [{"name": "a", "unit": "1", "column": 0 if name[2:] in "flac wav" else "a"}],
        }
    )
    assert parse(about, path).recording.samples.shape == (1, X.size), "whole, it is read"
    for content, words in (
        (whole[: len(whole) * 6 // 10], "cut short"),
        (whole[:-9], "cut short"),
        (b"", "is empty"),
        (b"<html>404 not found</html>" * 40, "damaged, or of another kind"),
        (bytes(900), "damaged, or of another kind"),
    ):
        path.write_bytes(content)
        with pytest.raises(SpecError) as caught:
            parse(about, path)
        (problem,) = caught.value.problems
        assert problem.field == name and problem.message.startswith("cannot be read: it "), problem
        assert words in problem.message and not LIBRARIES.search(problem.message), problem


@pytest.mark.slow
def test_a_byte_that_changed_within_is_told_as_damage(tmp_path) -> None:
    for name in ("r.npz", "packed.mat"):
        WHOLE[name](tmp_path / name)
        content = bytearray((tmp_path / name).read_bytes())
        content[len(content) // 2] ^= 0xFF
        (tmp_path / name).write_bytes(content)
        with pytest.raises(SpecError, match="cannot be read: it is damaged"):
            parse(ABOUT, tmp_path / name)


def test_what_is_whole_but_not_known_keeps_the_parser_s_word(tmp_path) -> None:
    _wav(tmp_path / "r.wav")
    content = bytearray((tmp_path / "r.wav").read_bytes())
    content[20:22] = b"\x06\x00"  # A-law
    (tmp_path / "r.wav").write_bytes(content)
    with pytest.raises(SpecError, match=r"not read here \(Unknown wave file format: ALAW"):
        parse(ABOUT, tmp_path / "r.wav")


def test_texts_keep_what_their_parser_says(tmp_path) -> None:
    assert {suffix.removesuffix(".gz") for suffix in FORMATS if damage_is_not_told(suffix)} == TEXTS
    (tmp_path / "r.csv").write_text("a\n1\n2\nx3\n")
    with pytest.raises(SpecError, match="x3"):
        parse(ABOUT, tmp_path / "r.csv")
    whole = gzip.compress("\n".join(["a", *map(str, X)]).encode())
    (tmp_path / "r.csv.gz").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(SpecError, match="cut short"):
        parse(ABOUT, tmp_path / "r.csv.gz")


def damage_is_not_told(suffix: str) -> bool:
    return FORMATS[suffix].module in ("text", "values")
