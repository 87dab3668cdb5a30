"""A small dataset asked of a service, and what the command line makes of the same recipe."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

import httpx

from sideband_datasets import read_recipe
from sideband_datasets.folder import Settings, make
from sideband_datasets.folder.layout import files_below
from tests.service.parts import eventually
from tests.sideband_datasets.small import document

ADDRESS = "/v1/datasets"
REQUEST = {"recipe": document(count=8, peaks={"spectra": []}), "format": "npz", "shard_recordings": 2}
SHARDS = 4


def submit(client: httpx.Client, **changes: object) -> str:
    reply = client.post(ADDRESS, json={**REQUEST, **changes})
    assert reply.status_code == 202, reply.text
    assert reply.headers["Location"] == f"{ADDRESS}/{reply.json()['id']}"
    return str(reply.json()["id"])


def dataset(client: httpx.Client, dataset_id: str) -> dict[str, Any]:
    found: dict[str, Any] = client.get(f"{ADDRESS}/{dataset_id}").json()
    return found


def until(client: httpx.Client, dataset_id: str, word: str, within_s: float = 120) -> dict[str, Any]:
    ended = ("successful", "failed", "dismissed")
    eventually(lambda: dataset(client, dataset_id)["status"] in (word, *ended), within_s=within_s)
    found = dataset(client, dataset_id)
    assert found["status"] == word, found["job"]["failure"]
    return found


def download(client: httpx.Client, dataset_id: str, out: Path) -> dict[str, bytes]:
    found = {}
    for entry in client.get(f"{ADDRESS}/{dataset_id}/files").json()["files"]:
        content = client.get(entry["href"]).content
        assert hashlib.sha256(content).hexdigest() == entry["sha256"] and len(content) == entry["bytes"]
        (out / entry["path"]).parent.mkdir(parents=True, exist_ok=True)
        (out / entry["path"]).write_bytes(content)
        found[entry["path"]] = content
    return found


def made_alone(out: Path) -> dict[str, bytes]:
    """What the command line makes of the same recipe, in one process."""
    make(read_recipe(REQUEST["recipe"]), out, Settings(format="npz", shard_recordings=2), lambda progress: None)
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in files_below(out)}


def finished_shards(client: httpx.Client, dataset_id: str) -> int:
    return int(dataset(client, dataset_id)["shards"]["successful"])


def attempts(client: httpx.Client) -> list[int]:
    """How often each shard was begun."""
    made = client.get("/v1/jobs", params={"kind": "dataset-shard"}).json()["jobs"]
    return sorted(part["attempt"] for part in made)
