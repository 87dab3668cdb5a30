"""Formats behind optional packages: read as written by those packages, and refused when broken."""

from __future__ import annotations

import importlib
import re
import sys
import tomllib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from scipy.io import savemat

from signals.encode import describe, encode
from signals.ingest import Bounds, parse, read_description
from signals.readers.formats import FORMATS
from signals.readers.guard import load_apart
from signals.readers.load import load
from signals.recording import Recording
from sim.core.errors import SidebandError, SpecError
from sim.core.response import Channel

RATE = 1024.0
A, B = np.random.default_rng(5).normal(size=(2, 600))
CHANNELS = [{"name": "a", "unit": "g"}, {"name": "b", "unit": "m/s^2"}]


def needs(package: str):
    return pytest.importorskip(package, reason=f"the optional package {package} is not installed")


def write_parquet(path: Path) -> None:
    pq.write_table(pa.table({"a": A, "b": B.astype(np.float32), "text": ["x"] * A.size}), path)


def write_hdf5(path: Path) -> None:
    with needs("h5py").File(path, "w") as file:
        file.create_dataset("a", data=A, compression="gzip").attrs["unit"] = "g"
        file["b"] = B
        file["run/a"] = -A
        file["both"] = np.stack([A, B])
        file["text"] = "words"
        file.attrs["sampling_rate_hz"] = RATE


def write_mat73(path: Path) -> None:
    h5py = needs("h5py")
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, values in {"a": A[None, :], "b": B[None, :], "both": np.stack([A, B])}.items():
            file[name] = values  # column by column: MATLAB's n x 2 is 2 x n here
            file[name].attrs["MATLAB_class"] = np.bytes_("double")
        file["#refs#/x"] = [1.0]
    with path.open("r+b") as stream:
        stream.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


def write_tdms(path: Path) -> None:
    nptdms = needs("nptdms")
    about = {"wf_increment": 1 / RATE, "unit_string": "g"}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment(
            [
                nptdms.ChannelObject("rig", "a", A, about),
                nptdms.ChannelObject("rig", "b", B, {"wf_increment": 1 / RATE}),
                nptdms.ChannelObject("slow", "t", A[:20], {"wf_increment": 1.0}),
            ]
        )


def write_mdf(path: Path) -> None:
    asammdf = needs("asammdf")
    stamps = np.arange(A.size) / RATE
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(A, stamps, unit="g", name="a"), asammdf.Signal(B, stamps, name="b")])
        file.save(path, overwrite=True)


def write_flac(path: Path) -> None:
    needs("soundfile").write(path, np.stack([A, B], axis=1) / 8, int(RATE), subtype="PCM_24")


def write_uff(path: Path) -> None:
    needs("pyuff")
    channels = (
        Channel(name="a", quantity="", unit="g", location=""),
        Channel(name="b", quantity="", unit="m/s^2", location=""),
    )
    path.write_bytes(encode(Recording(sampling_rate_hz=RATE, channels=channels, samples=np.stack([A, B])), "uff"))


def write_mat5(path: Path) -> None:
    savemat(path, {"a": A, "b": B, "c": {"d": "e"}}, do_compression=path.stem == "packed")


WRITERS: dict[str, Callable[[Path], None]] = {
    "r.parquet": write_parquet,
    "r.h5": write_hdf5,
    "r.mat": write_mat73,
    "r.tdms": write_tdms,
    "r.mf4": write_mdf,
    "r.uff": write_uff,
}


@pytest.mark.parametrize("name", WRITERS)
def test_channels_come_out_as_written(tmp_path, name: str) -> None:
    WRITERS[name](tmp_path / name)
    about = read_description({"sampling_rate_hz": RATE, "channels": CHANNELS})
    found = parse(about, tmp_path / name, loader=load).recording
    tolerance = {"r.parquet": 1e-6, "r.uff": 1e-11}.get(name, 1e-14)
    np.testing.assert_allclose(found.samples, [A * 9.80665, B], rtol=tolerance, atol=tolerance)


@pytest.mark.parametrize("name", ["r.h5", "r.tdms", "r.mf4", "r.uff"])
def test_the_file_states_its_rate_and_units(tmp_path, name: str) -> None:
    WRITERS[name](tmp_path / name)
    about = read_description({"channels": CHANNELS})
    assert parse(about, tmp_path / name, loader=load).recording.sampling_rate_hz == pytest.approx(RATE, rel=1e-9)
    wrong = read_description({"channels": [{"name": "a", "unit": "m/s^2"}]})
    with pytest.raises(SpecError, match="the file itself states"):
        parse(wrong, tmp_path / name, loader=load)
    slow = read_description({"sampling_rate_hz": 2 * RATE, "channels": CHANNELS})
    with pytest.raises(SpecError, match="does not agree"):
        parse(slow, tmp_path / name, loader=load)


