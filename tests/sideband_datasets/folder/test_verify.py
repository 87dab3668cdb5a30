from __future__ import annotations

import json

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from sideband_datasets.folder import verify
from sim.core.errors import SpecError
from tests.sideband_datasets.folder.attack import changed, rewrite, shards, told

pytestmark = pytest.mark.xdist_group("dataset-folder")


def _shard(out, split="train"):
    return shards(out, split)[1]


@pytest.mark.slow
def test_nothing_is_wrong_with_what_was_made(made):
    assert verify(made, remake=3) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", ["data", "README.md", "croissant.json", "failures.jsonl"])
def test_a_flipped_bit_is_found_anywhere(copy, name):
    path = _shard(copy) if name == "data" else copy / name
    content = bytearray(path.read_bytes() or b" ")
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    assert f"{path.relative_to(copy)}: differs" in told(copy)


def test_a_missing_and_a_surplus_shard_are_found(copy):
    path = _shard(copy)
    path.rename(path.with_name("train-00007-of-00003.parquet"))
    assert f"{path.name}: is missing" in told(copy)
    assert "train-00007-of-00003.parquet: is surplus" in told(copy)


@pytest.mark.parametrize("what", ["machine_id", "path_id"])
def test_a_leak_is_found_though_all_checksums_fit(copy, what):
    path = _shard(copy)
    other = pq.read_table(_shard(copy, "test")).column(what)[0].as_py()
    table = pq.read_table(path)
    rewrite(copy, path, changed(table, what, [other] * table.num_rows))
    assert f"leak: {what} {other} occurs in test and in train" in told(copy)


@pytest.mark.slow
def test_rows_of_another_split_twice_or_missing_are_found(copy):
    path = _shard(copy)
    table = pq.read_table(path)
    rewrite(copy, path, pa.concat_tables([table.slice(0, 1), table.slice(0, table.num_rows - 1)]))
    assert "occurs twice" in told(copy)
    assert "1 rows are missing and not listed as failed" in told(copy)
    rewrite(copy, path, changed(table, "split", ["test"] * table.num_rows))
    assert "is of split test in a file of train" in told(copy)


@pytest.mark.slow
def test_a_row_that_the_recipe_does_not_make_is_found(copy):
    path = _shard(copy)
    table = pq.read_table(path)
    signals = table.column("signal").to_pylist()
    signals[0][5] *= 1.0000002
    rewrite(copy, path, changed(table, "signal", signals))
    assert told(copy) == ""
    assert "differs from the row made again" in told(copy, remake=48)


def test_a_changed_recipe_is_found(copy):
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest["recipe"]["seed"] = 9
    (copy / "manifest.json").write_text(json.dumps(manifest))
    assert "the recipe is not the one that was made" in told(copy)


@pytest.mark.parametrize("key", ["recipe", "format", "shards", "files", "versions"])
@pytest.mark.parametrize("value", [None, "", {"a": 1}])
def test_a_broken_manifest_is_a_finding_and_no_traceback(copy, key, value):
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest[key] = value
    (copy / "manifest.json").write_text(json.dumps(manifest))
    assert told(copy)


@pytest.mark.parametrize("changes", [{"preset": "none"}, {"vary": {"speed_hz": {"low": 25, "high": 40}}}])
def test_a_recipe_that_is_refused_is_a_finding(copy, changes):
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest["recipe"]["machines"][0] |= changes
    (copy / "manifest.json").write_text(json.dumps(manifest))
    assert told(copy).startswith("manifest.json: its recipe is refused: ")


def test_a_manifest_that_is_no_json_is_a_finding(copy):
    (copy / "manifest.json").write_text("{")
    assert "manifest.json: cannot be read" in told(copy)


def test_an_emptied_manifest_is_told_by_what_it_lacks(copy):
    (copy / "manifest.json").write_text("{}")
    assert told(copy) == "manifest.json: lacks 'recipe': it was emptied or cut"


def test_an_unknown_format_is_told_with_those_there_are(copy):
    manifest = json.loads((copy / "manifest.json").read_text())
    (copy / "manifest.json").write_text(json.dumps({**manifest, "format": "csvx"}))
    assert "manifest.json: cannot be read: its format is 'csvx', not one of parquet" in told(copy)


def test_a_folder_without_a_dataset_is_refused(tmp_path):
    with pytest.raises(SpecError, match=r"manifest\.json"):
        verify(tmp_path)
