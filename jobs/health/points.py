"""A machine's recordings as points in time: their features are read, never computed here."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from jobs.health.words import CONDITION, MOST_SAMPLES
from jobs.identity import canonical_json
from jobs.kept import Kept
from jobs.ports import ArtefactStore, JobCatalogue, JobQuery
from jobs.record import JobRecord
from jobs.recordings.words import RECORDING
from jobs.results import ResultReader
from jobs.status import Status
from signals.ingest import moment

MOST_POINTS = 5000
"""The latest recordings of a machine that are followed."""
_PAGE = 500


@dataclass(frozen=True, kw_only=True)
class Operating:
    """Operating point; `speed_from`: `tacho`, `harmonics` (measured) or `stated`."""

    shaft: str
    speed_hz: float
    torque_nm: float | None
    speed_from: str = "stated"


@dataclass(frozen=True, kw_only=True)
class ChannelPoint:
    """A channel of one recording: what it measures and where, and its features by key (None: has none)."""

    quantity: str
    unit: str
    location: str
    axis: str
    features: Mapping[str, float | None]
    sideband_of: Mapping[str, str] = field(default_factory=dict)
    """Families whose line lies where a clearer family of the same bearing has its first sideband: that family's key."""

    @property
    def place(self) -> tuple[str, str, str, str]:
        """Only what agrees in it is compared."""
        return self.quantity, self.unit, self.location, self.axis


@dataclass(frozen=True, kw_only=True)
class Point:
    """One recording of a machine."""

    recording: str
    name: str
    """Of its file."""
    time: float
    """When it was taken, s since the epoch; when it was sent in, unless it says so."""
    time_stated: bool
    baseline: bool
    vibration_class: str | None
    version: str
    """Of its features; empty for a recording that was read before there were any: its RMS alone is known then."""
    sampling_rate_hz: float
    duration_s: float
    """Of what its features were computed from."""
    operating: Operating | None
    channels: Mapping[str, ChannelPoint]
    findings: tuple[Mapping[str, Any], ...]
    reasons: tuple[str, ...]


def points_of(records: Iterable[JobRecord], artefacts: ArtefactStore, kept: Kept) -> list[Point]:
    """Recordings that were read, the earliest first."""
    found = [_point(record, artefacts, kept) for record in records]
    return sorted(found, key=lambda p: (p.time, p.recording))


def records_of(catalogue: JobCatalogue, machine: str) -> list[JobRecord]:
    """Every recording of a machine that was read, up to 5000, the last sent first."""
    return list(_records(catalogue, machine))


def _records(catalogue: JobCatalogue, machine: str) -> Iterator[JobRecord]:
    after: tuple[float, str] | None = None
    for _ in range(MOST_POINTS // _PAGE):
        query = JobQuery(
            statuses=(Status.SUCCESSFUL,), preset=machine, kind=RECORDING, sort="created_at", limit=_PAGE, after=after
        )
        records, _total = catalogue.query(query)
        yield from (record for record in records if record.gone is None and record.result is not None)
        if len(records) < _PAGE:
            return
        after = (records[-1].created_at, records[-1].id)


def _point(record: JobRecord, artefacts: ArtefactStore, kept: Kept) -> Point:
    assert record.result is not None
    prefix = f"{record.id}/{record.result.attempt}"
    about = record.source["description"]
    assert isinstance(about, Mapping)
    document = json.loads(kept.get((prefix, record.result.sha256), lambda: _read(ResultReader(artefacts, prefix))))
    stated = moment(str(about.get("recorded_at") or ""))
    operating = document["operating"]
    return Point(
        recording=record.id,
        name=str(record.source["name"]),
        time=record.created_at if stated is None else stated.timestamp(),
        time_stated=stated is not None,
        baseline=about.get("condition") == "baseline",
        vibration_class=about.get("vibration_class"),
        version=document["version"],
        sampling_rate_hz=document["sampling_rate_hz"],
        duration_s=document["duration_s"],
        operating=None if operating is None else Operating(**operating),
        channels={name: ChannelPoint(**entry) for name, entry in document["channels"].items()},
        findings=tuple(document["findings"]),
        reasons=tuple(document["reasons"]),
    )


def _read(reader: ResultReader) -> bytes:
    """The features, and the defects that were found when the file was read."""
    summary: dict[str, Any] = reader.document("summary")
    document = reader.document(CONDITION) if reader.has(CONDITION) else _without_features(summary)
    document.pop("lines", None)  # told with the recording; here they would only take up memory
    findings = [
        {key: finding[key] for key in ("channel", "kind", "message", "count")} for finding in summary["findings"]
    ]
    looked_at_s = min(summary["duration_s"], MOST_SAMPLES / summary["sampling_rate_hz"])
    return canonical_json({**document, "findings": findings, "duration_s": looked_at_s}).encode()


def _without_features(summary: Mapping[str, Any]) -> dict[str, object]:
    """What the report of an earlier reading tells."""
    channels = {
        entry["name"]: {
            **{key: entry[key] for key in ("quantity", "unit", "location", "axis")},
            "features": {"rms": entry["rms"]},
        }
        for entry in summary["channels"]
    }
    return {
        "version": "",
        "sampling_rate_hz": summary["sampling_rate_hz"],
        "operating": summary["operating"],
        "channels": channels,
        "reasons": ["was read before features were kept: delete it and send it again to have them"],
    }