def test_flac_is_read_as_shares_of_full_scale(tmp_path) -> None:
    write_flac(tmp_path / "r.flac")
    entries = [{"name": "a", "column": 0, "unit": "full scale"}, {"name": "b", "column": "channel2", "unit": "V"}]
    found = parse(read_description({"channels": entries}), tmp_path / "r.flac", loader=load).recording
    np.testing.assert_allclose(found.samples * 8, [A, B], atol=2e-6)


@pytest.mark.parametrize(("name", "column"), [("r.h5", "both[1,:]"), ("r.mat", "both[:,1]")])
def test_rows_and_columns_are_those_the_writer_saw(tmp_path, name: str, column: str) -> None:
    WRITERS[name](tmp_path / name)
    entries = [{"name": "x", "column": column, "unit": "1"}]
    found = (
        parse(read_description({"sampling_rate_hz": 1.0, "channels": entries}), tmp_path / name, loader=load)
        if name == "r.mat"
        else parse(read_description({"channels": entries}), tmp_path / name, loader=load)
    )
    np.testing.assert_array_equal(found.recording.samples[0], B)


def test_groups_and_channels_of_another_rate(tmp_path) -> None:
    write_hdf5(tmp_path / "r.h5")
    about = read_description({"channels": [{"name": "x", "column": "run/a", "unit": "1"}]})
    np.testing.assert_array_equal(parse(about, tmp_path / "r.h5", loader=load).recording.samples[0], -A)
    write_tdms(tmp_path / "r.tdms")
    about = read_description({"channels": [{"name": "x", "column": "rig/a", "unit": "g"}, {"name": "t", "unit": "1"}]})
    with pytest.raises(SpecError, match="unequal length"):
        parse(about, tmp_path / "r.tdms", loader=load)


def test_rounded_stamps_of_an_mdf_are_taken(tmp_path) -> None:
    asammdf = needs("asammdf")
    stamps = np.round(np.arange(A.size) / 25_600.0, 6)
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(A, stamps, name="a")])
        file.save(tmp_path / "r.mf4", overwrite=True)
    about = read_description({"channels": [{"name": "a", "unit": "1"}]})
    found = parse(about, tmp_path / "r.mf4", loader=load).recording
    assert found.sampling_rate_hz == pytest.approx(25_600.0, rel=1e-6)


def test_irregular_stamps_of_an_mdf_are_refused_with_where(tmp_path) -> None:
    asammdf = needs("asammdf")
    stamps = np.arange(A.size) / RATE
    stamps[300:] += 1.0
    with asammdf.MDF(version="4.10") as file:
        file.append([asammdf.Signal(A, stamps, name="a")])
        file.save(tmp_path / "r.mf4", overwrite=True)
    with pytest.raises(SpecError, match="irregular from sample 300"):
        parse(read_description({"channels": [{"name": "a", "unit": "1"}]}), tmp_path / "r.mf4", loader=load)


def test_hdf5_never_reaches_outside_the_file(tmp_path) -> None:
    h5py = needs("h5py")
    (tmp_path / "secret").write_bytes(A.tobytes())
    write_hdf5(tmp_path / "other.h5")
    with h5py.File(tmp_path / "r.h5", "w") as file:
        file["linked"] = h5py.ExternalLink("other.h5", "/a")
        file["soft"] = h5py.SoftLink("/a")
        file.create_dataset("a", shape=(600,), dtype="f8", external=[("secret", 0, 4800)])
        layout = h5py.VirtualLayout(shape=(600,), dtype="f8")
        layout[:] = h5py.VirtualSource("other.h5", "a", shape=(600,))
        file.create_virtual_dataset("v", layout)
    for name, reason in (
        ("linked", "not in the file"),
        ("soft", "not in the file"),
        ("a", "another file"),
        ("v", "another file"),
    ):
        about = read_description({"sampling_rate_hz": 1.0, "channels": [{"name": name, "column": name, "unit": "1"}]})
        with pytest.raises(SpecError, match=reason):
            parse(about, tmp_path / "r.h5", loader=load)


@pytest.mark.slow
def test_an_hdf5_bomb_is_refused_by_its_shape(tmp_path) -> None:
    with needs("h5py").File(tmp_path / "r.h5", "w") as file:
        file.create_dataset("a", shape=(10**10,), dtype="f8", compression="gzip", fillvalue=0.0)
    assert (tmp_path / "r.h5").stat().st_size < 100_000
    with pytest.raises(SpecError, match="too large"):
        parse(read_description({"sampling_rate_hz": 1.0, "channels": CHANNELS[:1]}), tmp_path / "r.h5")


