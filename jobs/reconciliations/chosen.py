"""The recordings that a request names: there, read, and not too long together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from jobs.errors import RecordingsNotReady, UnknownJob
from jobs.ports import ArtefactStore, JobCatalogue
from jobs.record import JobRecord
from jobs.recordings.stored import described_recording, stored_recording
from jobs.recordings.words import RECORDING, SUMMARY
from jobs.results import ResultReader
from jobs.status import Status
from reconcile.entry import MOST_SAMPLES
from signals.recording import Recording
from sim.core.errors import Problem, SpecError

USABLE = "the id of a recording that is ready"


@dataclass(frozen=True, kw_only=True)
class Chosen:
    """Readers of the recordings to explain and of the baselines, in the order they were named."""

    recordings: tuple[ResultReader, ...]
    baselines: tuple[ResultReader, ...]
    labels: tuple[str, ...]
    """What refusals call each, the recordings first: the name of its file, and its id."""

    @property
    def samples(self) -> int:
        """Of all channels together."""
        return sum(r.manifest.samples * len(r.manifest.channels) for r in (*self.recordings, *self.baselines))

    def described(self) -> tuple[list[Recording], list[Recording]]:
        """The same without their samples, labelled by their places in the request."""
        tests, baselines = (
            [described_recording(reader, f"{field}.{place}") for place, reader in enumerate(readers)]
            for field, readers in (("recordings", self.recordings), ("baselines", self.baselines))
        )
        return tests, baselines

    def loaded(self) -> tuple[list[Recording], list[Recording]]:
        """The recordings and the baselines with their samples."""
        readers = (*self.recordings, *self.baselines)
        every = [replace(stored_recording(r), label=label) for r, label in zip(readers, self.labels, strict=True)]
        return every[: len(self.recordings)], every[len(self.recordings) :]

    def notes(self) -> tuple[str, ...]:
        """What reading each recording left out or put right, as it stands with the recording."""
        readers = zip((*self.recordings, *self.baselines), self.labels, strict=True)
        return tuple(
            f"{label}: {remark}" for r, label in readers if r.has(SUMMARY) for remark in _remarks(r.document(SUMMARY))
        )


def _remarks(summary: Mapping[str, Any]) -> list[str]:
    return [str(remark) for remark in summary.get("remarks", ())]


def choose(
    catalogue: JobCatalogue, artefacts: ArtefactStore, recordings: Sequence[str], baselines: Sequence[str]
) -> Chosen:
    """Find them; SpecError names every id that cannot be used, RecordingsNotReady those that are still being read."""
    problems = list(_repeated(recordings, baselines))
    waiting: list[tuple[str, JobRecord]] = []
    found: dict[str, list[ResultReader]] = {"recordings": [], "baselines": []}
    labels: list[str] = []
    for field, ids in (("recordings", recordings), ("baselines", baselines)):
        for place, identifier in enumerate(ids):
            record, reason = _looked_up(catalogue, identifier)
            if reason:
                problems.append(Problem(field=f"{field}.{place}", message=reason, given=identifier, allowed=USABLE))
            elif record is not None and record.status.active:
                waiting.append((f"{field}.{place}", record))
            elif record is not None and record.result is not None:
                found[field].append(ResultReader(artefacts, f"{identifier}/{record.result.attempt}"))
                labels.append(_label(record))
    if problems:
        raise SpecError(problems)
    if waiting:
        late = [
            Problem(field=field, message=f"is still being read ({r.status.value})", given=r.id, allowed=USABLE)
            for field, r in waiting
        ]
        raise RecordingsNotReady(waiting[0][1].id, waiting[0][1].status, late)
    chosen = Chosen(recordings=tuple(found["recordings"]), baselines=tuple(found["baselines"]), labels=tuple(labels))
    if chosen.samples > MOST_SAMPLES:
        message = "the recordings are too long together"
        allowed = f"<= {MOST_SAMPLES}"
        raise SpecError(
            Problem(field="recordings", message=message, given=chosen.samples, allowed=allowed, unit="samples")
        )
    return chosen


def _label(record: JobRecord) -> str:
    name = record.source.get("name")
    return f"{name} ({record.id})" if isinstance(name, str) and name else record.id


def _repeated(recordings: Sequence[str], baselines: Sequence[str]) -> Iterator[Problem]:
    seen: set[str] = set()
    for field, ids in (("recordings", recordings), ("baselines", baselines)):
        for place, identifier in enumerate(ids):
            if identifier in seen:
                message, allowed = "names a recording a second time", "each once, to explain or as baseline"
                yield Problem(field=f"{field}.{place}", message=message, given=identifier, allowed=allowed)
            seen.add(identifier)


def _looked_up(catalogue: JobCatalogue, identifier: str) -> tuple[JobRecord | None, str]:
    """The record, and why it cannot be used (empty: it can, or will be)."""
    try:
        record = catalogue.get(identifier)
    except UnknownJob:
        return None, "is not the id of a recording"
    if record.kind != RECORDING:
        return None, f"is the id of a {record.kind}, not of a recording"
    if record.gone is not None:
        return None, f"is a recording that was {record.gone}; send it again"
    if not record.status.active and record.status is not Status.SUCCESSFUL:
        why = f": {record.failure.message}" if record.failure is not None else ""
        refused = record.failure is not None and record.failure.code == "refused"
        word = "refused" if refused else record.status.value
        return None, f"is a recording that could not be read ({word}){why}"
    return record, ""
