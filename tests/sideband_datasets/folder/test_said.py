from __future__ import annotations

import hashlib
import json

import pytest

from sideband_datasets.folder.layout import json_text
from tests.sideband_datasets.folder.attack import manifest_of, told


def _changed(out, **changes) -> None:
    (out / "manifest.json").write_text(json_text({**manifest_of(out), **changes}))


def _write(out, name, text) -> None:
    """Another text in a file beside the shards, its checksum in step."""
    (out / name).write_text(text)
    files = {**manifest_of(out)["files"], name: hashlib.sha256(text.encode()).hexdigest()}
    _changed(out, files=files)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("rows", 999_999),
        ("classes", {"healthy": 1}),
        ("splits", {"train": {"machines": 1}}),
        ("machines", {}),
        ("failed_rows", 7),
        ("failed_recordings", 1),
        ("bytes", 1),
        ("warnings", ["x"]),
        ("columns", []),
        ("name", "other"),
        ("schema_version", 99),
        ("note", "of somebody"),
    ],
)
def test_a_changed_manifest_is_found_by_its_key(copy, key, value):
    _changed(copy, **{key: value})
    assert f"manifest.json: {key} is " in told(copy)


def test_other_versions_are_found_by_the_card(copy):
    _changed(copy, versions={"physics": "0", "code": "x"})
    assert "manifest.json: versions are not those that README.md says" in told(copy)


def test_columns_are_those_of_the_rows_whatever_version_made_them(copy):
    columns = manifest_of(copy)["columns"]
    _changed(copy, versions={**manifest_of(copy)["versions"], "code": "older"}, columns=columns[1:])
    assert "manifest.json: columns are not those of the rows" in told(copy)


def test_a_shard_named_for_another_split_is_found(copy):
    document = manifest_of(copy)
    entry = document["shards"][0]
    there = entry["file"].replace(f"data/{entry['split']}-", "data/other-")
    (copy / entry["file"]).rename(copy / there)
    entry["file"] = there
    _changed(copy, shards=document["shards"])
    assert f"{there}: is not named as a shard of {entry['split']}" in told(copy)


def test_the_size_of_a_shard_is_checked(copy):
    document = manifest_of(copy)
    document["shards"][2]["bytes"] += 1
    _changed(copy, shards=document["shards"])
    assert f"{document['shards'][2]['file']}: has {document['shards'][2]['bytes'] - 1} bytes; the manifest" in told(
        copy
    )


def test_a_card_that_says_something_else_is_found(copy):
    text = (copy / "README.md").read_text()
    _write(copy, "README.md", text.replace("12 recordings", "13 recordings"))
    assert told(copy) == "README.md: is not what rows and plan give"


def test_a_checksum_that_the_card_does_not_have_is_found(copy):
    text = (copy / "README.md").read_text()
    entry = manifest_of(copy)["shards"][0]
    _write(copy, "README.md", text.replace(entry["sha256"], "0" * 64))
    assert f"{entry['file']}: has another checksum in README.md" in told(copy)


def test_rows_that_are_there_are_no_failures(copy):
    failure = {
        "recording": 0,
        "recording_id": "tiny-000000",
        "rows": [0, 1, 2, 3],
        "machine_id": "rotor-9999",
        "fault_type": "healthy",
        "split": "train",
        "kind": "Diverged",
        "reason": "none",
    }
    _write(copy, "failures.jsonl", json.dumps(failure) + "\n")
    found = told(copy)
    assert "failures.jsonl: recording 0 is listed as failed, and is there" in found
    assert "failures.jsonl: recording 0 has machine_id 'rotor-9999', planned 'rotor-" in found
    assert "manifest.json: failed_rows is 0; rows and plan give 4" in found
    _write(copy, "failures.jsonl", json.dumps({**failure, "rows": [3, 4]}) + "\n")
    assert "failures.jsonl: recording 0 and its rows are not of this dataset" in told(copy)
    _write(copy, "failures.jsonl", "{")
    assert "failures.jsonl: cannot be read" in told(copy)
