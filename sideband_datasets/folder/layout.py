"""Names inside a dataset's folder, and files that appear whole or not at all.

While it is made, a dataset is `NAME.partial` beside its later place: `data/` with the shards, `state/` with a receipt
of each, `state/make.json` with what is made. The finished folder is renamed at once, so nobody reads half of one.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

MANIFEST = "manifest.json"
CARD = "README.md"
CROISSANT = "croissant.json"
FAILURES = "failures.jsonl"
DATA = "data"
STATE = "state"
SETTINGS = "make.json"
BLOCK_BYTES = 1 << 20


def unfinished(out: Path) -> Path:
    """Where a dataset is while it is made."""
    return out.absolute().with_name(f"{out.absolute().name}.partial")


def json_text(document: object) -> str:
    """Indented JSON with sorted keys."""
    return json.dumps(document, indent=2, sort_keys=True, allow_nan=False, ensure_ascii=False) + "\n"


def files_below(path: Path) -> list[Path]:
    """Every file of a shard: itself, or those of its folder, sorted by name."""
    return [path] if path.is_file() else sorted(p for p in path.rglob("*") if p.is_file())


def sha256(path: Path) -> str:
    """Of a file; of a folder, over names and contents of its files."""
    found = hashlib.sha256()
    for file in files_below(path):
        if file != path:
            found.update(f"{file.relative_to(path).as_posix()}\0{file.stat().st_size}\0".encode())
        with file.open("rb") as stream:
            while block := stream.read(BLOCK_BYTES):
                found.update(block)
    return found.hexdigest()


def size_of(path: Path) -> int:
    """Bytes of a file or of all files in a folder."""
    return sum(file.stat().st_size for file in files_below(path))


def synced(path: Path) -> None:
    """Put a file or folder and its name on the disk."""
    for file in [*files_below(path), *(p for p in path.rglob("*") if p.is_dir()), path, path.parent]:
        handle = os.open(file, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def remove(path: Path) -> None:
    """A file or folder, if it is there."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


@contextlib.contextmanager
def whole(path: Path) -> Iterator[Path]:
    """A path to write a file or folder to; it takes its name when it is complete and on the disk."""
    made = path.with_name(f".{path.name}.{os.getpid()}")
    remove(made)
    try:
        yield made
        synced(made)
        remove(path)
        made.replace(path)
        synced(path)
    except BaseException:
        remove(made)
        raise


def write_text(path: Path, text: str) -> None:
    """A whole text file."""
    with whole(path) as made:
        made.write_text(text, encoding="utf-8")
