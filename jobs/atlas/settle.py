"""Rounds that nobody wants any more are stopped, whatever became of the workers that led them."""

from __future__ import annotations

import contextlib
import logging
from collections.abc import Sequence

from jobs import transitions
from jobs.atlas import family
from jobs.atlas.words import ROUND
from jobs.datasets.family import kept, stopped
from jobs.errors import IllegalTransition, StaleAttempt, StoreAway, UnknownJob
from jobs.ports import ArtefactStore, Clock, JobCatalogue
from jobs.status import Status

log = logging.getLogger(__name__)


def settle_rounds(catalogue: JobCatalogue, artefacts: ArtefactStore, clock: Clock) -> None:
    """Take the reconciliations that ended out of their rounds; those that wait for another attempt stay.

    Safe in several processes at once and to be cut off anywhere: the next run finds what is left to do.
    """
    for round_id in catalogue.parts.unfinished(ROUND):
        over = [s for s in catalogue.get(round_id).submitters if not _wanted_by(catalogue, s)]
        leave(catalogue, artefacts, clock, round_id, over)


def finish(catalogue: JobCatalogue, clock: Clock, round_id: str) -> bool:
    """All pieces are there: they are kept for a while, as long as their round. False where some are not."""
    now, pieces = clock(), catalogue.parts.of(round_id)
    if any(piece.status is not Status.SUCCESSFUL or piece.gone is not None for piece in pieces):
        return False
    catalogue.parts.change(round_id, kept)
    catalogue.change(round_id, lambda r: family.all_there(r, pieces, now))
    return True


def leave(
    catalogue: JobCatalogue, artefacts: ArtefactStore, clock: Clock, round_id: str, leaving: Sequence[str]
) -> None:
    """Take reconciliations out of a round; the last one stops it, waiting pieces at once, running ones soon."""
    now = clock()
    try:
        record = catalogue.change(round_id, lambda r: family.left(r, leaving, now)) if leaving else None
        record = record or catalogue.get(round_id)
        if not record.status.active or record.cancel_requested_at is None:
            return
        catalogue.parts.change(round_id, lambda r: stopped(r, now))
        if not catalogue.parts.of(round_id, Status.ACCEPTED, Status.RUNNING):
            catalogue.change(round_id, lambda r: transitions.dismiss(r, attempt=record.attempt, now=now))
            with contextlib.suppress(StoreAway):
                artefacts.delete_prefix(f"{round_id}/")
    except (IllegalTransition, StaleAttempt) as error:
        log.info("another process settled the round: %s", error)


def _wanted_by(catalogue: JobCatalogue, job_id: str) -> bool:
    try:
        record = catalogue.get(job_id)
    except UnknownJob:
        return False
    return record.status.active and record.cancel_requested_at is None
