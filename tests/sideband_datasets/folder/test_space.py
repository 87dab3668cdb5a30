"""Room on the disk is asked for before a dataset is begun."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import NamedTuple

import pytest

from sideband_datasets.folder import Settings, make, unfinished
from sideband_datasets.folder.space import check_space, free_bytes
from sim.core.errors import SpecError
from tests.sideband_datasets.small import tiny


class Usage(NamedTuple):
    total: int
    used: int
    free: int


def test_free_bytes_are_those_of_the_nearest_folder_that_is_there(tmp_path: Path) -> None:
    assert free_bytes(tmp_path / "a" / "b") == pytest.approx(shutil.disk_usage(tmp_path).free, rel=0.05)


def test_too_little_space_is_told_in_numbers_and_nothing_is_begun(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(shutil, "disk_usage", lambda path: Usage(10**9, 10**9 - 1000, 1000))
    check_space(1000, tmp_path / "set")
    with pytest.raises(SpecError, match="estimated at 1001 bytes, 1000 are free"):
        check_space(1001, tmp_path / "set")
    with pytest.raises(SpecError, match="1000 are free") as told:
        make(tiny(peaks={"spectra": []}), tmp_path / "set", Settings(), lambda progress: None)
    assert told.value.problems[0].field == "--out"
    assert not unfinished(tmp_path / "set").exists()
