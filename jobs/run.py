"""What a worker does with a ticket: take the job, simulate, analyse, store, report."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from jobs import transitions
from jobs.accept import KIND, Desk
from jobs.atlas.lead import Lead
from jobs.atlas.piece import make_piece
from jobs.atlas.words import PIECE
from jobs.carry_out import carry_out, completed
from jobs.datasets.assemble import assemble_dataset
from jobs.datasets.shard import make_part
from jobs.datasets.words import ASSEMBLY, SHARD
from jobs.errors import DatasetRefused, NotReconcilable, RecordingRefused, StaleAttempt, StoreAway, StoreFull
from jobs.kinds import lane_of
from jobs.ports import Analyser, ArtefactStore, Clock, Engine, JobCatalogue, Lane
from jobs.reconciliations.carry_out import reconcile_stored
from jobs.reconciliations.words import RECONCILIATION
from jobs.record import Failure, JobRecord, ResultRef
from jobs.recordings.read import read_upload
from jobs.recordings.words import RECORDING
from jobs.reporter import Reporter
from jobs.resolve import restored
from jobs.results import plain, write_result
from reconcile.atlas.keep import Forgetful, Keeper
from sim.core.errors import Cancelled, Diverged, Meaningless, SpecError

log = logging.getLogger(__name__)

FULL_DELAY_S = 30.0
"""Wait before a job is tried again after the disk was full."""


@dataclass(frozen=True, kw_only=True)
class Bench:
    """What a worker works with. `timeouts` are the exceptions by which the host ends a job that takes too long."""

    catalogue: JobCatalogue
    artefacts: ArtefactStore
    engine: Engine
    analyse: Analyser
    clock: Clock
    lease_s: float = 30.0
    max_losses: int = 2
    keep_s: float | None = 30 * 86400.0
    timeouts: tuple[type[BaseException], ...] = ()
    keeper: Keeper = field(default_factory=Forgetful)
    """Where the atlases of reconciliations are kept between jobs."""
    desk: Desk | None = None
    """For giving parts of a reconciliation to other workers; without it a worker carries it out alone."""

    def expires_at(self) -> float | None:
        """When a result that is stored now is not kept any longer."""
        return None if self.keep_s is None else self.clock() + self.keep_s


def run(bench: Bench, job_id: str, attempt: int, worker: str) -> JobRecord | None:
    """Carry out one attempt; returns how the job stands then, None when the ticket was stale.

    No error of the job leaves this function: the worker goes on.
    """
    try:
        now = bench.clock()
        record = bench.catalogue.change(
            job_id, lambda r: transitions.start(r, attempt=attempt, worker=worker, lease_s=bench.lease_s, now=now)
        )
    except StaleAttempt as error:
        log.debug("ticket ignored: %s", error)
        return None
    try:
        return _work(bench, record)
    except StaleAttempt as error:
        log.warning("attempt given up: %s", error)
        return None


def _work(bench: Bench, record: JobRecord) -> JobRecord:
    job_id, attempt = record.id, record.attempt
    reporter = Reporter(
        bench.catalogue,
        bench.clock,
        job_id=job_id,
        attempt=attempt,
        lease_s=bench.lease_s,
        seldom=lane_of(record.kind) is not Lane.WHOLE,
    )
    now = bench.clock
    try:
        reference = _KINDS[record.kind](bench, reporter, job_id, attempt)
        return bench.catalogue.change(
            job_id, lambda r: transitions.succeed(r, attempt=attempt, result=reference, now=now())
        )
    except StaleAttempt:
        raise
    except Cancelled:
        reporter.raise_if_stale()
        return bench.catalogue.change(job_id, lambda r: transitions.dismiss(r, attempt=attempt, now=now()))
    except StoreFull as error:
        bench.artefacts.delete_prefix(f"{job_id}/{attempt}/")
        failure = Failure(code="store-full", message=str(error), advice="free space on the server, then submit again")
        return bench.catalogue.change(
            job_id,
            lambda r: transitions.lose(
                r, attempt=attempt, failure=failure, max_losses=bench.max_losses, delay_s=FULL_DELAY_S, now=now()
            ),
        )
    except Exception as error:
        failure = failure_of(error, bench.timeouts)
        log.warning("job %s failed: %s", job_id, failure.message, exc_info=failure.code == "internal")
        return bench.catalogue.change(
            job_id, lambda r: transitions.fail(r, attempt=attempt, failure=failure, now=now())
        )


def _simulated(bench: Bench, reporter: Reporter, job_id: str, attempt: int) -> ResultRef:
    machine, request = restored(bench.catalogue.request_of(job_id))
    outcome = carry_out(bench.engine, machine, request, progress=reporter.simulating, cancelled=reporter.cancelled)
    response = outcome.response
    reporter.stage("analysing", 0.85)
    documents = bench.analyse(response, discard_transient=request.discard_transient)
    documents = completed(documents, outcome.extras)
    reporter.stage("storing", 0.95)
    return write_result(
        bench.artefacts,
        f"{job_id}/{attempt}",
        attempt=attempt,
        response=response,
        documents=documents,
        expires_at=bench.expires_at(),
    )


def _recorded(bench: Bench, reporter: Reporter, job_id: str, attempt: int) -> ResultRef:
    name = str(bench.catalogue.get(job_id).source.get("name", ""))
    return read_upload(bench.artefacts, reporter, bench.catalogue.request_of(job_id), job_id, attempt, name)


def _reconciled(bench: Bench, reporter: Reporter, job_id: str, attempt: int) -> ResultRef:
    worker = bench.catalogue.get(job_id).worker
    lead = None
    if bench.desk is not None and worker is not None:
        lead = Lead(
            desk=bench.desk,
            reconciliation=job_id,
            worker=worker,
            lease_s=bench.lease_s,
            max_losses=bench.max_losses,
            wait=time.sleep,
        )
    return reconcile_stored(
        bench.catalogue,
        bench.artefacts,
        bench.keeper,
        reporter,
        bench.catalogue.request_of(job_id),
        prefix=f"{job_id}/{attempt}",
        attempt=attempt,
        expires_at=bench.expires_at,
        lead=lead,
    )


def _pieced(bench: Bench, reporter: Reporter, job_id: str, attempt: int) -> ResultRef:
    return make_piece(
        bench.catalogue,
        bench.artefacts,
        reporter,
        bench.catalogue.request_of(job_id),
        prefix=f"{job_id}/{attempt}",
        attempt=attempt,
        now=bench.clock,
    )


def _sharded(bench: Bench, reporter: Reporter, job_id: str, attempt: int) -> ResultRef:
    return make_part(
        bench.catalogue,
        bench.artefacts,
        reporter,
        bench.catalogue.request_of(job_id),
        prefix=f"{job_id}/{attempt}",
        attempt=attempt,
        expires_at=bench.expires_at,
    )


def _assembled(bench: Bench, reporter: Reporter, job_id: str, attempt: int) -> ResultRef:
    return assemble_dataset(
        bench.catalogue,
        bench.artefacts,
        reporter,
        bench.catalogue.request_of(job_id),
        attempt=attempt,
        expires_at=bench.expires_at,
    )


_KINDS: Mapping[str, Callable[[Bench, Reporter, str, int], ResultRef]] = {
    KIND: _simulated,
    RECORDING: _recorded,
    RECONCILIATION: _reconciled,
    PIECE: _pieced,
    SHARD: _sharded,
    ASSEMBLY: _assembled,
}
"""How each kind of job comes to its result."""


_WRONG: Mapping[type[BaseException], tuple[str, str]] = {
    RecordingRefused: ("refused", "change the fields named, or send a file that is whole"),
    DatasetRefused: ("not-makeable", "change what is named, then submit again"),
    NotReconcilable: ("not-reconcilable", "change the fields named, or choose other recordings"),
}
"""Code and advice of what the sender can put right."""


def _unusable(error: Diverged | Meaningless) -> Failure:
    """A run that left all bounds, or whose numbers mean nothing."""
    if isinstance(error, Meaningless):
        detail: dict[str, object] = {"reasons": [*error.reasons]}
        return Failure(code="meaningless", message=error.what, advice=error.advice, detail=detail)
    detail = {"time_s": float(f"{error.time_s:.6g}"), "dof": error.dof}
    return Failure(code="diverged", message=error.what, advice=error.advice, detail=detail)


def failure_of(error: BaseException, timeouts: tuple[type[BaseException], ...]) -> Failure:
    """How an error is told to the person who asked; no traceback, no paths."""
    if isinstance(error, Diverged | Meaningless):
        return _unusable(error)
    if isinstance(error, SpecError | RecordingRefused | NotReconcilable | DatasetRefused):
        code, advice = _WRONG.get(type(error), ("invalid-machine", "change the fields named"))
        errors = [plain(problem.to_dict()) for problem in error.problems]
        return Failure(code=code, message=str(error), advice=advice, detail={"errors": errors})
    if isinstance(error, MemoryError):
        return Failure(code="out-of-memory", message="memory ran out", advice="shorten the run or ask fewer channels")
    if isinstance(error, timeouts):
        return Failure(code="timeout", message="the job took longer than allowed", advice="shorten the run")
    if isinstance(error, StoreAway):
        return Failure(code="store-away", message="the result could not be stored", advice="submit again later")
    return Failure(
        code="internal",
        message=f"an unexpected error ({type(error).__name__}) ended the job; the server's log has the details",
        advice="report it with the job's id",
    )
