"""A finished dataset put into a bucket: its files first, its manifest last, so that no reader meets half of one.

A dataset is there when its `manifest.json` is. Until then whatever is there is an upload that was not finished, which
the same command takes up again: what is there already is not sent twice.
"""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, TypeVar

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import MANIFEST
from sideband_datasets.folder.opened import ListedFile, listed_files, opened
from sideband_datasets.folder.publish import damage
from sim.core.errors import SpecError
from store.artefacts.place import S3Place
from store.artefacts.s3_parts import PART_BYTES
from store.datasets.bucket import Bucket, Content, Proving
from store.datasets.refusals import ELSEWHERE, in_folder, in_place, refusals


@dataclass(frozen=True, kw_only=True)
class Progress:
    """Bytes of the dataset that are there, of all, and of those what was there before; `stage`: what goes on."""

    stage: str
    done: int = 0
    total: int = 0
    kept: int = 0


@dataclass(frozen=True, kw_only=True)
class Uploaded:
    """`files` and `bytes` of the dataset, manifest included; `sent`: files that were not there before."""

    files: int
    bytes: int
    sent: int


Told = Callable[[Progress], object]
_Found = TypeVar("_Found")


def upload(folder: Path, place: S3Place, url: str, told: Told, *, part_bytes: int = PART_BYTES) -> Uploaded:
    """Put the dataset in `folder` to a place; `url` is what is told of it. Nothing that is there is replaced.

    SpecError, of DIR or URL: the folder is unfinished or damaged, another dataset or other files are at the place, the
    store refuses or is away. Memory: one part of `part_bytes`.
    """
    return _Upload(folder, place, url, told, part_bytes).run()


class _Upload:
    def __init__(self, folder: Path, place: S3Place, url: str, told: Told, part_bytes: int) -> None:
        self._folder, self._url, self._told = folder, url, told
        self._manifest = self._sound(opened(folder))
        self._files = self._sound(listed_files(folder, self._manifest))
        self._body = (folder / MANIFEST).read_bytes()
        self._total = sum(file.size for file in self._files) + len(self._body)
        with refusals(url):
            self._bucket = Bucket(place, part_bytes=part_bytes)

    def run(self) -> Uploaded:
        """All of it."""
        with refusals(self._url):
            there = self._there()
        if MANIFEST in there:
            self._check_complete(there)
            return self._uploaded(0)
        self._told(Progress(stage="checksums"))
        if found := damage(self._folder, self._manifest):
            raise in_folder(self._folder, found)
        with refusals(self._url):
            kept = [file for file in self._files if file.name in there and self._is_there(file)]
            done = before = sum(file.size for file in kept)
            names = {file.name for file in kept}
            self._say(done, before)
            for file in self._files:
                if file.name not in names:
                    self._send(file, done, before)
                    done += file.size
            # Once more: what another command did meanwhile, where the store knows no condition.
            self._check_complete(self._there())
            self._commit()
        self._say(self._total, before)
        return self._uploaded(len(self._files) - len(kept) + 1)

    def _sound(self, found: _Found | Finding) -> _Found:
        if isinstance(found, Finding):
            raise in_folder(self._folder, [found])
        return found

    def _say(self, done: int, kept: int) -> None:
        self._told(Progress(stage="upload", done=done, total=self._total, kept=kept))

    def _uploaded(self, sent: int) -> Uploaded:
        return Uploaded(files=len(self._files) + 1, bytes=self._total, sent=sent)

    def _there(self) -> dict[str, int]:
        """Sizes of what is there. SpecError when any of it is not of this dataset."""
        ours = {file.name: file.size for file in self._files}
        found: dict[str, int] = {}
        # The manifest first: among foreign files it says most.
        for names in (self._bucket.listed(MANIFEST), self._bucket.listed()):
            for name, size in names:
                if name == MANIFEST:
                    self._check_manifest(size)
                elif name not in ours:
                    raise in_place(self._url, f"holds what is no part of this dataset: {name}", ELSEWHERE)
                elif ours[name] != size:
                    raise self._other(name)
                found[name] = size
        return found

    def _check_manifest(self, size: int) -> None:
        found = self._bucket.content(MANIFEST) if size == len(self._body) else None
        if found != self._content(self._body):
            message = f"holds another dataset: its {MANIFEST} has another checksum"
            raise in_place(self._url, message, ELSEWHERE)

    def _check_complete(self, there: Iterable[str]) -> None:
        missing = sorted({file.name for file in self._files}.difference(there))
        if missing:
            others = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
            message = f"has lost {missing[0]}{others}, which somebody removed"
            raise in_place(self._url, message, f"{ELSEWHERE}, or this one emptied")

    def _is_there(self, file: ListedFile) -> bool:
        found = self._bucket.content(file.name)
        if found is not None and found.digest != file.sha256():
            raise self._other(file.name)
        return found is not None

    def _other(self, name: str) -> SpecError:
        return in_place(self._url, f"holds another {name}, of an upload that was not finished", ELSEWHERE)

    def _send(self, file: ListedFile, done: int, kept: int) -> None:
        content = Content(size=file.size, digest=file.sha256())
        changed = in_folder(self._folder, [Finding(where=file.name, what="was changed while it was sent")])
        if self._bucket.in_parts(content):
            self._bucket.drop_unfinished(file.name)
        with file.path.open("rb") as stream:

            def source() -> Proving:
                stream.seek(0)
                return Proving(stream, content, lambda read: self._say(done + read, kept), changed)

            if not self._bucket.put(file.name, source, content):
                raise self._other(file.name)
        self._say(done + file.size, kept)

    def _commit(self) -> None:
        content = self._content(self._body)
        changed = in_folder(self._folder, [Finding(where=MANIFEST, what="was changed while it was sent")])

        def source() -> Proving:
            stream: BinaryIO = io.BytesIO(self._body)
            return Proving(stream, content, int, changed)

        if not self._bucket.put(MANIFEST, source, content):
            message = f"holds another dataset by now: its {MANIFEST} has another checksum"
            raise in_place(self._url, message, ELSEWHERE)

    @staticmethod
    def _content(body: bytes) -> Content:
        return Content(size=len(body), digest=hashlib.sha256(body).hexdigest())
