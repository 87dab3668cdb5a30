"""A worker's view of the job that its child runs, and what it tells the catalogue."""

from __future__ import annotations

import contextlib
import logging
import os
import socket
import time
from enum import Enum

from jobs import recover, transitions
from jobs.atlas.words import PIECE
from jobs.errors import JobError, StaleAttempt, StoreAway
from jobs.reconciliations.words import RECONCILIATION
from jobs.record import Failure, JobRecord
from jobs.status import Status
from store.catalogue import workers as registry
from workers.context import Context

log = logging.getLogger(__name__)

REPORT_EVERY_S = 5.0


class Verdict(Enum):
    """What to do with the child."""

    GO_ON = "go on"
    CANCELLED = "cancelled, and it did not stop by itself"
    TAKEN_OVER = "another attempt took over"
    LEAVING = "the worker leaves"


class JobWatch:
    """Renews the lease, forces what does not stop by itself, and settles the job when its process died."""

    def __init__(self, context: Context) -> None:
        self._context = context
        self._catalogue = context.stores.catalogue
        self._started_at = time.time()
        self._job: tuple[str, int] | None = None
        self._handing_back = False
        self._renewed = self._reported = self._began_at = 0.0

    def begin(self, job_id: str, attempt: int) -> None:
        """A child started on this attempt."""
        self._job, self._handing_back = (job_id, attempt), False
        self._renewed, self._began_at = time.monotonic(), time.time()
        self.report("busy", force=True)

    def look(self, *, leaving: bool) -> Verdict:
        """Once a second while the child runs."""
        assert self._job is not None
        if leaving:
            self._handing_back = True
            return Verdict.LEAVING
        try:
            return self._judge(*self._job)
        except StaleAttempt:
            return Verdict.TAKEN_OVER
        except StoreAway as error:
            log.warning("the catalogue does not answer, the job goes on: %s", error)
            return Verdict.GO_ON

    def _judge(self, job_id: str, attempt: int) -> Verdict:
        record = self._catalogue.get(job_id)
        if record.attempt != attempt:
            return Verdict.TAKEN_OVER
        if record.status is not Status.RUNNING:
            return Verdict.GO_ON  # About to claim the job, or just done with it.
        if not self._mine(record):
            return Verdict.GO_ON  # The ticket was there twice: this child will see it and end.
        if record.cancel_requested_at is not None:
            over = time.time() - record.cancel_requested_at > self._context.settings.cancel_grace_s
            return Verdict.CANCELLED if over else Verdict.GO_ON
        if time.monotonic() - self._renewed >= self._context.settings.renew_s:
            self._renewed = time.monotonic()
            self._renew(record)
            if record.kind == RECONCILIATION:
                for piece in self._pieces():
                    with contextlib.suppress(StaleAttempt):
                        self._renew(piece)
        return Verdict.GO_ON

    def _renew(self, held: JobRecord) -> None:
        lease = self._context.settings.lease_s
        self._catalogue.change(
            held.id, lambda r: transitions.renew(r, attempt=held.attempt, lease_s=lease, now=time.time())
        )

    def _pieces(self) -> list[JobRecord]:
        """What the child took beside its job: pieces of an atlas that it leads."""
        return [
            held
            for held in self._catalogue.running_on(self._context.name)
            if held.kind == PIECE and (held.started_at or 0.0) >= self._began_at
        ]

    def ended(self, status: int | None) -> None:
        """The child is gone. If the catalogue still says running, it died without a word."""
        assert self._job is not None
        (job_id, attempt), self._job = self._job, None
        self.report("idle", force=True)
        try:
            record = self._catalogue.get(job_id)
            left = {piece.id: piece for piece in self._pieces()}
            if record.attempt == attempt and record.status is Status.RUNNING:
                if self._mine(record):
                    left[record.id] = record
            elif record.attempt == attempt and record.status is Status.ACCEPTED and status != os.EX_OK:
                # It died before it took the job: back to the outbox, handed over again by the next recovery.
                self._catalogue.change(job_id, lambda r: transitions.refill(r, time.time()))
            if left:
                self._settle(list(left.values()), status)
        except JobError as error:
            log.warning("job %s is left to its lease: %s", job_id, error)

    def _mine(self, record: JobRecord) -> bool:
        """Whether this worker's child took the job; another one has it when a ticket was delivered twice."""
        return record.worker == self._context.name

    def _settle(self, left: list[JobRecord], status: int | None) -> None:
        losses = self._context.settings.max_losses
        for record in left:
            if self._handing_back:
                recover.hand_back(self._catalogue, time.time, record)
            else:
                recover.give_up(self._catalogue, time.time, record, death(status), max_losses=losses)
        self.recover()

    def recover(self) -> None:
        """One pass of recovery."""
        try:
            recover.tick(self._context.desk(), max_losses=self._context.settings.max_losses)
        except JobError as error:
            log.warning("recovery put off: %s", error)

    def report(self, state: str, *, force: bool = False) -> None:
        """Write this worker's row, not too often."""
        now = time.monotonic()
        if not force and now - self._reported < REPORT_EVERY_S:
            return
        self._reported = now
        row = registry.WorkerReport(
            name=self._context.name,
            host=socket.gethostname(),
            pid=os.getpid(),
            state=state,
            job_id=self._job[0] if self._job else None,
            started_at=self._started_at,
            seen_at=time.time(),
        )
        try:
            registry.report(self._catalogue.engine, row)
        except StoreAway as error:
            log.warning("the catalogue does not answer: %s", error)

    def sign_off(self) -> None:
        """Remove this worker's row."""
        try:
            registry.forget(self._catalogue.engine, name=self._context.name)
        except StoreAway as error:
            log.warning("the catalogue does not answer: %s", error)


def death(status: int | None) -> Failure:
    """What the status of a child that was waited for says of its end."""
    code = None if status is None else os.waitstatus_to_exitcode(status)
    return recover.died("the process that ran the job", code)
