"""Getting at a finished job's result."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from app.state import AppState
from jobs.errors import JobGone, ResultNotReady
from jobs.results import FileEntry, ResultReader
from jobs.status import Status


@dataclass(frozen=True, kw_only=True)
class Stored:
    """A result that is there. `digest` names its bytes."""

    reader: ResultReader
    prefix: str
    digest: str

    def files(self) -> Iterator[tuple[str, FileEntry]]:
        """Names and sizes of the stored files."""
        yield from self.reader.manifest.files.items()


def stored(state: AppState, job_id: str) -> Stored:
    """The job's result; raises UnknownJob, JobGone or ResultNotReady."""
    record = state.stores.catalogue.get(job_id)
    if record.gone is not None:
        raise JobGone(job_id, record.gone)
    if record.status is not Status.SUCCESSFUL or record.result is None:
        raise ResultNotReady(job_id, record.status)
    prefix = f"{job_id}/{record.result.attempt}"
    return Stored(reader=ResultReader(state.stores.artefacts, prefix), prefix=prefix, digest=record.result.sha256)
