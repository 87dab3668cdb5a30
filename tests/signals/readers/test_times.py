"""Columns that are a time though nobody mentions them: by heading, by unit, and how many are looked at."""

from __future__ import annotations

import io
import zipfile

import numpy as np
import pytest
import scipy.io.wavfile

from signals.readers.limits import Bounds
from signals.readers.load import MOST_TIMES, Want, load
from signals.readers.times import named_time

N = 400
WANTED = [Want(field="channels.0.column", column="a")]


@pytest.mark.parametrize(
    ("heading", "unit"),
    [
        ("time", ""),
        ("Time", ""),
        ("TIME", ""),
        ("t", ""),
        ("t_s", "s"),
        ("t [ms]", "ms"),
        ("time_s", "s"),
        ("Time (s)", "s"),
        ("Time[s]", "s"),
        ("time / ms", "ms"),
        ("Time/s", "s"),
        ("Time, us", "us"),
        ("time µs", "us"),
        ("Timestamp", ""),
        ("Time Stamp (ns)", "ns"),
        ("time-stamps", ""),
        ("timestamp_s", "s"),
        ("Time (hh:mm:ss)", ""),
        ("Seconds", "s"),
        ("msec", "ms"),
        ("Elapsed time (sec)", "s"),
        ("X_Value", ""),
        ("Zeit [s]", "s"),
        ("group/time", ""),
        ("Untitled/Time (ms)", "ms"),
    ],
)
def test_headings_that_are_a_time(heading: str, unit: str) -> None:
    found = named_time(heading)
    assert found is not None and found.unit == unit


@pytest.mark.parametrize(
    "heading", ["T", "T (degC)", "t [degC]", "s", "ms", "acc_s", "rise_time", "a [s]", "x", "", "/", "()", "times_two"]
)
def test_headings_that_are_none(heading: str) -> None:
    assert named_time(heading) is None


def test_a_tables_first_column_is_looked_at_whatever_its_name(tmp_path) -> None:
    rows = "\n".join(f"{0.1 * i:.3f},{i % 7}.5,{i}" for i in range(N))
    (tmp_path / "r.csv").write_text(f"moment,a,b\n{rows}\n")
    assert set(load(tmp_path / "r.csv", WANTED, True, Bounds()).times) == {"moment"}
    assert not load(tmp_path / "r.csv", WANTED, False, Bounds()).times
    np.savez(tmp_path / "r.npz", moment=np.arange(N), a=np.arange(N))
    assert not load(tmp_path / "r.npz", WANTED, True, Bounds()).times
    scipy.io.wavfile.write(tmp_path / "r.wav", 1000, np.column_stack((np.arange(N), np.arange(N))).astype(np.int16))
    assert not load(tmp_path / "r.wav", [Want(field="channels.0.column", column=1)], True, Bounds()).times


def test_unmentioned_columns_keep_within_the_bound_of_samples(tmp_path) -> None:
    """Their size is known before they are unpacked."""
    with zipfile.ZipFile(tmp_path / "r.npz", "w", zipfile.ZIP_DEFLATED) as archive:
        for name, array in (("a", np.zeros(N)), ("t", np.zeros(1_000_000, dtype=np.int8)), ("time_s", np.zeros(N))):
            stream = io.BytesIO()
            np.save(stream, array)
            archive.writestr(f"{name}.npy", stream.getvalue())
    found = load(tmp_path / "r.npz", WANTED, True, Bounds(values=2 * N))
    assert set(found.times) == {"time_s"}
    (said,) = found.remarks
    assert said.startswith("t: not looked at") and "1000000" in said
    assert set(load(tmp_path / "r.npz", WANTED, True, Bounds()).times) == {"t", "time_s"}


def test_only_so_many_are_looked_at(tmp_path) -> None:
    many = {f"g{i}/time": np.arange(N) for i in range(3 * MOST_TIMES)}
    np.savez(tmp_path / "r.npz", a=np.arange(N), **{name.replace("/", "_x/"): x for name, x in many.items()})
    assert len(load(tmp_path / "r.npz", WANTED, True, Bounds()).times) == MOST_TIMES
