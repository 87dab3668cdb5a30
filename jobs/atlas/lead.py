"""The worker that leads a round: gives its pieces to whoever is idle, makes pieces itself, never only waits."""

from __future__ import annotations

import contextlib
import json
import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from jobs import transitions
from jobs.accept import RESERVED_BYTES, Desk
from jobs.atlas import family
from jobs.atlas.divide import divided, draw_s
from jobs.atlas.document import round_document
from jobs.atlas.piece import plan_key
from jobs.atlas.pieces import Pieces
from jobs.atlas.settle import finish, leave
from jobs.atlas.words import METHOD_VERSION, PIECE, ROUND
from jobs.errors import JobError, StaleAttempt
from jobs.identity import job_id
from jobs.parts import Part
from jobs.record import Cost
from jobs.results import put_file
from reconcile.atlas.bank import Task
from reconcile.observe.statistics import Statistics
from sim.core.errors import SidebandError

log = logging.getLogger(__name__)

POLL_S = 0.2
"""Between two looks while all that is missing is being made by others."""
LEAST_PIECES = 2
"""Fewer are made at once where they are."""
MOST_DOCUMENT_BYTES = 16 * 2**20
"""Of the machines of a round; larger ones stay with their worker."""
MOST_FOUND_BYTES = 2**20
"""Of what one simulated machine showed: an upper figure, for the space that must be free."""

Heard = Callable[[int], None]
"""Told how many tasks are done; raises when the work is not wanted any more."""


@dataclass(frozen=True, kw_only=True)
class Lead:
    """A reconciliation under way, its worker's name, and how that worker's leases are."""

    desk: Desk
    reconciliation: str
    worker: str
    lease_s: float
    max_losses: int
    wait: Callable[[float], None]

    def shared(self, tasks: Sequence[Task], heard: Heard) -> list[tuple[float, list[Statistics | None]]] | None:
        """Seconds elsewhere and result of every task, in their order; None where it is not worth it or cannot be."""
        try:
            pieces = self._opened(tasks)
        except StaleAttempt:
            raise
        except (SidebandError, ValueError) as error:
            log.warning("not shared with other workers: %s", error)
            return None
        if pieces is None:
            return None
        try:
            while not pieces.complete:
                heard(pieces.done)
                if not pieces.step(heard):
                    self.wait(POLL_S)
        except StaleAttempt:
            raise  # The reconciliation has another attempt, which leads this round on.
        except BaseException:
            self._leave(pieces.round_id)
            raise
        self._finish(pieces.round_id)
        return pieces.results()

    def _opened(self, tasks: Sequence[Task]) -> Pieces | None:
        """The round of these tasks, begun or joined."""
        stretches = divided(tasks, seconds := draw_s(self.desk.engine, tasks[0]))
        if len(stretches) < LEAST_PIECES:
            return None
        document = round_document(tasks)
        text = json.dumps(document, allow_nan=False, separators=(",", ":")).encode()  # parameters keep their order
        needed = len(text) + RESERVED_BYTES + MOST_FOUND_BYTES * sum(len(task.draws) for task in tasks)
        free = self.desk.artefacts.free_bytes()
        if len(text) > MOST_DOCUMENT_BYTES or (free is not None and free < needed):
            log.warning("not shared with other workers: %d bytes of machines, %s bytes free", len(text), free)
            return None
        round_id = job_id(ROUND, document, METHOD_VERSION)
        put_file(self.desk.artefacts, plan_key(round_id), [text])
        began = self.desk.clock()
        self._put(round_id, tasks, stretches, seconds)
        return Pieces(
            desk=self.desk,
            round_id=round_id,
            tasks=tasks,
            worker=self.worker,
            lease_s=self.lease_s,
            max_losses=self.max_losses,
            began=began,
        )

    def _put(self, round_id: str, tasks: Sequence[Task], stretches: Sequence[tuple[int, int]], seconds: float) -> None:
        now = self.desk.clock()
        draws = [len(task.draws) for task in tasks]
        parts = []
        for first, last in stretches:
            count = sum(draws[first:last])
            request: dict[str, object] = {"round": round_id, "tasks": [first, last]}
            record = transitions.new(
                job_id=job_id(PIECE, request, METHOD_VERSION),
                kind=PIECE,
                submitter=round_id,
                source={**request, "machines": count},
                cost=Cost(steps=0, memory_bytes=0, seconds=seconds * count),
                now=now,
            )
            parts.append(Part(record=record, request=request))
        whole = transitions.new(
            job_id=round_id,
            kind=ROUND,
            submitter=self.reconciliation,
            source={"machines": sum(draws), "pieces": len(parts)},
            cost=Cost(steps=0, memory_bytes=0, seconds=seconds * sum(draws)),
            now=now,
        )
        self.desk.catalogue.parts.put(
            Part(record=family.begun(whole, now), request={}),
            lambda present: family.joined(present, self.reconciliation, now),
            parts,
            lambda piece: family.wanted(piece, round_id, now),
        )

    def _finish(self, round_id: str) -> None:
        """The pieces are kept a while, or stopped where some were made without them."""
        try:
            if not finish(self.desk.catalogue, self.desk.clock, round_id):
                self._leave(round_id)
        except JobError as error:
            log.warning("round %s is left to recovery: %s", round_id, error)

    def _leave(self, round_id: str) -> None:
        with contextlib.suppress(JobError):
            leave(self.desk.catalogue, self.desk.artefacts, self.desk.clock, round_id, [self.reconciliation])
