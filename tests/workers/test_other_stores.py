"""The whole service on PostgreSQL and an object store: a result made, read, deleted; the bucket gone and back."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import httpx
import numpy as np
import pytest

import sideband_client
from jobs.datasets.words import SHARD
from jobs.status import Status
from sideband_datasets import read_recipe
from sideband_datasets.folder import Settings, make, verify
from sideband_datasets.folder.layout import files_below, sha256
from store.settings import StoreSettings
from tests.service import postgresql
from tests.service.buckets import bucket_server, raw_client
from tests.service.datasets import finished_shards
from tests.service.parts import LiveServer, Parts, eventually, open_parts
from tests.sideband_datasets.small import document

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(postgresql.missing()), reason=postgresql.missing() or "-")]

BUCKET = "service"
SHARDS = 8
"""Of two recordings each: enough for two workers to get in each other's way."""


@pytest.fixture
def parts(tmp_path: Path) -> Iterator[Parts]:
    opened = open_parts(tmp_path)
    yield opened
    opened.close()


def test_nothing_lies_in_the_data_folder(parts: Parts, monkeypatch: pytest.MonkeyPatch) -> None:
    with postgresql.cluster() as database, bucket_server(BUCKET) as endpoint:
        bucket = f"s3://{BUCKET}/jobs?endpoint={endpoint}"
        stores = StoreSettings(data_dir=parts.folder, redis_url=parts.url, database_url=database, artefact_url=bucket)
        monkeypatch.setenv("DATABASE_URL", database)
        monkeypatch.setenv("ARTEFACT_URL", bucket)
        parts.start_worker("w1")
        with LiveServer(parts.app(stores=stores)) as http, sideband_client.connect(str(http.base_url)) as client:
            job = client.simulate("oscillator", duration_s=0.5).wait(timeout_s=60)
            signals = job.result().signals()
            assert np.max(np.abs(signals["mass.y.displacement"] - np.sin(2 * np.pi * 40 * signals.t_s))) < 0.01
            part = http.get(f"/v1/jobs/{job.id}/result/files/signals.f64", headers={"Range": "bytes=8-15"})
            assert np.frombuffer(part.content)[0] == signals.values[0, 1]
            assert _names(endpoint) == {
                f"jobs/{job.id}/1/{name}"
                for name in ("manifest.json", "peaks.json", "signals.f64", "spectra.f64", "summary.json")
            }
            health = client.health()
            assert health["status"] == "ok" and health["disk"] == {"status": "ok", "free_bytes": None}
            job.delete()
            assert _names(endpoint) == set()
            assert not (parts.folder / "catalogue.sqlite").exists() and not (parts.folder / "artefacts").exists()
            _gone_bucket_is_told(http, endpoint)
        for worker in parts.workers:
            worker.terminate()
            worker.wait(20)


def test_a_dataset_of_two_workers_needs_no_shared_folder(
    parts: Parts, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    pytest.importorskip("zarr", reason="the extra `datasets` is not installed")
    kind = "npz"
    recipe = document(count=2 * SHARDS, peaks={"spectra": []})
    alone = tmp_path / "alone"
    make(read_recipe(recipe), alone, Settings(format=kind, shard_recordings=2), lambda progress: None)
    with postgresql.cluster() as database, bucket_server(BUCKET) as endpoint:
        bucket = f"s3://{BUCKET}/jobs?endpoint={endpoint}"
        stores = StoreSettings(data_dir=parts.folder, redis_url=parts.url, database_url=database, artefact_url=bucket)
        monkeypatch.setenv("DATABASE_URL", database)
        monkeypatch.setenv("ARTEFACT_URL", bucket)
        app = parts.app(stores=stores)
        with LiveServer(app) as http, sideband_client.connect(str(http.base_url)) as client:
            first, second = (replace(parts, folder=tmp_path / name).start_worker(name) for name in ("w1", "w2"))
            eventually(lambda: len(client.health()["workers"]) == 2)
            job = client.make_dataset(recipe, format=kind, shard_recordings=2)

            def holders(status: Status) -> list[str | None]:
                shards = app.state.sideband.stores.catalogue.parts.of(job.id, status)
                return [part.worker for part in shards if part.kind == SHARD]

            both = {"w1", "w2"}
            eventually(lambda: set(holders(Status.SUCCESSFUL)) == both == set(holders(Status.RUNNING)), within_s=120)
            assert first.poll() is None and second.poll() is None
            first.kill()
            first.wait()
            assert len(holders(Status.SUCCESSFUL)) < SHARDS, "the first worker leaves some to the second"
            job.wait(timeout_s=120)
            assert finished_shards(http, job.id) == SHARDS and set(holders(Status.SUCCESSFUL)) == both
            folder = job.dataset().download(tmp_path / "made")
            assert _checksums(folder) == _checksums(alone), "byte for byte what one process makes by itself"
            assert verify(folder) == [] and job.dataset().rows(5, 1)[0]["columns"]["fault_origin"] == "simulated"
            many = client.make_dataset({**recipe, "count": 3, "splits": {"train": 1.0}}, format="zarr").wait(
                timeout_s=120
            )
            assert verify(many.dataset().download(tmp_path / "many")) == [], "a shard of more than a hundred files"
            assert _names(endpoint)
            job.delete()
            many.delete()
            assert _names(endpoint) == set(), "the shards go with the dataset"
        for worker in parts.workers:
            worker.terminate()
            worker.wait(20)


def _checksums(folder: Path) -> dict[str, str]:
    return {path.relative_to(folder).as_posix(): sha256(path) for path in files_below(folder)}


def _gone_bucket_is_told(http: httpx.Client, endpoint: str) -> None:
    raw = raw_client(endpoint)
    raw.delete_object(Bucket=BUCKET, Key="jobs/health/probe")
    raw.delete_bucket(Bucket=BUCKET)
    ready = http.get("/readyz")
    assert ready.status_code == 503 and ready.json()["away"] == ["artefacts"]
    asked = http.post("/v1/simulations", json={"preset": "oscillator", "seed": 77})
    assert asked.status_code == 503 and asked.json()["type"].endswith("store-away")
    raw.create_bucket(Bucket=BUCKET)
    assert http.get("/readyz").status_code == 200


def _names(endpoint: str) -> set[str]:
    listed = raw_client(endpoint).list_objects_v2(Bucket=BUCKET).get("Contents", [])
    return {entry["Key"] for entry in listed} - {"jobs/health/probe"}
