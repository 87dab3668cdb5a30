"""Keeping the promise that nothing accepted is lost: the world is compared with the catalogue and put right."""

from __future__ import annotations

import logging
import signal
from dataclasses import dataclass

from jobs import transitions
from jobs.accept import Desk, hand_over, ticket_of
from jobs.atlas.settle import settle_rounds
from jobs.control import expire_results
from jobs.datasets.settle import settle_all
from jobs.errors import BrokerAway, IllegalTransition
from jobs.kinds import lane_of
from jobs.parts import Transition
from jobs.ports import Clock, JobCatalogue, Lane
from jobs.record import Failure, JobRecord

log = logging.getLogger(__name__)

BATCH = 500
ADVICE = "submit again; if it repeats, shorten the run: the process may have been killed for its memory"


def died(who: str, exit_code: int | None) -> Failure:
    """A process that ended without a word. `exit_code` as `subprocess` has it: negative is a signal."""
    if exit_code is not None and exit_code < 0:
        how = f"was killed by signal {_signal_name(-exit_code)}"
    else:
        how = "ended without a word" + (f" (exit code {exit_code})" if exit_code else "")
    return Failure(code="worker-lost", message=f"{who} {how}", advice=ADVICE)


def _signal_name(number: int) -> str:
    try:
        return signal.Signals(number).name
    except ValueError:
        return str(number)


def silent(record: JobRecord) -> Failure:
    """A worker that was not heard of for longer than its lease; what became of it nobody saw."""
    message = (
        f"the worker {record.worker} that ran the job was not heard of any more: it was killed from outside, its "
        "machine stopped, or it cannot reach the catalogue"
    )
    return Failure(code="worker-lost", message=message, advice=ADVICE)


@dataclass(frozen=True, kw_only=True)
class Recovered:
    """What one pass put right."""

    handed_over: int
    refilled: int
    reclaimed: int
    expired: int


def tick(desk: Desk, *, max_losses: int) -> Recovered:
    """One pass: lapsed leases, the outbox, a broker that forgot, results past their time.

    Safe to run in several processes at once: every step is one catalogue transaction, and a job handed over
    twice is taken once.
    """
    reclaimed = reclaim(desk.catalogue, desk.clock, max_losses=max_losses)
    expired = expire_results(desk.catalogue, desk.artefacts, desk.clock)
    settle_all(desk.catalogue, desk.clock)
    settle_rounds(desk.catalogue, desk.artefacts, desk.clock)
    try:
        desk.queue.ping()
        refilled = refill(desk)
        handed = sum(hand_over(desk, record).enqueued_at is not None for record in due(desk))
    except BrokerAway as error:
        log.warning("the broker is away: %s", error)
        refilled = handed = 0
    return Recovered(handed_over=handed, refilled=refilled, reclaimed=reclaimed, expired=expired)


def due(desk: Desk) -> list[JobRecord]:
    """What the broker should be given now: parts of other jobs only as many as keep its queue within a batch."""
    found = desk.catalogue.outbox(desk.clock(), BATCH)
    room = max(0, BATCH - desk.queue.length())
    waits = [record for record in found if lane_of(record.kind) is not Lane.WHOLE]
    return [record for record in found if lane_of(record.kind) is Lane.WHOLE] + waits[:room]


def refill(desk: Desk) -> int:
    """Put jobs that the broker should hold but does not back into the outbox."""
    missing = [r for r in desk.catalogue.enqueued(BATCH) if not desk.queue.holds(ticket_of(r, desk.limits))]
    for record in missing:
        desk.catalogue.change(record.id, lambda r: transitions.refill(r, desk.clock()))
    return len(missing)


def reclaim(catalogue: JobCatalogue, clock: Clock, *, max_losses: int) -> int:
    """Take back jobs whose worker has not been heard of within its lease."""
    now = clock()

    def lapsed(record: JobRecord) -> JobRecord:
        return transitions.lapse(record, attempt=record.attempt, failure=silent(record), max_losses=max_losses, now=now)

    return sum(_changed(catalogue, record, lapsed) for record in catalogue.lapsed(now, BATCH))


def give_up(catalogue: JobCatalogue, clock: Clock, record: JobRecord, failure: Failure, *, max_losses: int) -> bool:
    """The attempt is dead: another one, or failed when it died too often. False when it was not dead after all."""
    now = clock()
    return _changed(
        catalogue,
        record,
        lambda r: transitions.lose(
            r, attempt=record.attempt, failure=failure, max_losses=max_losses, delay_s=0.0, now=now
        ),
    )


def hand_back(catalogue: JobCatalogue, clock: Clock, record: JobRecord) -> bool:
    """The worker shuts down before the attempt is done: the job waits for another; this does not count as a loss."""
    now = clock()
    return _changed(catalogue, record, lambda r: transitions.release(r, attempt=record.attempt, now=now))


def release_worker(
    catalogue: JobCatalogue, clock: Clock, worker: str, *, failure: Failure | None, max_losses: int
) -> int:
    """Take back the jobs of a worker that is known to be gone: dead of `failure`, or shut down (None)."""
    return sum(
        hand_back(catalogue, clock, record)
        if failure is None
        else give_up(catalogue, clock, record, failure, max_losses=max_losses)
        for record in catalogue.running_on(worker)
    )


def _changed(catalogue: JobCatalogue, record: JobRecord, transition: Transition) -> bool:
    try:
        after = catalogue.change(record.id, transition)
    except IllegalTransition:
        return False
    log.warning("job %s: attempt %d ended without a result, now %s", record.id, record.attempt, after.status.value)
    return True
