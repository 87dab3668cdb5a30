"""A shard is written as its rows come: what is held does not grow with its recordings."""

from __future__ import annotations

import tracemalloc
from pathlib import Path

import pytest

from sideband_datasets.folder.layout import DATA, STATE
from sideband_datasets.folder.shards import Shard, finished, make_shard, receipt_path, shards_of
from sideband_datasets.formats import FORMATS
from sideband_datasets.plan import make_plan, size
from tests.sideband_datasets.small import tiny

WINDOWS = {"per_recording": 12, "length_s": 0.25, "overlap": 0.95}
RECIPE = tiny(count=24, duration_s=0.4, windows=WINDOWS, peaks={"spectra": []}, splits={"train": 1.0})
ROW_BYTES = 4 * 2000


def peak_bytes(folder: Path, kind: str, recordings: int) -> int:
    """The most that was held while a shard was made, as Python and NumPy count it."""
    for name in (DATA, STATE):
        (folder / name).mkdir(parents=True)
    plan = make_plan(RECIPE)
    shard = Shard(split="train", name=f"shard{FORMATS[kind].suffix}", recordings=tuple(range(recordings)))
    tracemalloc.start()
    try:
        receipt = make_shard(plan, shard, folder, kind)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert receipt.rows == recordings * plan.rows_per_recording
    return peak


@pytest.mark.slow
@pytest.mark.parametrize("damage", ["", "{}", "[]", "{"])
def test_a_shard_whose_receipt_is_damaged_is_made_again(damage: str, tmp_path: Path) -> None:
    for name in (DATA, STATE):
        (tmp_path / name).mkdir()
    plan = make_plan(tiny(count=2, peaks={"spectra": []}, splits={"train": 1.0}))
    (shard,) = shards_of(plan, FORMATS["parquet"].suffix)
    receipt = make_shard(plan, shard, tmp_path, "parquet")
    assert finished(tmp_path, shard, receipt.recipe) == receipt
    receipt_path(tmp_path, shard).write_text(damage)
    assert finished(tmp_path, shard, receipt.recipe) is None


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["parquet", "webdataset"])
def test_memory_does_not_grow_with_the_recordings_of_a_shard(
    kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(size, "BATCH_BYTES", 0)
    assert size.batch_size(make_plan(RECIPE)) == 8
    peak_bytes(tmp_path / "first", kind, 2)
    few, many = peak_bytes(tmp_path / "few", kind, 16), peak_bytes(tmp_path / "many", kind, 24)
    further_rows = (24 - 16) * make_plan(RECIPE).rows_per_recording
    assert many - few < 0.1 * further_rows * ROW_BYTES, (few, many)
