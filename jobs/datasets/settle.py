"""How a dataset stands follows from its parts: worked out anew whenever one of them may have changed."""

from __future__ import annotations

import logging
from dataclasses import replace

from jobs import transitions
from jobs.datasets import family
from jobs.datasets.words import ASSEMBLY, DATASET, PARTS, SHARD
from jobs.errors import IllegalTransition
from jobs.parts import Tally
from jobs.ports import Clock, JobCatalogue
from jobs.record import Failure, JobRecord, Progress
from jobs.status import Status

log = logging.getLogger(__name__)

SHARDS_END = 0.98
"""Share of the whole at which the shards are done."""
TELL_EVERY = 0.002
"""Least progress that is written: a history of hours must stay short enough to be replayed."""
LEAST_FOR_ETA = 0.01


def settle_all(catalogue: JobCatalogue, clock: Clock) -> list[JobRecord]:
    """`settle` of every dataset under way."""
    return [part for found in catalogue.parts.unfinished(DATASET) for part in settle(catalogue, clock, found)]


def settle_after(catalogue: JobCatalogue, clock: Clock, part: JobRecord) -> list[JobRecord]:
    """`settle` of the dataset that a part belongs to, if it is one."""
    parent = catalogue.parts.parent_of(part.id) if part.kind in PARTS else None
    return [] if parent is None else settle(catalogue, clock, parent)


def settle(catalogue: JobCatalogue, clock: Clock, dataset_id: str) -> list[JobRecord]:
    """Put a dataset where its parts say; returns what may now be handed to the broker.

    Safe to run in several processes at once and to be cut off anywhere: every step is one transaction of the
    catalogue, and the next run finds what is left to do.
    """
    record = catalogue.get(dataset_id)
    if not record.status.active:
        return []
    try:
        return _settled(catalogue, clock(), record)
    except IllegalTransition as error:
        log.info("another process settled the dataset: %s", error)
        return []


def _settled(catalogue: JobCatalogue, now: float, record: JobRecord) -> list[JobRecord]:
    if record.cancel_requested_at is not None:
        _stop(catalogue, now, record)
        return []
    tally = catalogue.parts.tally(record.id, record.started_at or now)
    if tally.of(SHARD, Status.FAILED) or tally.of(ASSEMBLY, Status.FAILED):
        _fail(catalogue, now, record)
        return []
    if tally.gone or tally.of(SHARD, Status.DISMISSED) or tally.of(ASSEMBLY, Status.DISMISSED):
        # A shard whose time ran out, or one that was stopped for a withdrawal that came before this attempt.
        catalogue.parts.change(record.id, lambda r: _mended(r, record.id, now))
        return []
    if tally.of(SHARD, Status.SUCCESSFUL) == shards_of(record):
        if tally.of(ASSEMBLY, Status.SUCCESSFUL):
            _succeed(catalogue, now, record)
            return []
        freed = catalogue.parts.change(record.id, lambda r: family.released(r, now) if r.kind == ASSEMBLY else r)
    else:
        freed = []
    if tally.of(SHARD, Status.RUNNING, Status.SUCCESSFUL):
        _tell(catalogue, now, record, tally)
    return freed


def shards_of(record: JobRecord) -> int:
    """How many shards a dataset has."""
    count = record.source["shards"]
    assert isinstance(count, int)
    return count


def _rows(record: JobRecord) -> int:
    count = record.source["rows"]
    assert isinstance(count, int)
    return count


def _mended(record: JobRecord, dataset_id: str, now: float) -> JobRecord:
    lost = record.gone is not None or record.status is Status.DISMISSED
    return family.revived(record, dataset_id, now) if lost else record


def _stop(catalogue: JobCatalogue, now: float, record: JobRecord) -> None:
    catalogue.parts.change(record.id, lambda r: family.stopped(r, now))
    if not catalogue.parts.of(record.id, Status.ACCEPTED, Status.RUNNING):
        catalogue.change(record.id, lambda r: transitions.dismiss(r, attempt=record.attempt, now=now))


def _fail(catalogue: JobCatalogue, now: float, record: JobRecord) -> None:
    part = catalogue.parts.of(record.id, Status.FAILED)[0]
    assert part.failure is not None
    catalogue.parts.change(record.id, lambda r: family.put_off(r, now))
    failure = told_of_part(part, part.failure)
    catalogue.change(
        record.id,
        lambda r: transitions.fail(family.begun(r, now), attempt=record.attempt, failure=failure, now=now),
    )


def told_of_part(part: JobRecord, failure: Failure) -> Failure:
    """A part's failure as its dataset tells it."""
    name = str(part.source.get("shard", "the description"))
    advice = f"{failure.advice}; what is finished is used again".removeprefix("; ")
    detail = {"part": part.id, "shard": name, **(failure.detail or {})}
    return replace(failure, message=f"{name}: {failure.message}", advice=advice, detail=detail)


def _succeed(catalogue: JobCatalogue, now: float, record: JobRecord) -> None:
    (assembly,) = [part for part in catalogue.parts.of(record.id, Status.SUCCESSFUL) if part.kind == ASSEMBLY]
    assert assembly.result is not None
    result = replace(assembly.result, attempt=record.attempt)
    catalogue.parts.change(record.id, family.kept)
    catalogue.change(
        record.id,
        lambda r: transitions.succeed(family.begun(r, now), attempt=record.attempt, result=result, now=now),
    )


def _tell(catalogue: JobCatalogue, now: float, record: JobRecord, tally: Tally) -> None:
    if record.status is Status.ACCEPTED:
        catalogue.change(record.id, lambda r: family.begun(r, now))
    total, done = shards_of(record), tally.of(SHARD, Status.SUCCESSFUL)
    running = [part.progress.fraction for part in catalogue.parts.of(record.id, Status.RUNNING) if part.kind == SHARD]
    share = (done + sum(running)) / total
    new = share - tally.kept / total
    elapsed_s = now - (record.started_at or now)
    eta_s = elapsed_s * (1.0 - share) / new if new > LEAST_FOR_ETA else None
    stage = "assembling" if done == total else f"making shards, {done} of {total} done"
    rate = new * _rows(record) / elapsed_s if eta_s is not None and elapsed_s > 0 else None
    progress = Progress(fraction=round(SHARDS_END * share, 4), stage=stage, eta_s=eta_s, rows_per_s=rate)
    was = record.progress
    if stage != was.stage or progress.fraction >= was.fraction + TELL_EVERY:
        catalogue.change(record.id, lambda r: family.told(r, record.attempt, progress, now))
