"""Datasets with real workers on a real broker: killed, cancelled, taken up again; the bytes are always the same."""

from __future__ import annotations

import tarfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from sideband_datasets.folder import verify
from tests.service.datasets import (
    ADDRESS,
    SHARDS,
    attempts,
    dataset,
    download,
    finished_shards,
    made_alone,
    submit,
    until,
)
from tests.service.parts import LiveServer, Parts, eventually, open_parts
from tests.sideband_datasets.small import document


@pytest.fixture
def parts(tmp_path: Path) -> Iterator[Parts]:
    opened = open_parts(tmp_path / "service")
    yield opened
    opened.close()


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    return made_alone(tmp_path_factory.mktemp("made") / "tiny")


@pytest.mark.slow
def test_killed_worker_changes_no_byte(parts: Parts, undisturbed: dict[str, bytes], tmp_path: Path) -> None:
    first = parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        dataset_id = submit(client)
        eventually(lambda: dataset(client, dataset_id)["shards"]["running"] == 1, within_s=60)
        assert client.get(f"{ADDRESS}/{dataset_id}/files").status_code == 409, "nobody reads half a dataset"
        eventually(lambda: finished_shards(client, dataset_id) >= 1, within_s=60)
        eventually(lambda: dataset(client, dataset_id)["shards"]["running"] == 1, within_s=60)
        first.kill()
        first.wait()
        parts.start_worker("w2")
        done = until(client, dataset_id, "successful")
        assert download(client, dataset_id, tmp_path / "tiny") == undisturbed
        assert verify(tmp_path / "tiny") == []
        assert done["shards"] == {"total": SHARDS, "waiting": 0, "running": 0, "successful": SHARDS, "failed": 0}
        assert attempts(client) == [1] * (SHARDS - 1) + [2], "only its own shard again"


@pytest.mark.slow
def test_cancelled_dataset_stops_and_is_taken_up_where_it_stopped(
    parts: Parts, undisturbed: dict[str, bytes], tmp_path: Path
) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        dataset_id = submit(client)
        eventually(lambda: finished_shards(client, dataset_id) >= 1, within_s=60)
        assert client.post(f"/v1/jobs/{dataset_id}/cancel").status_code == 202
        until(client, dataset_id, "dismissed", within_s=10)
        left = finished_shards(client, dataset_id)
        time.sleep(1.0)
        assert 1 <= left == finished_shards(client, dataset_id) < SHARDS, "nothing goes on"
        before = {p["id"]: p for p in client.get("/v1/jobs", params={"kind": "dataset-shard"}).json()["jobs"]}
        assert submit(client) == dataset_id
        until(client, dataset_id, "successful")
        after = {p["id"]: p for p in client.get("/v1/jobs", params={"kind": "dataset-shard"}).json()["jobs"]}
        for part_id, part in before.items():
            again = 0 if part["status"] == "successful" else 1
            assert after[part_id]["attempt"] == part["attempt"] + again
        assert download(client, dataset_id, tmp_path / "tiny") == undisturbed


@pytest.mark.slow
def test_rows_archive_and_deletion(parts: Parts, tmp_path: Path) -> None:
    parts.start_worker("w1")
    with LiveServer(parts.app()) as client:
        dataset_id = submit(client, recipe=document(count=4), format="parquet", shard_recordings=None)
        events = client.get(f"/v1/jobs/{dataset_id}/events").text
        assert "making shards" in events and '"status":"successful"' in events
        done = dataset(client, dataset_id)
        assert sum(sum(split.values()) for split in done["balance"].values()) == done["manifest"]["rows"] == 16
        page = client.get(f"{ADDRESS}/{dataset_id}/rows", params={"offset": 7, "limit": 2, "spectrum": True}).json()
        assert page["total"] == 16 and len(page["rows"]) == 2
        assert page["rows"][0]["signal"] is None and page["rows"][0]["spectrum"]["unit"] == "m/s^2"
        assert page["rows"][0]["columns"]["split"] in ("train", "test") and "signal" not in page["rows"][0]["columns"]
        result = client.get(f"/v1/jobs/{dataset_id}/result").json()
        assert result["links"] == {} and result["rows"] == 16 and "README.md" in result["files"]
        part = client.get(f"{ADDRESS}/{dataset_id}/files/README.md", headers={"Range": "bytes=0-2"})
        assert (part.status_code, part.content) == (206, b"---")
        same = {"If-None-Match": part.headers["ETag"]}
        assert client.get(f"{ADDRESS}/{dataset_id}/files/README.md", headers=same).status_code == 304
        unknown = client.get(f"{ADDRESS}/{dataset_id}/files/data/none.parquet")
        assert unknown.status_code == 404 and "manifest.json" in unknown.json()["errors"][0]["allowed"]
        reply = client.get(f"{ADDRESS}/{dataset_id}/archive.tar")
        (tmp_path / "a.tar").write_bytes(reply.content)
        unpacked(tmp_path / "a.tar", tmp_path)
        assert verify(tmp_path / "tiny") == []
        part = client.get("/v1/jobs", params={"kind": "dataset-shard"}).json()["jobs"][0]["id"]
        assert client.delete(f"/v1/jobs/{part}").status_code == 409, "a part is not deleted alone"
        assert client.delete(f"/v1/jobs/{dataset_id}").status_code == 204
        assert client.get(f"{ADDRESS}/{dataset_id}/files").status_code == 410
        assert not list((parts.folder / "artefacts").rglob("*.parquet"))


def unpacked(archive: Path, folder: Path) -> None:
    with tarfile.open(archive) as file:
        # Debian's Python 3.11.2 has no filters yet, and Python 3.14 warns without one
        file.extractall(folder, **({"filter": "data"} if hasattr(tarfile, "data_filter") else {}))
