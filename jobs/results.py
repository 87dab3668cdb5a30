"""A result on the artefact store: written once by an attempt, read in slices.

Layout under `job/attempt/`: `signals.f64` (channels x samples, little-endian float64, row after row), `spectra.f64`
(axis then values of each spectrum), `summary.json`, `peaks.json`, where asked for `causes.json` and `impacts.json`,
and `manifest.json`, written last.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict

import numpy as np
from pydantic import BaseModel, ConfigDict

from jobs.documents import FloatArray, ResultDocuments, SpectrumDocument, SpectrumKind
from jobs.errors import UnknownArtefact
from jobs.identity import canonical_json
from jobs.ports import ArtefactStore
from jobs.record import ResultRef
from sim.core.response import Channel, Response

MANIFEST_VERSION = 1
_ITEM = 8


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True)


class ChannelEntry(_Part):
    """A channel as `sim.core.response.Channel` names it."""

    name: str
    quantity: str
    unit: str
    location: str
    axis: str = ""


class SpectrumEntry(_Part):
    """Where a spectrum lies in `spectra.f64`: `offset` in bytes, `lines` axis values then as many values."""

    channel: str
    kind: SpectrumKind
    axis_unit: str
    unit: str
    meta: dict[str, object]
    offset: int
    lines: int


class FileEntry(_Part):
    """Size and digest of one file of the result."""

    bytes: int
    sha256: str


class Manifest(_Part):
    """Table of contents of a result."""

    version: int = MANIFEST_VERSION
    physics_version: str
    seed: int
    sampling_rate_hz: float
    samples: int
    channels: tuple[ChannelEntry, ...]
    spectra: tuple[SpectrumEntry, ...]
    files: dict[str, FileEntry]


def write_result(
    store: ArtefactStore,
    prefix: str,
    *,
    attempt: int,
    response: Response,
    documents: ResultDocuments,
    expires_at: float | None,
) -> ResultRef:
    """Write every file, the manifest last; the same response gives the same bytes."""
    signals = np.ascontiguousarray(response.signals, dtype="<f8")
    files = {
        "signals.f64": put_file(store, f"{prefix}/signals.f64", [row.tobytes() for row in signals]),
        "spectra.f64": put_file(store, f"{prefix}/spectra.f64", [_pair(s) for s in documents.spectra]),
        "summary.json": put_file(store, f"{prefix}/summary.json", [json_bytes(documents.summary)]),
        "peaks.json": put_file(store, f"{prefix}/peaks.json", [json_bytes(documents.peaks)]),
    }
    files |= {
        f"{name}.json": put_file(store, f"{prefix}/{name}.json", [json_bytes(d)])
        for name, d in documents.extras.items()
    }
    manifest = Manifest(
        physics_version=response.version,
        seed=response.seed,
        sampling_rate_hz=response.sampling_rate_hz,
        samples=signals.shape[1],
        channels=tuple(ChannelEntry(**asdict(channel)) for channel in response.channels),
        spectra=_entries(documents.spectra),
        files=files,
    )
    table = put_file(store, f"{prefix}/manifest.json", [json_bytes(manifest.model_dump(mode="json"))])
    size = table.bytes + sum(entry.bytes for entry in files.values())
    return ResultRef(attempt=attempt, size_bytes=size, sha256=table.sha256, expires_at=expires_at)


def put_file(store: ArtefactStore, key: str, parts: Iterable[bytes]) -> FileEntry:
    """Write one file; its size and digest."""
    digest, size = hashlib.sha256(), 0
    with store.write(key) as stream:
        for part in parts:
            stream.write(part)
            digest.update(part)
            size += len(part)
    return FileEntry(bytes=size, sha256=digest.hexdigest())


def json_bytes(document: Mapping[str, object]) -> bytes:
    """A document as it is stored: one text for one meaning."""
    return canonical_json(plain(document)).encode()


def plain(value: object) -> object:
    """Only what JSON has: numbers that are not finite become null, numpy's scalars and arrays Python's own."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def _pair(spectrum: SpectrumDocument) -> bytes:
    return np.concatenate([spectrum.axis, spectrum.values]).astype("<f8").tobytes()


def _entries(spectra: tuple[SpectrumDocument, ...]) -> tuple[SpectrumEntry, ...]:
    entries, offset = [], 0
    for s in spectra:
        lines = int(s.axis.size)
        entries.append(
            SpectrumEntry(
                channel=s.channel,
                kind=s.kind,
                axis_unit=s.axis_unit,
                unit=s.unit,
                meta=dict(s.meta),
                offset=offset,
                lines=lines,
            )
        )
        offset += 2 * lines * _ITEM
    return tuple(entries)


class ResultReader:
    """Reads one stored result; nothing larger than the slice asked for is loaded."""

    def __init__(self, store: ArtefactStore, prefix: str) -> None:
        self._store, self._prefix = store, prefix
        self.manifest = Manifest.model_validate_json(store.read(f"{prefix}/manifest.json"))

    def has(self, name: str) -> bool:
        """Whether the result has a document of this name."""
        return f"{name}.json" in self.manifest.files

    def document(self, name: str) -> dict[str, object]:
        """`summary`, `peaks`, or another document of the result (`has` tells) as JSON; raises UnknownArtefact."""
        if not self.has(name):
            known = [file.removesuffix(".json") for file in self.manifest.files if file.endswith(".json")]
            raise UnknownArtefact("document", name, known)
        loaded: dict[str, object] = json.loads(self._store.read(f"{self._prefix}/{name}.json"))
        return loaded

    def channel(self, name: str) -> Channel:
        """Description of a channel; raises UnknownArtefact."""
        return Channel(**self.manifest.channels[self._row(name)].model_dump())

    def signal(self, name: str, start: int, stop: int) -> FloatArray:
        """Samples start..stop of one channel, shape (stop - start,)."""
        offset = (self._row(name) * self.manifest.samples + start) * _ITEM
        raw = self._store.read(f"{self._prefix}/signals.f64", offset, max(0, stop - start) * _ITEM)
        return np.frombuffer(raw, dtype="<f8")

    def spectrum(self, channel: str, kind: str) -> SpectrumDocument:
        """One stored spectrum; raises UnknownArtefact naming the ones there are."""
        self._row(channel)
        for entry in self.manifest.spectra:
            if entry.channel == channel and entry.kind == kind:
                return self._load(entry)
        known = [f"{e.kind} of {e.channel}" for e in self.manifest.spectra]
        raise UnknownArtefact("spectrum", f"{kind} of {channel}", known)

    def _load(self, entry: SpectrumEntry) -> SpectrumDocument:
        raw = self._store.read(f"{self._prefix}/spectra.f64", entry.offset, 2 * entry.lines * _ITEM)
        both = np.frombuffer(raw, dtype="<f8")
        return SpectrumDocument(
            channel=entry.channel,
            kind=entry.kind,
            axis=both[: entry.lines],
            axis_unit=entry.axis_unit,
            values=both[entry.lines :],
            unit=entry.unit,
            meta=entry.meta,
        )

    def _row(self, name: str) -> int:
        names = [channel.name for channel in self.manifest.channels]
        if name not in names:
            raise UnknownArtefact("channel", name, names)
        return names.index(name)
