"""A stranger's file is read apart: what breaks, hangs or grows there is a refusal here."""

from __future__ import annotations

import io
import os
import time
from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from signals.ingest import Bounds, parse, read_description
from signals.readers.guard import load_apart, load_carefully
from signals.readers.load import Want, load
from sim.core.errors import SpecError

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
    here, apart = (door(tmp_path / "r.npz", wanted, ["time_s"], Bounds()) for door in (load, load_apart))
    np.testing.assert_array_equal(here.wanted[0].samples, apart.wanted[0].samples)
    np.testing.assert_array_equal(here.optional["time_s"].samples, apart.optional["time_s"].samples)
    assert here.rate_hz == apart.rate_hz == 50.0


@pytest.mark.slow
def test_refusals_come_through_word_by_word(tmp_path) -> None:
    np.savez(tmp_path / "r.npz", b=X)
    told = []
    for door in (load, load_apart):
        with pytest.raises(SpecError) as caught:
            door(tmp_path / "r.npz", [Want(field="channels.0.column", column="a")], [], Bounds())
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
