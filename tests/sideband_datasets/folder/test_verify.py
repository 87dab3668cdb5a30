from __future__ import annotations

import hashlib
import json
import shutil

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from sideband_datasets.folder import verify
from sim.core.errors import SpecError


@pytest.fixture
def copy(made, tmp_path):
    return shutil.copytree(made, tmp_path / "set")


def _told(out, **settings) -> str:
    return "\n".join(map(str, verify(out, **settings)))


def _shard(out, split="train"):
    return sorted((out / "data").glob(f"{split}-*"))[1]


def _rewrite(out, path, table) -> None:
    """A shard changed by someone who keeps the manifest in step."""
    pq.write_table(table, path)
    manifest = json.loads((out / "manifest.json").read_text())
    entry = next(e for e in manifest["shards"] if e["file"] == f"data/{path.name}")
    entry["sha256"], entry["rows"] = hashlib.sha256(path.read_bytes()).hexdigest(), table.num_rows
    (out / "manifest.json").write_text(json.dumps(manifest))


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
    assert f"{path.relative_to(copy)}: differs" in _told(copy)


def test_a_missing_and_a_surplus_shard_are_found(copy):
    path = _shard(copy)
    path.rename(path.with_name("train-00007-of-00003.parquet"))
    assert f"{path.name}: is missing" in _told(copy)
    assert "train-00007-of-00003.parquet: is surplus" in _told(copy)


def _changed(table, column, values):
    at = table.column_names.index(column)
    return table.set_column(at, table.schema.field(column), pa.array(values, table.schema.field(column).type))


@pytest.mark.parametrize("what", ["machine_id", "path_id"])
def test_a_leak_is_found_though_all_checksums_fit(copy, what):
    path = _shard(copy)
    other = pq.read_table(_shard(copy, "test")).column(what)[0].as_py()
    table = pq.read_table(path)
    _rewrite(copy, path, _changed(table, what, [other] * table.num_rows))
    assert f"leak: {what} {other} occurs in test and in train" in _told(copy)


@pytest.mark.slow
def test_rows_of_another_split_twice_or_missing_are_found(copy):
    path = _shard(copy)
    table = pq.read_table(path)
    _rewrite(copy, path, pa.concat_tables([table.slice(0, 1), table.slice(0, table.num_rows - 1)]))
    assert "occurs twice" in _told(copy)
    assert "1 rows are missing and not listed as failed" in _told(copy)
    _rewrite(copy, path, _changed(table, "split", ["test"] * table.num_rows))
    assert "is of split test in a file of train" in _told(copy)


@pytest.mark.slow
def test_a_row_that_the_recipe_does_not_make_is_found(copy):
    path = _shard(copy)
    table = pq.read_table(path)
    signals = table.column("signal").to_pylist()
    signals[0][5] *= 1.0000002
    _rewrite(copy, path, _changed(table, "signal", signals))
    assert _told(copy) == ""
    assert "differs from the row made again" in _told(copy, remake=48)


def test_a_changed_recipe_is_found(copy):
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest["recipe"]["seed"] = 9
    (copy / "manifest.json").write_text(json.dumps(manifest))
    assert "the recipe is not the one that was made" in _told(copy)


@pytest.mark.parametrize("key", ["recipe", "format", "shards", "files", "versions"])
@pytest.mark.parametrize("value", [None, "", {"a": 1}])
def test_a_broken_manifest_is_a_finding_and_no_traceback(copy, key, value):
    manifest = json.loads((copy / "manifest.json").read_text())
    manifest[key] = value
    (copy / "manifest.json").write_text(json.dumps(manifest))
    told = _told(copy)
    assert told or (key, value) in [("versions", ""), ("versions", {"a": 1})]


def test_a_manifest_that_is_no_json_is_a_finding(copy):
    (copy / "manifest.json").write_text("{")
    assert "manifest.json: cannot be read" in _told(copy)


def test_a_folder_without_a_dataset_is_refused(tmp_path):
    with pytest.raises(SpecError, match=r"manifest\.json"):
        verify(tmp_path)
