"""The pieces of a round as its leading worker sees them: taken, fetched, and made once more where nobody does."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import islice
from typing import cast

from jobs import transitions
from jobs.accept import Desk, hand_over, ticket_of
from jobs.atlas.piece import Found, keep_piece, read_piece, timed
from jobs.errors import BrokerAway, JobError, StaleAttempt, StoreAway, UnknownArtefact
from jobs.record import JobRecord
from jobs.recover import reclaim
from jobs.status import Status
from reconcile.atlas.bank import Task

log = logging.getLogger(__name__)

WITH_BROKER = 32
"""Pieces handed to the broker ahead; the rest follows as they are taken."""
BROKER_AGAIN_S = 10.0
"""Wait before a broker that did not answer is asked again."""
LEASES, PATIENCE = 2.0, 4.0
"""A piece that another worker has had for so many leases, and so many times what it should take, is made here too."""

Heard = Callable[[int], None]
Stretch = tuple[int, int]


@dataclass(kw_only=True)
class Pieces:
    """`step` until `complete`, then `results`."""

    desk: Desk
    round_id: str
    tasks: Sequence[Task]
    worker: str
    lease_s: float
    max_losses: int
    began: float
    """What was made before costs this reconciliation nothing."""
    _found: dict[int, tuple[float, Found]] = field(default_factory=dict)
    """By task: processor seconds of other workers, and the result."""
    _unreadable: set[str] = field(default_factory=set)
    _broker_from: float = 0.0

    @property
    def done(self) -> int:
        """Tasks whose result is here."""
        return len(self._found)

    @property
    def complete(self) -> bool:
        """Whether every task's is."""
        return self.done == len(self.tasks)

    def results(self) -> list[tuple[float, Found]]:
        """In the order of the tasks."""
        return [self._found[k] for k in range(len(self.tasks))]

    def step(self, heard: Heard) -> bool:
        """Fetch what others made and make one piece here; False when all that is missing is being made elsewhere."""
        try:
            return self._step(heard)
        except StoreAway as error:
            log.warning("the next tasks are made here alone: %s", error)
            self._make_first(heard)
            return True

    def _step(self, heard: Heard) -> bool:
        fetched, missing = self._fetched()
        self._give_out(missing)
        mine = self._claimed(missing)
        if mine is not None:
            self._make_kept(mine, heard)
            return True
        if fetched or reclaim(self.desk.catalogue, self.desk.clock, max_losses=self.max_losses):
            return True
        alone = next((piece for piece in missing if self._nobody_makes(piece)), None)
        if alone is not None:
            self._make(stretch_of(alone), heard)
        elif not missing:
            self._make_first(heard)
        return alone is not None or not missing

    def _make_first(self, heard: Heard) -> None:
        """One task that is missing, whatever became of its piece."""
        first = next(k for k in range(len(self.tasks)) if k not in self._found)
        self._make((first, first + 1), heard)

    def _fetched(self) -> tuple[int, list[JobRecord]]:
        """How many pieces came from others, and those that are missing still."""
        fetched, missing = 0, []
        for piece in self.desk.catalogue.parts.of(self.round_id):
            first, last = stretch_of(piece)
            if all(k in self._found for k in range(first, last)):
                continue
            there = piece.status is Status.SUCCESSFUL and piece.gone is None and piece.id not in self._unreadable
            if there and self._read(piece):
                fetched += 1
            else:
                missing.append(piece)
        return fetched, missing

    def _read(self, piece: JobRecord) -> bool:
        first, last = stretch_of(piece)
        try:
            found = list(read_piece(self.desk.artefacts, piece, self.tasks[first:last]))
        except JobError as error:
            log.warning("piece %s is made again here: %s", piece.id, error)
            self._unreadable.add(piece.id)
            if isinstance(error, UnknownArtefact):
                now = self.desk.clock()
                self.desk.catalogue.change(piece.id, lambda r: transitions.delete(r, now))
            return False
        new = (piece.finished_at or 0.0) >= self.began
        for k, (seconds, one) in zip(range(first, last), found, strict=True):
            self._found[k] = seconds if new else 0.0, one
        return True

    def _give_out(self, missing: Sequence[JobRecord]) -> None:
        """From the front; this worker takes from the end."""
        if self.desk.clock() < self._broker_from:
            return
        waiting = [piece for piece in missing if piece.status is Status.ACCEPTED]
        room = WITH_BROKER - sum(piece.enqueued_at is not None for piece in waiting)
        for piece in islice((p for p in waiting if p.enqueued_at is None), max(room, 0)):
            after = hand_over(self.desk, piece)
            if after.status is Status.ACCEPTED and after.enqueued_at is None:
                self._broker_from = self.desk.clock() + BROKER_AGAIN_S
                return

    def _claimed(self, missing: Sequence[JobRecord]) -> JobRecord | None:
        now = self.desk.clock()
        for piece in reversed(missing):
            if piece.status is not Status.ACCEPTED:
                continue
            with contextlib.suppress(StaleAttempt):
                taken = self.desk.catalogue.change(
                    piece.id,
                    lambda r: transitions.start(
                        r, attempt=r.attempt, worker=self.worker, lease_s=self.lease_s, now=now
                    ),
                )
                with contextlib.suppress(BrokerAway):
                    self.desk.queue.withdraw(ticket_of(taken, self.desk.limits))
                return taken
        return None

    def _nobody_makes(self, piece: JobRecord) -> bool:
        """Failed, stopped, not readable, or with another worker for too long."""
        if piece.status is not Status.RUNNING:
            return piece.status is not Status.ACCEPTED
        patience_s = max(LEASES * self.lease_s, PATIENCE * piece.cost.seconds)
        return self.desk.clock() - (piece.started_at or 0.0) > patience_s

    def _make(self, stretch: Stretch, heard: Heard) -> tuple[float, list[Found]]:
        """Here, in this process, whose seconds are counted as its own."""
        seconds, several = 0.0, []
        for k in range(*stretch):
            heard(self.done)
            spent, found = timed(self.tasks[k])
            seconds += spent
            several.append(found)
            self._found[k] = 0.0, found
        return seconds, several

    def _make_kept(self, piece: JobRecord, heard: Heard) -> None:
        """A piece that this worker took: for a second reconciliation, or a second attempt, it lies in the store."""
        desk, attempt = self.desk, piece.attempt
        try:
            seconds, several = self._make(stretch_of(piece), heard)
            result = keep_piece(desk.artefacts, f"{piece.id}/{attempt}", attempt, several, seconds, desk.clock())
            now = desk.clock()
            desk.catalogue.change(piece.id, lambda r: transitions.succeed(r, attempt=attempt, result=result, now=now))
        except BaseException as error:
            now = desk.clock()
            with contextlib.suppress(JobError):
                desk.catalogue.change(piece.id, lambda r: transitions.release(r, attempt=attempt, now=now))
            if not isinstance(error, StaleAttempt | StoreAway) or not self._has(piece):
                raise
            log.warning("piece %s is known here only: %s", piece.id, error)

    def _has(self, piece: JobRecord) -> bool:
        return all(k in self._found for k in range(*stretch_of(piece)))


def stretch_of(piece: JobRecord) -> Stretch:
    """First task of a piece, and the one behind its last."""
    first, last = cast(list[int], piece.source["tasks"])
    return first, last
