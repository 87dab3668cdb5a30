"""Accepting a recording: the file and its description are durable before the reply; the same content is kept once."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import PurePath
from typing import BinaryIO

from jobs import transitions
from jobs.accept import RESERVED_BYTES, Acceptance, Desk, check_queue, hand_over, needs_work
from jobs.errors import StoreFull
from jobs.identity import job_id
from jobs.record import Cost
from jobs.recordings.described import check_kinematics
from jobs.recordings.words import READERS_VERSION, RECORDING, upload_key
from signals.ingest import FORMATS, Bounds, check_units, read_description, suffix_of
from sim.core.errors import Problem, SpecError

ROOM = 4
"""Space asked for, in sizes of the file: the file itself and its samples as doubles."""
READING_S = 5.0
_PIECE = 2**20


@dataclass(frozen=True, kw_only=True)
class Upload:
    """A file as it came: the name the sender gave it (only its ending matters) and its content on the local disk."""

    name: str
    content: BinaryIO


def accept_recording(desk: Desk, document: object, upload: Upload, *, submitter: str) -> Acceptance:
    """Keep the file, then the job; SpecError when the description cannot describe any file."""
    _check_description(document)
    assert isinstance(document, Mapping)
    about = {key: value for key, value in document.items() if key != "data"}
    suffix = _suffix(upload.name, document.get("data"))
    digest, size = _digest(upload.content)
    if size == 0:
        raise SpecError(Problem(field="file", message="is empty", given=0, allowed="> 0", unit="bytes"))
    file = {"sha256": digest, "bytes": size, "format": suffix}
    request = {"description": about, "file": file}
    identifier = job_id(RECORDING, request, READERS_VERSION)
    now = desk.clock()
    if needs_work(desk.catalogue, identifier):
        check_queue(desk)
        _check_space(desk, size)
        with desk.artefacts.write(upload_key(identifier, suffix)) as stream:
            for piece in _pieces(upload.content):
                stream.write(piece)
    source = {"name": re.split(r"[/\\]", upload.name)[-1][:200], **request}
    record, created = desk.catalogue.put(
        identifier,
        request,
        first=lambda: transitions.new(
            job_id=identifier,
            kind=RECORDING,
            submitter=submitter,
            source=source,
            cost=Cost(steps=0, memory_bytes=min(ROOM * size, Bounds().memory_bytes), seconds=READING_S),
            now=now,
        ),
        again=lambda present: transitions.submit_again(present, submitter, now),
    )
    return Acceptance(record=hand_over(desk, record), created=created, replayed=False)


def _check_description(document: object) -> None:
    """Whatever can be refused before the file is looked at."""
    description = read_description(document)
    check_units(description)
    check_kinematics(description)


def _suffix(name: str, data: object) -> str:
    """The format, by the file's own name or the description's; never taken from the content."""
    for text in (name, data):
        if isinstance(text, str) and suffix_of(PurePath(text)) in FORMATS:
            return suffix_of(PurePath(text))
    message = "must have a name that ends in its format"
    raise SpecError(Problem(field="file", message=message, given=name[:200] or None, allowed=", ".join(FORMATS)))


def _digest(content: BinaryIO) -> tuple[str, int]:
    digest, size = hashlib.sha256(), 0
    for piece in _pieces(content):
        digest.update(piece)
        size += len(piece)
    return digest.hexdigest(), size


def _pieces(content: BinaryIO) -> Iterator[bytes]:
    content.seek(0)
    while piece := content.read(_PIECE):
        yield piece


def _check_space(desk: Desk, size: int) -> None:
    free, needed = desk.artefacts.free_bytes(), ROOM * size + RESERVED_BYTES
    if free is not None and free < needed:
        raise StoreFull(f"the recording needs about {needed} bytes of space, {free} are free")
