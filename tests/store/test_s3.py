"""What only an object store does: being far away, refusing, damaging, filling up."""

from __future__ import annotations

import base64
import hashlib
import multiprocessing
import socket
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from botocore.exceptions import ClientError

from jobs.errors import StoreAway, StoreFull
from sim.core.errors import SpecError
from store.artefacts import s3
from store.artefacts.place import S3Place, s3_place
from store.artefacts.s3_errors import translated
from tests.service.buckets import BUCKET, bucket_server, raw_client


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    with bucket_server() as opened:
        yield opened


def at(endpoint: str, **changes: str) -> s3.S3Store:
    return s3.S3Store(S3Place(**{"bucket": BUCKET, "endpoint": endpoint, **changes}))


PART = 5 * 2**20
"""The smallest part that a store takes."""


def asked_of(store: s3.S3Store) -> list[str]:
    """Names of the requests, as they are made from now on."""
    asked: list[str] = []
    store._client().meta.events.register("before-call.s3", lambda model, **_: asked.append(model.name))
    return asked


def put(store: s3.S3Store, key: str, content: bytes) -> None:
    with store.write(key) as stream:
        stream.write(content)


@pytest.mark.slow
def test_digest_goes_with_the_object_and_damage_is_noticed(endpoint: str) -> None:
    store = at(endpoint)
    put(store, "job/1/a", b"content")
    raw = raw_client(endpoint)
    told = raw.head_object(Bucket=BUCKET, Key="job/1/a", ChecksumMode="ENABLED")
    digest = base64.b64encode(hashlib.sha256(b"content").digest()).decode()
    assert told["ChecksumSHA256"] == digest
    # This server takes any digest: it lets us lay down bytes that are not the digest's.
    raw.put_object(Bucket=BUCKET, Key="job/1/a", Body=b"damaged", ChecksumSHA256=digest, ChecksumAlgorithm="SHA256")
    with pytest.raises(StoreAway, match="FlexibleChecksumError"):
        store.read("job/1/a")


