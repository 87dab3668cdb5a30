"""A folder as `dataset make` leaves it, without the rows; a server of buckets."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from sideband_datasets.folder.layout import sha256
from sideband_datasets.recipe.read import checksum
from tests.service.buckets import bucket_server
from tests.sideband_datasets.small import document

PART = 5 * 2**20
"""The smallest part that a store takes."""
LARGE = b"".join(hashlib.sha256(bytes([k])).digest() for k in range(256)) * (2 * PART // 8192) + b"end"
PAGES = {"README.md": b"a card", "croissant.json": b"{}", "failures.jsonl": b""}


@pytest.fixture(scope="session")
def endpoint() -> Iterator[str]:
    with bucket_server("datasets") as opened:
        yield opened


def folder_of(out: Path, shards: dict[str, bytes], kind: str = "npz", **changes: object) -> Path:
    """Files with these contents and their manifest; what a name with two `/` is in is a shard that is a folder."""
    for name, content in {**shards, **PAGES}.items():
        path = out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    entries = sorted({"/".join(name.split("/")[:2]) for name in shards})
    recipe = document(**changes)
    manifest = {
        "recipe": recipe,
        "recipe_sha256": checksum(recipe),
        "format": kind,
        "versions": {},
        "shards": [{"file": f, "split": "train", "rows": 1, "bytes": 1, "sha256": sha256(out / f)} for f in entries],
        "files": {name: sha256(out / name) for name in PAGES},
    }
    (out / "manifest.json").write_text(json.dumps(manifest))
    return out


@pytest.fixture
def made(tmp_path: Path) -> Path:
    return folder_of(
        tmp_path / "rig", {"data/train-00000-of-00002.npz": LARGE, "data/train-00001-of-00002.npz": b"few"}
    )
