"""Steps of a round and its pieces, as pure functions of the record and the time, beside those of `jobs.transitions`.

The submitters of a round are the reconciliations that want it: it goes on as long as there is one.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

from jobs import transitions
from jobs.atlas.words import KEPT_S, PIECE, ROUND
from jobs.errors import IllegalTransition
from jobs.record import JobRecord, ResultRef
from jobs.status import Status


def joined(record: JobRecord, reconciliation: str, now: float) -> JobRecord:
    """A reconciliation wants a round that is there; a new attempt where that one ended without all its pieces."""
    if record.status is Status.RUNNING and reconciliation in record.submitters:
        return record
    return begun(transitions.submit_again(record, reconciliation, now), now)


def begun(record: JobRecord, now: float) -> JobRecord:
    """A round has no ticket and no worker: it runs as soon as it is there."""
    if record.status is not Status.ACCEPTED:
        return record
    return replace(record, status=Status.RUNNING, started_at=now, updated_at=now)


def wanted(piece: JobRecord, round_id: str, now: float) -> JobRecord:
    """A piece that is not there is made: in a new attempt of its round, or when its time ran out."""
    lost = piece.gone is not None or piece.status in (Status.DISMISSED, Status.FAILED)
    stopping = piece.status is Status.RUNNING and piece.cancel_requested_at is not None
    return transitions.restart(piece, round_id, now) if lost or stopping else piece


def left(record: JobRecord, leaving: Collection[str], now: float) -> JobRecord:
    """These reconciliations do not want the round any more; without any it is to stop."""
    return transitions.withdraw(record, leaving, now) if record.status is Status.RUNNING else record


def all_there(record: JobRecord, pieces: Collection[JobRecord], now: float) -> JobRecord:
    """The last piece was made; what the pieces hold is kept for a while."""
    if record.status is not Status.RUNNING:
        return record
    size = sum(piece.result.size_bytes for piece in pieces if piece.result is not None)
    result = ResultRef(attempt=record.attempt, size_bytes=size, sha256="", expires_at=now + KEPT_S)
    return transitions.succeed(record, attempt=record.attempt, result=result, now=now)


def refuse_inner(record: JobRecord) -> None:
    """Raise IllegalTransition for what belongs to reconciliations: nobody else decides over it."""
    if record.kind in (ROUND, PIECE):
        raise IllegalTransition(f"job {record.id} is work of reconciliations; ask that of them")
