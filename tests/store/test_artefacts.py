"""The folder store: whole or not at all, and full disks are told as such."""

from __future__ import annotations

import errno
import os
from pathlib import Path

import pytest

from jobs.errors import StoreAway, StoreFull, UnknownArtefact
from store.artefacts.folder import FolderStore


def test_written_bytes_come_back_in_slices(tmp_path: Path) -> None:
    store = FolderStore(tmp_path)
    with store.write("job/1/a.bin") as stream:
        stream.write(b"0123456789")
    assert store.read("job/1/a.bin") == b"0123456789"
    assert store.read("job/1/a.bin", 3, 4) == b"3456"
    assert b"".join(store.chunks("job/1/a.bin", 2, 100)) == b"23456789"
    assert store.size("job/1/a.bin") == 10


def test_interrupted_write_leaves_nothing_and_keeps_the_old(tmp_path: Path) -> None:
    store = FolderStore(tmp_path)
    with store.write("job/1/a") as stream:
        stream.write(b"old")
    with pytest.raises(RuntimeError), store.write("job/1/a") as stream:
        stream.write(b"new")
        raise RuntimeError("killed")
    assert store.read("job/1/a") == b"old"
    assert [p.name for p in (tmp_path / "job/1").iterdir()] == ["a"]


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT])
def test_full_disk_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    store = FolderStore(tmp_path)

    def full(_: int) -> None:
        raise OSError(number, "full")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(StoreFull), store.write("job/1/a") as stream:
        stream.write(b"x")
    assert list((tmp_path / "job/1").iterdir()) == []


def test_other_faults_of_the_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    store = FolderStore(tmp_path)

    def broken(_: int) -> None:
        raise OSError(errno.EIO, "broken")

    monkeypatch.setattr(os, "fsync", broken)
    with pytest.raises(StoreAway), store.write("job/1/a") as stream:
        stream.write(b"x")


@pytest.mark.parametrize("key", ["../x", "job/../../x", "/etc/passwd", "job", "job//x", "job/.hidden", "job/a\n"])
def test_keys_cannot_leave_the_folder(tmp_path: Path, key: str) -> None:
    with pytest.raises(ValueError):
        FolderStore(tmp_path).read(key)


def test_missing_and_deleted(tmp_path: Path) -> None:
    store = FolderStore(tmp_path)
    with pytest.raises(UnknownArtefact):
        store.read("job/1/a")
    with store.write("job/1/a") as stream:
        stream.write(b"x")
    store.delete_prefix("job/")
    store.delete_prefix("job/")
    with pytest.raises(UnknownArtefact):
        store.size("job/1/a")
