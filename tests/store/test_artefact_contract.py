"""What every artefact store promises, whichever it is."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from jobs.errors import UnknownArtefact
from jobs.ports import ArtefactStore
from store.artefacts.choose import open_artefacts
from store.settings import StoreSettings
from tests.service.buckets import BUCKET, bucket_server


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    with bucket_server() as opened:
        yield opened


BUCKETS = [pytest.param(name, marks=pytest.mark.slow) for name in ("bucket", "bucket with a prefix")]


@pytest.fixture(params=["folder", *BUCKETS])
def store(tmp_path: Path, request: pytest.FixtureRequest) -> ArtefactStore:
    url = ""
    if request.param != "folder":
        prefix = f"/{tmp_path.name}" if "prefix" in request.param else ""
        url = f"s3://{BUCKET}{prefix}?endpoint={request.getfixturevalue('endpoint')}"
    return open_artefacts(StoreSettings(data_dir=tmp_path, redis_url="", artefact_url=url))


def put(store: ArtefactStore, key: str, content: bytes) -> None:
    with store.write(key) as stream:
        stream.write(content)


def test_written_bytes_come_back_in_slices(store: ArtefactStore) -> None:
    put(store, "job/1/a.bin", b"0123456789")
    assert store.read("job/1/a.bin") == b"0123456789"
    assert store.read("job/1/a.bin", 3, 4) == b"3456"
    assert store.read("job/1/a.bin", 7) == b"789"
    assert store.read("job/1/a.bin", 8, 100) == b"89"
    assert store.read("job/1/a.bin", 10, 5) == b"" and store.read("job/1/a.bin", 3, 0) == b""
    assert b"".join(store.chunks("job/1/a.bin", 2, 100)) == b"23456789"
    assert store.size("job/1/a.bin") == 10


def test_large_content_comes_in_pieces_and_nothing_may_be_empty(store: ArtefactStore) -> None:
    content = bytes(range(256)) * 12000
    put(store, "job/1/large", content)
    pieces = list(store.chunks("job/1/large", 1, len(content)))
    assert b"".join(pieces) == content[1:] and max(map(len, pieces)) <= 1 << 20
    put(store, "job/1/empty", b"")
    assert store.read("job/1/empty") == b"" and store.size("job/1/empty") == 0


def test_reader_sees_nothing_before_the_end_and_the_old_until_then(store: ArtefactStore) -> None:
    with store.write("job/2/a") as stream:
        stream.write(b"old")
        with pytest.raises(UnknownArtefact):
            store.read("job/2/a")
    with store.write("job/2/a") as stream:
        stream.write(b"new")
        assert store.read("job/2/a") == b"old"
    assert store.read("job/2/a") == b"new"


def test_interrupted_write_leaves_nothing_and_keeps_the_old(store: ArtefactStore) -> None:
    put(store, "job/3/a", b"old")
    for key in ("job/3/a", "job/3/b"):
        with pytest.raises(RuntimeError), store.write(key) as stream:
            stream.write(b"new")
            raise RuntimeError("killed")
    assert store.read("job/3/a") == b"old"
    with pytest.raises(UnknownArtefact):
        store.size("job/3/b")


def test_missing_parts_are_told_by_name(store: ArtefactStore) -> None:
    asks = (store.read, store.size, lambda key: store.read(key, 2, 2), lambda key: list(store.chunks(key, 0, 5)))
    for ask in asks:
        with pytest.raises(UnknownArtefact, match="nothing"):
            ask("job/4/nothing")


def test_deleting_takes_one_job_and_no_other(store: ArtefactStore) -> None:
    for key in ("aa/1/x", "aa/2/y", "aab/1/x"):
        put(store, key, b"x")
    store.delete_prefix("aa/")
    store.delete_prefix("aa/")
    assert store.read("aab/1/x") == b"x"
    for key in ("aa/1/x", "aa/2/y"):
        with pytest.raises(UnknownArtefact):
            store.size(key)


@pytest.mark.slow
@pytest.mark.parametrize("key", ["../x", "job/../../x", "/etc/passwd", "job", "job//x", "job/.hidden", "job/a\n"])
def test_keys_cannot_leave_the_store(store: ArtefactStore, key: str) -> None:
    for ask in (store.read, store.size, lambda k: put(store, k, b"")):
        with pytest.raises(ValueError):
            ask(key)


def test_threads_share_a_store(store: ArtefactStore) -> None:
    def work(i: int) -> None:
        put(store, f"job/5/f{i}", b"%d" % i)

    threads = [threading.Thread(target=work, args=(i,)) for i in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [store.read(f"job/5/f{i}") for i in range(8)] == [b"%d" % i for i in range(8)]


def test_check_is_content(store: ArtefactStore) -> None:
    store.check()
    store.check()
    free = store.free_bytes()
    assert free is None or free > 0
