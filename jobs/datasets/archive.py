"""A whole dataset as one tar, made while it is sent: the same bytes each time, of a length known beforehand."""

from __future__ import annotations

import tarfile
from collections.abc import Iterator, Mapping

from jobs.datasets.stored import Place
from jobs.ports import ArtefactStore

_END = tarfile.RECORDSIZE


def archive_size(places: Mapping[str, Place], folder: str) -> int:
    """Length of the archive in bytes."""
    members = sum(len(_header(path, place, folder)) + _padded(place.bytes) for path, place in places.items())
    return members + _END


def archive_pieces(artefacts: ArtefactStore, places: Mapping[str, Place], folder: str) -> Iterator[bytes]:
    """The archive, its files below `folder`, sorted by path; they carry no time and no owner."""
    for path, place in sorted(places.items()):
        yield _header(path, place, folder)
        yield from artefacts.chunks(place.key, 0, place.bytes)
        yield b"\0" * (_padded(place.bytes) - place.bytes)
    yield b"\0" * _END


def _header(path: str, place: Place, folder: str) -> bytes:
    about = tarfile.TarInfo(f"{folder}/{path}")
    about.size, about.mode = place.bytes, 0o644
    return about.tobuf(tarfile.PAX_FORMAT)


def _padded(size: int) -> int:
    return -(-size // tarfile.BLOCKSIZE) * tarfile.BLOCKSIZE
