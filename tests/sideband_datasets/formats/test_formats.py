from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from sideband_datasets import COLUMNS, rows
from sideband_datasets.formats import FORMATS, fingerprint, format_named, record_of
from sim.core.errors import UnknownName
from tests.sideband_datasets.small import tiny

EQUAL = tiny(count=3, peaks={"spectra": ["envelope"]}, sampling_rate_hz=10_000, splits={"train": 1.0})
RAGGED = tiny(count=3, windows={"length_revolutions": 2}, peaks={"spectra": []}, splits={"train": 1.0})


@pytest.fixture(scope="module")
def equal():
    return list(rows(EQUAL))


@pytest.fixture(scope="module")
def ragged():
    return list(rows(RAGGED))


def _content(path: Path) -> dict[str, bytes]:
    files = [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.is_file())
    return {str(p.relative_to(path.parent)): p.read_bytes() for p in files}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(FORMATS))
@pytest.mark.parametrize("which", ["equal", "ragged", "empty"])
def test_what_is_written_is_read_back_bit_for_bit(name, which, request, tmp_path):
    pytest.importorskip(FORMATS[name].package or "numpy")
    given = [] if which == "empty" else request.getfixturevalue(which)
    path = tmp_path / f"shard{FORMATS[name].suffix}"
    FORMATS[name].write(path, given)
    found = list(FORMATS[name].read(path))
    assert [set(record) for record in found] == [{c.name for c in COLUMNS}] * len(given)
    assert [fingerprint(record) for record in found] == [fingerprint(record_of(row)) for row in given]


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(FORMATS))
def test_the_same_rows_are_the_same_bytes(name, equal, tmp_path):
    pytest.importorskip(FORMATS[name].package or "numpy")
    path = tmp_path / f"shard{FORMATS[name].suffix}"
    FORMATS[name].write(path, equal)
    first = _content(path)
    shutil.rmtree(path) if path.is_dir() else path.unlink()
    FORMATS[name].write(path, equal)
    assert _content(path) == first


def test_a_changed_bit_changes_the_fingerprint(equal):
    record = record_of(equal[0])
    changed = {**record, "signal": record["signal"].copy()}
    changed["signal"][3] = np.nextafter(changed["signal"][3], np.float32(np.inf))
    assert fingerprint(changed) != fingerprint(record)
    assert fingerprint({**record, "speed_hz": np.nextafter(record["speed_hz"], 100.0).item()}) != fingerprint(record)


def test_pandas_and_pyarrow_read_parquet(equal, tmp_path):
    pandas = pytest.importorskip("pandas")
    parquet = pytest.importorskip("pyarrow.parquet")
    FORMATS["parquet"].write(tmp_path / "a.parquet", equal)
    frame = pandas.read_parquet(tmp_path / "a.parquet")
    assert list(frame.columns) == [c.name for c in COLUMNS]
    assert np.array_equal(frame.signal[5], equal[5].signal)
    assert frame.fault_type.tolist() == [row.fault_type for row in equal]
    field = parquet.read_schema(tmp_path / "a.parquet").field("bpfo_hz")
    assert field.metadata[b"unit"] == b"Hz"
    peaks = frame.peaks[0]
    assert [p["label"] for p in peaks] == [p.label for p in equal[0].peaks]


def test_h5py_reads_hdf5(equal, ragged, tmp_path):
    h5py = pytest.importorskip("h5py")
    FORMATS["hdf5"].write(tmp_path / "a.h5", equal)
    with h5py.File(tmp_path / "a.h5") as file:
        assert file["signal"].shape == (12, equal[0].samples)
        assert file["signal"].attrs["description"] == "The samples."
        assert np.array_equal(file["signal"][5], equal[5].signal)
        assert file["fault_type"].asstr()[...].tolist() == [row.fault_type for row in equal]
    FORMATS["hdf5"].write(tmp_path / "b.h5", ragged)
    with h5py.File(tmp_path / "b.h5") as file:
        ends = np.cumsum(file["samples"][...])
        assert np.array_equal(file["signal"][ends[0] : ends[1]], ragged[1].signal)


@pytest.mark.slow
def test_zarr_reads_zarr(equal, tmp_path):
    zarr = pytest.importorskip("zarr")
    FORMATS["zarr"].write(tmp_path / "a.zarr", equal)
    group = zarr.open_group(str(tmp_path / "a.zarr"), mode="r")
    assert np.array_equal(group["signal"][5], equal[5].signal)
    assert group["speed_hz"].attrs["unit"] == "Hz"


LOADER = """
import hashlib, json, sys, webdataset
for sample in webdataset.WebDataset(sys.argv[1], shardshuffle=False).decode():
    about = sample["json"]
    print(about["signal_id"], hashlib.sha256(sample["npy"].tobytes()).hexdigest(), about["fault_type"])
"""


@pytest.mark.slow
def test_webdataset_reads_the_tar(equal, tmp_path):
    """In a process of its own: the loader leaves files open."""
    pytest.importorskip("webdataset")
    FORMATS["webdataset"].write(tmp_path / "a.tar", equal)
    told = subprocess.run(
        [sys.executable, "-c", LOADER, "a.tar"], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert told.returncode == 0, told.stderr
    found = [line.split() for line in told.stdout.splitlines()]
    assert found == [[r.signal_id, hashlib.sha256(r.signal.tobytes()).hexdigest(), r.fault_type] for r in equal]


def test_numpy_reads_npz(equal, tmp_path):
    FORMATS["npz"].write(tmp_path / "a.npz", equal)
    with np.load(tmp_path / "a.npz") as file:
        assert np.array_equal(file["signal"][5], equal[5].signal)


def test_an_unknown_format_is_told():
    with pytest.raises(UnknownName, match="did you mean parquet"):
        format_named("parqet")
