"""The formats by name."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from sideband_datasets.formats import array_file, hdf5, parquet, tar, zarr_group
from sideband_datasets.formats.record import Record
from sideband_datasets.row import Row
from sim.core.errors import Problem, SpecError, UnknownName


@dataclass(frozen=True, kw_only=True)
class Format:
    """How a shard is written, from rows that may come as they are made, and read back.

    `package` is what it needs beside the locked dependencies."""

    name: str
    suffix: str
    media_type: str
    sentence: str
    write: Callable[[Path, Iterable[Row]], None]
    read: Callable[[Path], Iterator[Record]]
    package: str = ""


FORMATS: Mapping[str, Format] = {
    found.name: found
    for found in (
        Format(
            name="parquet",
            suffix=".parquet",
            media_type="application/x-parquet",
            sentence="Apache Parquet, one row a window; the folder is laid out as the Hugging Face loader wants it.",
            write=parquet.write,
            read=parquet.read,
        ),
        Format(
            name="hdf5",
            suffix=".h5",
            media_type="application/x-hdf5",
            sentence="HDF5, one array a column.",
            write=hdf5.write,
            read=hdf5.read,
            package="h5py",
        ),
        Format(
            name="zarr",
            suffix=".zarr",
            media_type="application/x-zarr",
            sentence="Zarr (version 2 layout), a folder a shard, one array a column.",
            write=zarr_group.write,
            read=zarr_group.read,
            package="zarr",
        ),
        Format(
            name="webdataset",
            suffix=".tar",
            media_type="application/x-tar",
            sentence="WebDataset: tar with KEY.npy, KEY.json and KEY.txt (its class) of each row.",
            write=tar.write,
            read=tar.read,
        ),
        Format(
            name="npz",
            suffix=".npz",
            media_type="application/zip",
            sentence="NumPy, one array a column.",
            write=array_file.write,
            read=array_file.read,
        ),
    )
}


def format_named(name: str) -> Format:
    """A format whose package is there; UnknownName lists what exists, SpecError says what has to be installed."""
    if name not in FORMATS:
        raise UnknownName("format", name, tuple(FORMATS))
    found = FORMATS[name]
    if found.package and importlib.util.find_spec(found.package) is None:
        message = f"needs the package {found.package}, which is not installed"
        raise SpecError(Problem(field="format", message=message, given=name, allowed="the extra `sideband[datasets]`"))
    return found
