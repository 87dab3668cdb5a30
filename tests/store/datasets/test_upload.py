"""A dataset in a bucket: whole or not there, never mixed, and taken up again where it broke off."""

from __future__ import annotations

import json
import tracemalloc
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from botocore.exceptions import ClientError

from sim.core.errors import SpecError
from store.datasets import bucket
from store.datasets.place import dataset_place
from store.datasets.upload import Progress, Uploaded, upload
from tests.service.buckets import raw_client
from tests.store.datasets.conftest import LARGE, PART, folder_of

pytestmark = pytest.mark.slow
FIRST, SECOND = "data/train-00000-of-00002.npz", "data/train-00001-of-00002.npz"


@pytest.fixture
def at(endpoint: str, request: pytest.FixtureRequest) -> Iterator[str]:
    """A URL whose prefix holds nothing, and nothing afterwards."""
    raw = raw_client(endpoint)
    yield f"s3://datasets/deep/rig?endpoint={endpoint}"
    for name in _there(endpoint, ""):
        raw.delete_object(Bucket="datasets", Key=name)
    assert raw.list_multipart_uploads(Bucket="datasets").get("Uploads", []) == []


def _there(endpoint: str, prefix: str = "deep/rig/") -> dict[str, bytes]:
    raw = raw_client(endpoint)
    names = [e["Key"] for e in raw.list_objects_v2(Bucket="datasets", Prefix=prefix).get("Contents", ())]
    return {n.removeprefix(prefix): raw.get_object(Bucket="datasets", Key=n)["Body"].read() for n in names}


def _put(endpoint: str, name: str, content: bytes) -> None:
    raw_client(endpoint).put_object(Bucket="datasets", Key=f"deep/rig/{name}", Body=content)


def _files(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def _send(folder: Path, url: str, told: Callable[[Progress], object] = str) -> Uploaded:
    return upload(folder, dataset_place(url), url, told, part_bytes=PART)


def _refused(folder: Path, url: str) -> str:
    with pytest.raises(SpecError) as caught:
        _send(folder, url)
    assert len(caught.value.problems) == 1 and caught.value.problems[0].allowed
    return str(caught.value)


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, dict[str, Any]]]:
    """Requests by name and what they carry, as they are made."""
    found: list[tuple[str, dict[str, Any]]] = []
    connected = bucket.connected

    def noted(*arguments: Any) -> Any:
        client = connected(*arguments)
        client.meta.events.register(
            "provide-client-params.s3", lambda params, model, **_: found.append((model.name, params))
        )
        return client

    monkeypatch.setattr(bucket, "connected", noted)
    return found


def _fails(monkeypatch: pytest.MonkeyPatch, when: Callable[[str, dict[str, Any]], BaseException | None]) -> None:
    """Requests that do not come about: `when` knows them by name and parameters."""
    connected = bucket.connected

    def failing(*arguments: Any) -> Any:
        client = connected(*arguments)

        def refuse(params: dict[str, Any], model: Any, **_: object) -> None:
            error = when(model.name, params)
            if error is not None:
                raise error

        client.meta.events.register("provide-client-params.s3", refuse)
        return client

    monkeypatch.setattr(bucket, "connected", failing)


def test_every_byte_is_there_with_its_checksum_and_the_manifest_came_last(
    made: Path, at: str, endpoint: str, asked: list[tuple[str, dict[str, Any]]]
) -> None:
    said: list[Progress] = []
    found = _send(made, at, said.append)
    assert _there(endpoint) == _files(made)
    assert (found.files, found.sent, found.bytes) == (6, 6, sum(map(len, _files(made).values())))
    puts = [(name, carried) for name, carried in asked if name in ("PutObject", "CompleteMultipartUpload")]
    assert [name for name, _ in asked].count("UploadPart") == 3
    assert puts[-1][1]["Key"] == "deep/rig/manifest.json"
    assert all(carried["IfNoneMatch"] == "*" for _, carried in puts), "nothing that is there is replaced"
    assert all("ChecksumSHA256" in carried for name, carried in asked if name in ("PutObject", "UploadPart"))
    done = [progress.done for progress in said if progress.total]
    assert done == sorted(done) and done[-1] == found.bytes and len(set(done)) > 5


