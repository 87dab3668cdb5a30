"""Accepting a dataset: checked, and durable with all its parts before the reply."""

from __future__ import annotations

from itertools import islice

from jobs import transitions
from jobs.accept import RESERVED_BYTES, Acceptance, Desk, charged, hand_over, needs_work, replayed, reserve
from jobs.datasets import family
from jobs.datasets.divide import Division, divide, recipe_of
from jobs.datasets.planning import planning
from jobs.datasets.request import DatasetRequest
from jobs.datasets.words import ASSEMBLY, DATASET, METHOD_VERSION, SHARD
from jobs.errors import QueueFull, StoreFull
from jobs.identity import digest, job_id
from jobs.limits import Limits
from jobs.parts import Part
from jobs.record import Cost
from jobs.status import Status
from sideband_datasets.plan import least_bytes
from sim.core.errors import Problem, SpecError

AT_ONCE = 32
"""Shards that are handed to the broker before the reply; the rest follows in the next seconds."""

COPIES = 2
"""Of the rows of a shard, held while it is written in a format of arrays; the others hold less."""


def accept_dataset(desk: Desk, request: DatasetRequest, *, submitter: str, scope: str, key: str | None) -> Acceptance:
    """Accept a request for `submitter`; `scope` is whose idempotency keys these are.

    A dataset that failed or was cancelled is taken up where it stopped: finished shards are not made again.
    """
    body = digest({"kind": DATASET, **request.model_dump(mode="json")})
    if key is not None:
        earlier = replayed(desk, scope, key, body)
        if earlier is not None:
            return earlier
    with planning():
        division = divided(request, desk.limits)
    identifier = job_id(DATASET, division.document, f"{desk.engine.version} {METHOD_VERSION}")
    new_work = needs_work(desk.catalogue, identifier)
    if new_work:
        _check_room(desk, division)
    now = desk.clock()
    with charged(desk, identifier, division.cost.core_seconds if new_work else None):
        if key is not None:
            reserve(desk, scope, key, body, identifier)
        record, created = desk.catalogue.parts.put(
            _parent(division, identifier, submitter, now),
            lambda present: family.again(present, submitter, now),
            _parts(division, identifier, now),
            lambda part: family.revived(part, identifier, now),
        )
    if record.status is Status.ACCEPTED:
        waiting = (part for part in desk.catalogue.parts.of(identifier, Status.ACCEPTED) if part.kind == SHARD)
        for part in islice(waiting, AT_ONCE):
            hand_over(desk, part)
    return Acceptance(record=record, created=created, replayed=False)


def divided(request: DatasetRequest, limits: Limits) -> Division:
    """What the request asks for, divided; SpecError for what is beyond this server's bounds.

    A size that its numbers alone put beyond them is refused before any machine is built, and then alone.
    """
    recipe = recipe_of(request)
    problem = _too_large(recipe.count, least_bytes(recipe), limits)
    if problem is not None:
        raise SpecError(problem)
    division = divide(request)
    check_bounds(division, limits)
    return division


def check_bounds(division: Division, limits: Limits) -> None:
    """Refuse what is beyond this server's bounds, every broken one named."""
    cost = division.cost
    hours = cost.core_seconds / 3600.0
    long = _beyond("would take too long to compute", cost.recordings, hours, limits.dataset_core_hours, "core-hours")
    found = (long, _too_large(cost.recordings, cost.bytes, limits))
    problems = [problem for problem in found if problem is not None]
    problems += _memory_problems(division, limits)
    if problems:
        raise SpecError(problems)


def _too_large(recordings: int, size: int, limits: Limits) -> Problem | None:
    return _beyond("would be too large", recordings, size, limits.dataset_bytes, "bytes")


def _beyond(message: str, recordings: int, needed: float, bound: float, unit: str) -> Problem | None:
    if needed <= bound:
        return None
    return Problem(
        field="recipe.count",
        message=f"{message} (estimated {needed:.3g} {unit})",
        given=recordings,
        allowed=f"<= {bound:g}",
        unit=unit,
    )


def _memory_problems(division: Division, limits: Limits) -> list[Problem]:
    """Of a worker with the largest shard."""
    needed = COPIES * division.shard_bytes
    if needed <= limits.memory_bytes:
        return []
    fit = limits.memory_bytes * division.shard_most // needed
    message = f"makes shards that need too much memory (estimated {needed:.3g} bytes, {limits.memory_bytes:g} allowed)"
    allowed = f"<= {fit}" if fit else "recordings with fewer or shorter windows"
    return [Problem(field="shard_recordings", message=message, given=division.shard_recordings, allowed=allowed)]


def _check_room(desk: Desk, division: Division) -> None:
    desk.queue.ping()
    under_way = len(desk.catalogue.parts.unfinished(DATASET))
    if under_way >= desk.limits.datasets:
        raise QueueFull(under_way, desk.limits.datasets, retry_after_s=60)
    needed, free = division.cost.bytes + RESERVED_BYTES, desk.artefacts.free_bytes()
    if free is not None and free < needed:
        raise StoreFull(f"the dataset needs about {needed} bytes of space, {free} are free")


def _parent(division: Division, identifier: str, submitter: str, now: float) -> Part:
    recipe, cost = division.plan.recipe, division.cost
    source = {
        "name": recipe.name,
        "format": division.format,
        "seed": recipe.seed,
        "recordings": cost.recordings,
        "rows": cost.rows,
        "bytes": cost.bytes,
        "classes": list(recipe.classes),
        "shards": len(division.shards),
        "shard_recordings": division.shard_recordings,
    }
    record = transitions.new(
        job_id=identifier, kind=DATASET, submitter=submitter, source=source, cost=_cost(division, 1.0), now=now
    )
    return Part(record=family.held(record), request=division.document)


def _parts(division: Division, identifier: str, now: float) -> list[Part]:
    """The shards in their order, then the assembly."""
    parts = []
    for number, shard in enumerate(division.shards):
        share = len(shard.recordings) / division.plan.recipe.count
        source = {"dataset": identifier, "shard": shard.name, "recordings": len(shard.recordings)}
        request: dict[str, object] = {"dataset": identifier, "shard": number}
        record = transitions.new(
            job_id=job_id(SHARD, request, METHOD_VERSION),
            kind=SHARD,
            submitter=identifier,
            source=source,
            cost=_cost(division, share),
            now=now,
        )
        parts.append(Part(record=record, request=request))
    request = {"dataset": identifier}
    last = transitions.new(
        job_id=job_id(ASSEMBLY, request, METHOD_VERSION),
        kind=ASSEMBLY,
        submitter=identifier,
        source=dict(request),
        cost=Cost(steps=0, memory_bytes=0, seconds=1.0),
        now=now,
    )
    return [*parts, Part(record=family.held(last), request=request)]


def _cost(division: Division, share: float) -> Cost:
    """Of a share of the recordings; memory is that of a worker with the largest shard."""
    return Cost(steps=0, memory_bytes=COPIES * division.shard_bytes, seconds=share * division.cost.core_seconds)
