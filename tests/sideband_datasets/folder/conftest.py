from __future__ import annotations

import shutil

import pytest

from sideband_datasets.folder import Settings, make
from tests.sideband_datasets.small import tiny

RECIPE = tiny(peaks={"spectra": ["envelope"]}, sampling_rate_hz=10_000)


@pytest.fixture(scope="session")
def made(tmp_path_factory):
    """A finished dataset of 48 rows in six shards; not to be changed."""
    out = tmp_path_factory.mktemp("made") / "set"
    make(RECIPE, out, Settings(shard_recordings=2), lambda progress: None)
    return out


@pytest.fixture
def copy(made, tmp_path):
    """A copy of the finished dataset, to be changed."""
    return shutil.copytree(made, tmp_path / "set")