def test_parquet_texts_are_no_samples(tmp_path) -> None:
    write_parquet(tmp_path / "r.parquet")
    about = read_description({"sampling_rate_hz": 1.0, "channels": [{"name": "text", "unit": "1"}]})
    with pytest.raises(SpecError, match="holds no numbers"):
        parse(about, tmp_path / "r.parquet", loader=load)


@pytest.mark.parametrize("fmt", ["parquet", "uff"])
def test_what_the_encoders_write_comes_back(tmp_path, fmt: str) -> None:
    if fmt == "uff":
        needs("pyuff")
    channels = (Channel(name="mesh1.stiffness", quantity="stiffness", unit="N/m", location="mesh1"),)
    recording = Recording(sampling_rate_hz=610.3515625, channels=channels, samples=A[None, :])
    (tmp_path / f"r.{fmt}").write_bytes(encode(recording, fmt))
    found = parse(read_description(describe(recording)), tmp_path / f"r.{fmt}", loader=load).recording
    np.testing.assert_allclose(found.samples, recording.samples, rtol=1e-11)
    assert (found.channels, found.sampling_rate_hz) == (channels, 610.3515625)


OPTIONAL = [
    ("r.h5", "hdf5", "h5py", "formats"),
    ("r.hdf5", "hdf5", "h5py", "formats"),
    ("r.mat", "hdf5", "h5py", "formats"),
    ("r.flac", "flac", "soundfile", "formats"),
    ("r.uff", "uff", "pyuff", "formats"),
    ("r.unv", "uff", "pyuff", "formats"),
    ("r.tdms", "tdms", "nptdms", "formats"),
    ("r.mf4", "mdf", "asammdf", "mdf"),
]


@pytest.mark.parametrize(("name", "module", "package", "extra"), OPTIONAL)
def test_a_missing_package_is_named_with_its_extra(
    tmp_path, monkeypatch, name: str, module: str, package: str, extra: str
) -> None:
    writers = {**WRITERS, "r.hdf5": write_hdf5, "r.unv": write_uff, "r.flac": write_flac}
    writers[name](tmp_path / name)
    monkeypatch.setitem(sys.modules, package, None)
    monkeypatch.delitem(sys.modules, f"signals.readers.{module}", raising=False)
    with pytest.raises(SpecError) as caught:
        parse(read_description({"channels": CHANNELS}), tmp_path / name, loader=load)
    (problem,) = caught.value.problems
    assert problem.field == name and f"needs the package {package}, which is not installed" in problem.message
    assert f"pip install -e '.[{extra}]' in" in problem.message
    assert ("MATLAB file of version 7.3" in problem.message) == (name == "r.mat")
    monkeypatch.undo()
    importlib.invalidate_caches()


def test_every_format_that_needs_a_package_of_its_own_says_so() -> None:
    told = tomllib.loads((Path(__file__).parents[3] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert {name for name, _, _, _ in OPTIONAL} - {"r.mat"} == {f"r{s}" for s, form in FORMATS.items() if form.extra}
    for _, module, package, extra in OPTIONAL:
        listed = [re.split("[>=<]", one)[0].lower() for one in told["optional-dependencies"][extra]]
        assert package in listed, f"{module}: the extra {extra} installs {package}"


@pytest.mark.slow
@pytest.mark.parametrize("name", [*WRITERS, "r.flac", "plain.mat", "packed.mat"])
def test_damaged_files_are_read_or_refused_and_nothing_else(tmp_path, name: str) -> None:
    """Apart, as strangers' files are: a parser may break down, the process that asks may not.

    What is empty, half or no such file at all is tried in `test_guard`.
    """
    {**WRITERS, "r.flac": write_flac, "plain.mat": write_mat5, "packed.mat": write_mat5}[name](tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    about = read_description(
        {"sampling_rate_hz": RATE, "channels": [{"name": "a", "column": 0 if "flac" in name else "a", "unit": "g"}]}
    )
    bounds = Bounds(values=1_000_000, unpacked_bytes=20_000_000, seconds=20)
    rng = np.random.default_rng(8)
    for content in (whole[:7], _damaged(whole, rng)):
        (tmp_path / name).write_bytes(content)
        try:
            parse(about, tmp_path / name, bounds, load_apart)
        except SidebandError as error:
            assert "\n" not in str(error)


def _damaged(whole: bytes, rng: np.random.Generator) -> bytes:
    content = bytearray(whole)
    for place in rng.integers(0, len(content), size=20):
        content[place] = int(rng.integers(0, 256))
    return bytes(content)