@pytest.mark.slow
def test_large_object_goes_in_parts_and_is_proved_when_it_is_read_whole(endpoint: str) -> None:
    store = s3.S3Store(S3Place(bucket=BUCKET, endpoint=endpoint), part_bytes=PART)
    asked = asked_of(store)
    put(store, "job/8/small", b"s" * PART)
    assert asked == ["PutObject"], "up to the size of a part nothing changes"
    content = bytes(range(256)) * (2 * PART // 256) + b"end"
    put(store, "job/8/large", content)
    assert asked[1:] == ["CreateMultipartUpload", *["UploadPart"] * 3, "CompleteMultipartUpload"]
    assert store.size("job/8/large") == len(content)
    assert store.read("job/8/large") == content
    assert store.read("job/8/large", PART - 2, 4) == content[PART - 2 : PART + 2]
    raw = raw_client(endpoint)
    told = raw.head_object(Bucket=BUCKET, Key="job/8/large")["Metadata"]
    assert told == {"sha256": hashlib.sha256(content).hexdigest()}
    raw.put_object(Bucket=BUCKET, Key="job/8/large", Body=b"damaged", Metadata=told)
    with pytest.raises(StoreAway, match="other bytes"):
        store.read("job/8/large")


@pytest.mark.slow
@pytest.mark.parametrize("fails", ["UploadPart", "CompleteMultipartUpload"])
def test_upload_in_parts_that_fails_is_taken_back_and_nobody_sees_it(endpoint: str, fails: str) -> None:
    store = s3.S3Store(S3Place(bucket=BUCKET, endpoint=endpoint), part_bytes=PART)
    raw, seen = raw_client(endpoint), []

    def refuse(**_: object) -> None:
        seen.append([u["Key"] for u in raw.list_multipart_uploads(Bucket=BUCKET).get("Uploads", ())])
        if fails == "CompleteMultipartUpload" or len(seen) == 2:
            assert list(store.keys("job/9/")) == []
            raise ClientError({"Error": {"Code": "SlowDown"}}, fails)

    store._client().meta.events.register(f"before-call.s3.{fails}", refuse)
    with pytest.raises(StoreAway, match="SlowDown"):
        put(store, "job/9/a", b"x" * (PART + 1))
    assert seen[-1] == ["job/9/a"], "it was under way"
    assert raw.list_multipart_uploads(Bucket=BUCKET).get("Uploads", []) == []
    assert list(store.keys("job/9/")) == []


@pytest.mark.slow
def test_listing_by_job_goes_over_pages(endpoint: str) -> None:
    store = at(endpoint, prefix="deep/place")
    for i in range(5):
        put(store, f"many/1/f{i}", b"x")
    assert sorted(store.keys("many/")) == [f"deep/place/many/1/f{i}" for i in range(5)]
    names = {entry["Key"] for entry in raw_client(endpoint).list_objects_v2(Bucket=BUCKET)["Contents"]}
    assert "deep/place/many/1/f0" in names


@pytest.mark.slow
@pytest.mark.usefixtures("endpoint")
def test_server_that_is_away_is_told_soon() -> None:
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen(1)
        store = at(f"http://127.0.0.1:{silent.getsockname()[1]}")
        begin = time.monotonic()
        with pytest.raises(StoreAway, match="does not answer"):
            store.check()
        assert time.monotonic() - begin < 10
    with pytest.raises(StoreAway, match="EndpointConnectionError"):
        store.check()


@pytest.mark.slow
def test_bucket_that_is_not_there(endpoint: str) -> None:
    store = at(endpoint, bucket="nobodys")
    for ask in (store.check, lambda: put(store, "job/1/a", b""), lambda: list(store.keys("job/"))):
        with pytest.raises(StoreAway, match="no bucket"):
            ask()


@pytest.mark.parametrize(
    ("code", "kind", "says"),
    [
        ("XMinioStorageFull", StoreFull, "full"),
        ("QuotaExceeded", StoreFull, "full"),
        ("AccessDenied", StoreAway, "credentials"),
        ("SlowDown", StoreAway, "SlowDown"),
        ("InvalidRange", StoreAway, "InvalidRange"),
    ],
)
def test_refusals_in_our_words(code: str, kind: type[Exception], says: str) -> None:
    refusal = ClientError({"Error": {"Code": code, "Message": "text of theirs"}}, "PutObject")  # type: ignore[arg-type]
    with pytest.raises(kind, match=says) as caught, translated("job/1/a"):
        raise refusal
    assert "theirs" not in str(caught.value)


@pytest.mark.slow
def test_object_beyond_the_bound_is_refused_before_it_is_sent(endpoint: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(s3, "MAX_BYTES", 10)
    store = at(endpoint)
    with pytest.raises(StoreFull, match="10 bytes"), store.write("job/6/a") as stream:
        stream.write(b"123456")
        stream.write(b"123456")
    assert list(store.keys("job/6/")) == []


def test_full_local_disk_is_told(endpoint: str, tmp_path: Path) -> None:
    store = s3.S3Store(S3Place(bucket=BUCKET, endpoint=endpoint), spool=tmp_path / "missing")
    with pytest.raises(StoreAway, match="temporary"), store.write("job/1/a"):
        pass


@pytest.mark.slow
def test_health_writes_seldom_but_always_asks(endpoint: str) -> None:
    now = [0.0]
    store = s3.S3Store(S3Place(bucket=BUCKET, endpoint=endpoint, prefix="watched"), monotonic=lambda: now[0])
    asked: list[str] = []
    store._client(probe=True).meta.events.register("before-call.s3", lambda model, **_: asked.append(model.name))
    for now[0] in (0.0, 5.0, 29.0, 31.0, 40.0):
        store.check()
    assert asked == ["PutObject", "HeadBucket", "HeadBucket", "PutObject", "HeadBucket"]


def _in_child(store: s3.S3Store, parents: int, told: multiprocessing.Queue[bool]) -> None:
    told.put(id(store._client()) != parents and store.read("job/7/a") == b"parent's")


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:This process:DeprecationWarning")
def test_forked_child_has_connections_of_its_own(endpoint: str) -> None:
    store = at(endpoint)
    put(store, "job/7/a", b"parent's")
    fork = multiprocessing.get_context("fork")
    told: multiprocessing.Queue[bool] = fork.Queue()
    child = fork.Process(target=_in_child, args=(store, id(store._client()), told))
    child.start()
    assert told.get(timeout=30)
    child.join(30)
    assert child.exitcode == 0


def test_url_is_read() -> None:
    assert s3_place("s3://results") == S3Place(bucket="results")
    read = s3_place("s3://results/a/b/?endpoint=http://127.0.0.1:9000&region=eu-1")
    assert read == S3Place(bucket="results", prefix="a/b", endpoint="http://127.0.0.1:9000", region="eu-1")


@pytest.mark.parametrize(
    ("url", "says"),
    [
        ("s3://", "bucket"),
        ("s3://Upper", "bucket"),
        ("s3://key:secret@bucket", "secret"),
        ("s3://bucket/a//b", "prefix"),
        ("s3://bucket/../b", "prefix"),
        ("s3://bucket?endpoint=ftp://h", "endpoint"),
        ("s3://bucket?endpoint=http://h/path", "endpoint"),
        ("s3://bucket?region=a b", "region"),
        ("s3://bucket?regoin=x", "regoin"),
        ("s3://bucket?endpoint", "URL"),
        ("s3://bucket?region=a&region=b", "repeated"),
    ],
)
def test_urls_that_cannot_be_used(url: str, says: str) -> None:
    with pytest.raises(SpecError, match=says) as caught:
        s3_place(url)
    problem = caught.value.problems[0]
    assert problem.field == "ARTEFACT_URL" and "key:secret" not in str(caught.value) and "s3://" in problem.allowed
