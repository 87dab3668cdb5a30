"""The folder of atlases: whole files only, the longest unused given up first."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from store.atlas import AtlasFolder, default_atlas_folder


def test_what_is_put_is_got(tmp_path: Path) -> None:
    folder = AtlasFolder(tmp_path / "deep" / "atlas")
    assert folder.get("atlas-1") is None
    folder.put("atlas-1", b"one")
    folder.put("atlas-1", b"two")
    assert folder.get("atlas-1") == b"two"
    assert [p.name for p in (tmp_path / "deep" / "atlas").iterdir()] == ["atlas-1.npz"]


def test_a_broken_write_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = AtlasFolder(tmp_path)
    folder.put("atlas-1", b"old")

    def full(*_: object) -> None:
        raise OSError("no space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(OSError, match="no space"):
        folder.put("atlas-1", b"new")
    assert [p.name for p in tmp_path.iterdir()] == ["atlas-1.npz"]
    assert folder.get("atlas-1") == b"old"


def test_the_longest_unused_goes_first(tmp_path: Path) -> None:
    folder = AtlasFolder(tmp_path, most_bytes=250)
    for age, key in ((300, "a"), (200, "b")):
        folder.put(key, bytes(100))
        old = (tmp_path / f"{key}.npz").stat().st_mtime - age
        os.utime(tmp_path / f"{key}.npz", (old, old))
    assert folder.get("a") is not None  # used just now
    folder.put("c", bytes(100))
    assert folder.get("b") is None
    assert folder.get("a") is not None and folder.get("c") is not None


def test_the_newest_stays_even_when_too_large(tmp_path: Path) -> None:
    folder = AtlasFolder(tmp_path, most_bytes=10)
    folder.put("a", bytes(100))
    assert folder.get("a") is not None


@pytest.mark.parametrize("key", ["../a", "a/b", "", "a.b"])
def test_keys_are_no_paths(tmp_path: Path, key: str) -> None:
    with pytest.raises(ValueError, match="no atlas key"):
        AtlasFolder(tmp_path).put(key, b"")
    assert list(tmp_path.iterdir()) == []


def test_the_default_folder_is_told_or_the_cache(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("SIDEBAND_ATLAS", str(tmp_path))
    assert default_atlas_folder() == tmp_path
    monkeypatch.delenv("SIDEBAND_ATLAS")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert default_atlas_folder() == tmp_path / "sideband" / "atlas"
