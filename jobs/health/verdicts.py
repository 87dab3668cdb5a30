"""The latest reconciliations that used recordings of a machine."""

from __future__ import annotations

from collections.abc import Iterator, Set
from dataclasses import dataclass

from jobs.ports import ArtefactStore, JobCatalogue, JobQuery
from jobs.reconciliations.words import RECONCILIATION
from jobs.record import JobRecord
from jobs.results import ResultReader
from jobs.status import Status

MOST_LOOKED_AT = 1000
_PAGE = 200


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """A reconciliation's answer; `recordings` and `baselines` are those of this machine that it used."""

    reconciliation: str
    finished: float
    verdict: str
    sentence: str
    level: str
    recordings: tuple[str, ...]
    baselines: tuple[str, ...]


def verdicts_of(
    catalogue: JobCatalogue, artefacts: ArtefactStore, recordings: Set[str], most: int
) -> tuple[Verdict, ...]:
    """The newest first, of the latest 1000 reconciliations; one whose result has expired says no more."""
    found: list[Verdict] = []
    for record in _records(catalogue) if recordings else ():
        explained, baselines = (_among(record, key, recordings) for key in ("recordings", "baselines"))
        if not explained and not baselines:
            continue
        found.append(_verdict(record, artefacts, explained, baselines))
        if len(found) == most:
            break
    return tuple(found)


def _records(catalogue: JobCatalogue) -> Iterator[JobRecord]:
    after: tuple[float, str] | None = None
    for _ in range(MOST_LOOKED_AT // _PAGE):
        query = JobQuery(statuses=(Status.SUCCESSFUL,), kind=RECONCILIATION, limit=_PAGE, after=after)
        records, _total = catalogue.query(query)
        yield from (record for record in records if record.gone is None and record.result is not None)
        if len(records) < _PAGE:
            return
        after = (records[-1].created_at, records[-1].id)


def _among(record: JobRecord, key: str, recordings: Set[str]) -> tuple[str, ...]:
    named = record.source.get(key)
    return tuple(name for name in named if name in recordings) if isinstance(named, list | tuple) else ()


def _verdict(
    record: JobRecord, artefacts: ArtefactStore, recordings: tuple[str, ...], baselines: tuple[str, ...]
) -> Verdict:
    assert record.result is not None
    summary = ResultReader(artefacts, f"{record.id}/{record.result.attempt}").document("summary")
    return Verdict(
        reconciliation=record.id,
        finished=record.finished_at or record.updated_at,
        verdict=str(summary["verdict"]),
        sentence=str(summary["sentence"]),
        level=str(summary["level"]),
        recordings=recordings,
        baselines=baselines,
    )