def test_memory_does_not_grow_with_the_file(tmp_path: Path, at: str, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = folder_of(tmp_path / "rig", {FIRST: LARGE * 4})
    held: list[int] = []
    # What the server in this process holds is no matter here: the parts do not reach it.
    monkeypatch.setattr("store.artefacts.s3_parts._sent", lambda *_: held.append(tracemalloc.get_traced_memory()[1]))
    tracemalloc.start()
    try:
        with pytest.raises(SpecError):
            _send(folder, at)
    finally:
        tracemalloc.stop()
    # the first are sent while others are still read, as many as are in flight together
    assert len(held) > 8 and held[-1] - held[4] < PART


@pytest.mark.parametrize("ends", [KeyboardInterrupt(), ClientError({"Error": {"Code": "SlowDown"}}, "UploadPart")])
def test_interrupted_midway_no_dataset_is_there_and_the_next_run_sends_the_rest(
    made: Path, at: str, endpoint: str, monkeypatch: pytest.MonkeyPatch, ends: BaseException
) -> None:
    with monkeypatch.context() as patch:
        _fails(patch, lambda name, carried: ends if carried.get("PartNumber") == 2 else None)
        with pytest.raises((KeyboardInterrupt, SpecError)):
            _send(made, at)
    left = _there(endpoint)
    assert SECOND in left and FIRST not in left and "manifest.json" not in left
    assert raw_client(endpoint).list_multipart_uploads(Bucket="datasets").get("Uploads", []) == []
    said: list[Progress] = []
    assert _send(made, at, said.append).sent == 2, "the rest and the manifest"
    assert said[-1].kept == sum(map(len, left.values()))
    assert _there(endpoint) == _files(made)


def test_what_a_killed_command_left_of_an_upload_is_taken_back(made: Path, at: str, endpoint: str) -> None:
    raw = raw_client(endpoint)
    raw.create_multipart_upload(Bucket="datasets", Key=f"deep/rig/{FIRST}")
    other = raw.create_multipart_upload(Bucket="datasets", Key=f"deep/rig/{FIRST}.other")
    _send(made, at)
    assert [u["Key"] for u in raw.list_multipart_uploads(Bucket="datasets")["Uploads"]] == [f"deep/rig/{FIRST}.other"]
    raw.abort_multipart_upload(Bucket="datasets", Key=f"deep/rig/{FIRST}.other", UploadId=other["UploadId"])


def test_the_same_dataset_again_is_nothing_to_do(
    made: Path, at: str, endpoint: str, asked: list[tuple[str, dict[str, Any]]]
) -> None:
    _send(made, at)
    asked.clear()
    assert _send(made, at).sent == 0
    assert {name for name, _ in asked} == {"ListObjectsV2", "HeadObject"}
    raw_client(endpoint).delete_object(Bucket="datasets", Key=f"deep/rig/{SECOND}")
    assert f"URL: has lost {SECOND}, which" in _refused(made, at)


def test_another_dataset_is_left_alone(made: Path, tmp_path: Path, at: str, endpoint: str) -> None:
    _send(made, at)
    before = _there(endpoint)
    other = folder_of(tmp_path / "other", {"data/aa.npz": b"x"}, seed=4)
    told = _refused(other, at)
    assert "URL: holds another dataset: its manifest.json has another checksum" in told
    assert _there(endpoint) == before


@pytest.mark.parametrize(
    ("name", "content", "says"),
    [
        ("data/train-00002-of-00003.npz", b"x", "no part of this dataset"),
        (SECOND, b"wef", "holds another data/"),
    ],
)
def test_files_of_others_are_left_alone(
    made: Path, at: str, endpoint: str, name: str, content: bytes, says: str
) -> None:
    _put(endpoint, name, content)
    assert says in _refused(made, at)
    assert _there(endpoint) == {name: content}


def test_what_other_tools_put_there_counts_when_its_bytes_are_right_and_folder_marks_do_not(
    made: Path, at: str, endpoint: str
) -> None:
    raw = raw_client(endpoint)
    _put(endpoint, "", b"")
    begun = raw.create_multipart_upload(Bucket="datasets", Key=f"deep/rig/{FIRST}")
    target = {"Bucket": "datasets", "Key": f"deep/rig/{FIRST}", "UploadId": begun["UploadId"]}
    part = raw.upload_part(**target, PartNumber=1, Body=LARGE)
    raw.complete_multipart_upload(**target, MultipartUpload={"Parts": [{"PartNumber": 1, "ETag": part["ETag"]}]})
    assert _send(made, at).sent == 5
    assert _there(endpoint) == {"": b"", **_files(made)}


def test_the_quicker_one_of_two_wins(
    made: Path, tmp_path: Path, at: str, endpoint: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    other = folder_of(tmp_path / "other", {FIRST: b"other", SECOND: b"more"}, seed=4)
    begun: list[str] = []

    def meanwhile(name: str, carried: dict[str, Any]) -> None:
        if name == "PutObject" and not begun:
            begun.append(name)
            _send(other, at)

    _fails(monkeypatch, meanwhile)
    assert "URL: holds another" in _refused(made, at)
    found = _there(endpoint)
    assert found == {**_files(other), **{k: v for k, v in found.items() if k not in _files(other)}}
    assert json.loads(found["manifest.json"])["recipe"]["seed"] == 4


def test_the_same_by_two_at_once_is_one(made: Path, at: str, endpoint: str, monkeypatch: pytest.MonkeyPatch) -> None:
    begun: list[str] = []

    def meanwhile(name: str, carried: dict[str, Any]) -> None:
        if name in ("PutObject", "CompleteMultipartUpload") and not begun:
            begun.append(name)
            _send(made, at)

    _fails(monkeypatch, meanwhile)
    _send(made, at)
    assert _there(endpoint) == _files(made)


def test_a_store_that_knows_no_condition_is_asked_without(
    made: Path, at: str, endpoint: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    refusal = ClientError({"Error": {"Code": "NotImplemented"}}, "PutObject")
    _fails(monkeypatch, lambda name, carried: refusal if "IfNoneMatch" in carried else None)
    _send(made, at)
    assert _there(endpoint) == _files(made)


def test_a_shard_that_is_a_folder(tmp_path: Path, at: str, endpoint: str) -> None:
    shard = "data/train-00000-of-00001.zarr"
    folder = folder_of(tmp_path / "rig", {f"{shard}/.zgroup": b"{}", f"{shard}/signal/0.0": b"numbers"}, kind="zarr")
    assert _send(folder, at).sent == 6
    assert _there(endpoint) == _files(folder)


def test_a_damaged_or_unfinished_folder_is_refused_and_nothing_is_sent(made: Path, at: str, endpoint: str) -> None:
    changes: list[tuple[Callable[[], object], str]] = [
        (lambda: (made / FIRST).write_bytes(LARGE[:-1] + b"x"), f"DIR: is damaged: {FIRST}: differs"),
        (lambda: (made / "notes").write_text("x"), "notes: is surplus"),
        ((made / FIRST).unlink, f"DIR: is damaged: {FIRST}: is missing"),
        (lambda: (made / "manifest.json").write_text("{"), "manifest.json: cannot be read"),
        (
            lambda: (made / "manifest.json").rename(made.with_name("rig.partial")),
            "unfinished: `sideband dataset resume`",
        ),
    ]
    for change, says in changes:
        change()
        assert says in _refused(made, at)
    assert _there(endpoint) == {}


def test_a_manifest_that_points_out_of_the_folder_is_refused(made: Path, at: str) -> None:
    manifest = json.loads((made / "manifest.json").read_text())
    (made.parent / "secret").write_text("x")
    manifest["files"]["../secret"] = "0"
    (made / "manifest.json").write_text(json.dumps(manifest))
    assert "lists ../secret, which is no file of this folder" in _refused(made, at)


@pytest.mark.parametrize("name", [FIRST, SECOND])
@pytest.mark.parametrize("longer", [False, True])
def test_a_file_that_changes_while_it_is_sent_is_noticed(
    made: Path, at: str, endpoint: str, monkeypatch: pytest.MonkeyPatch, name: str, longer: bool
) -> None:
    damage, content = upload.__globals__["damage"], (made / name).read_bytes()

    def checked(*arguments: Any) -> Any:
        found = damage(*arguments)
        (made / name).write_bytes(content + b"more" if longer else content[:-1] + b"x")
        return found

    monkeypatch.setitem(upload.__globals__, "damage", checked)
    assert f"{name}: was changed while it was sent" in _refused(made, at)
    assert not {name, "manifest.json"} & _there(endpoint).keys()


def test_stores_that_cannot_be_used_are_told(
    made: Path, at: str, endpoint: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    told = _refused(made, f"s3://nobodys/rig?endpoint={endpoint}")
    assert "URL: names a bucket that is not there" in told and "allowed: a bucket that exists" in told
    told = _refused(made, "s3://datasets/rig?endpoint=http://127.0.0.1:1")
    assert "URL: cannot be reached, or broke off (EndpointConnectionError)" in told
    for code, says in (
        ("InvalidAccessKeyId", "is refused to these keys of access (InvalidAccessKeyId)"),
        ("PermanentRedirect", "AWS_REGION"),
        ("SlowDown", "is refused by the store (SlowDown)"),
    ):
        refusal = ClientError({"Error": {"Code": code, "Message": "text of theirs"}}, "ListObjectsV2")
        with monkeypatch.context() as patch:
            _fails(patch, lambda name, carried, refusal=refusal: refusal)
            told = _refused(made, at)
        assert says in told and "theirs" not in told
    monkeypatch.delenv("AWS_ACCESS_KEY_ID")
    monkeypatch.delenv("AWS_SECRET_ACCESS_KEY")
    monkeypatch.setenv("AWS_EC2_METADATA_DISABLED", "true")
    monkeypatch.setenv("AWS_SHARED_CREDENTIALS_FILE", str(made / "none"))
    monkeypatch.setenv("AWS_CONFIG_FILE", str(made / "none"))
    assert "URL: needs keys of access" in _refused(made, at)
