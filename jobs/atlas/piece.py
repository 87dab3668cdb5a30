"""Making a piece of a round: its tasks simulated, what they showed kept in the artefact store."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, cast

from jobs.atlas.document import from_bytes, made_by, restored_tasks, to_bytes
from jobs.atlas.words import KEPT_S
from jobs.datasets.shard import check_versions, json_loaded
from jobs.errors import UnknownArtefact
from jobs.ports import ArtefactStore, JobCatalogue
from jobs.record import JobRecord, ResultRef
from jobs.reporter import Reporter
from jobs.results import json_bytes, put_file
from jobs.status import Status
from reconcile.atlas.bank import Task, run_task
from reconcile.observe.statistics import Statistics
from sim.core.errors import Cancelled

Found = list[Statistics | None]
FOUND, COST = "found.npz", "cost.json"


def plan_key(round_id: str) -> str:
    """Where the machines of a round are written down."""
    return f"{round_id}/0/plan.json"


def make_piece(
    catalogue: JobCatalogue,
    artefacts: ArtefactStore,
    reporter: Reporter,
    request: Mapping[str, Any],
    *,
    prefix: str,
    attempt: int,
    now: Callable[[], float],
) -> ResultRef:
    """What a worker does with a piece; Cancelled when nobody wants the round any more, DatasetRefused when this worker
    would find other numbers than the rest."""
    if catalogue.get(request["round"]).status is not Status.RUNNING:
        raise Cancelled("the round ended")
    document = json_loaded(artefacts, plan_key(request["round"]))
    check_versions(document, made_by())
    tasks = restored_tasks(document, *request["tasks"])
    seconds, several = 0.0, []
    for done, task in enumerate(tasks):
        reporter.simulating(done / len(tasks))
        if reporter.cancelled():
            raise Cancelled("cancelled")
        spent, found = timed(task)
        seconds += spent
        several.append(found)
    return keep_piece(artefacts, prefix, attempt, several, seconds, now())


def timed(task: Task) -> tuple[float, Found]:
    """A task's result with the processor seconds it took."""
    begin = time.process_time()
    found = run_task(task)
    return time.process_time() - begin, found


def keep_piece(
    artefacts: ArtefactStore, prefix: str, attempt: int, several: Sequence[Found], seconds: float, now: float
) -> ResultRef:
    """The result's digest is that of the numbers; what they cost lies beside them."""
    numbers = put_file(artefacts, f"{prefix}/{FOUND}", [to_bytes([one for found in several for one in found])])
    cost = put_file(artefacts, f"{prefix}/{COST}", [json_bytes({"core_seconds": seconds})])
    size = numbers.bytes + cost.bytes
    return ResultRef(attempt=attempt, size_bytes=size, sha256=numbers.sha256, expires_at=now + KEPT_S)


def read_piece(artefacts: ArtefactStore, piece: JobRecord, tasks: Sequence[Task]) -> Iterator[tuple[float, Found]]:
    """What was kept, by task; the seconds stand at the first. UnknownArtefact when it is not there as it was kept."""
    result = cast(ResultRef, piece.result)
    prefix = f"{piece.id}/{result.attempt}"
    data = artefacts.read(f"{prefix}/{FOUND}")
    if hashlib.sha256(data).hexdigest() != result.sha256:
        raise UnknownArtefact("file", f"{prefix}/{FOUND}", ("other bytes than were kept",))
    seconds = float(json_loaded(artefacts, f"{prefix}/{COST}")["core_seconds"])
    draws = iter(from_bytes(data))
    for task in tasks:
        yield seconds, [next(draws) for _ in task.draws]
        seconds = 0.0
