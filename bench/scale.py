"""`python -m bench.scale`: what sharing a dataset over workers costs beside its rows, in milliseconds each.

Catalogue: SQLite in a temporary folder (every write synchronised to the disk). Broker: the embedded one, on loopback.
"""

from __future__ import annotations

import itertools
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bench.process import ROOT
from jobs import transitions
from jobs.datasets.divide import divide, division_again
from jobs.datasets.request import DatasetRequest
from jobs.datasets.settle import settle
from jobs.datasets.words import DATASET, SHARD
from jobs.parts import Part
from jobs.physics import PhysicsEngine
from jobs.ports import Lane, Ticket
from jobs.record import Cost, JobRecord, Progress
from sideband_datasets.folder.layout import DATA, STATE
from sideband_datasets.folder.shards import make_shard
from sideband_datasets.recipe import recipe_named
from sideband_datasets.recipe.read import document_of
from store.catalogue import engine, schema
from store.catalogue.catalogue import SqlCatalogue
from store.queue.rq_queue import RqQueue, connect

PARTS, TICKETS, TIMES = 3000, 500, 100
LARGE = 100_000
"""Recordings of the plan that is divided."""
MANY, OF_MANY = 5000, 20_000
"""Machines, and recordings of them."""


def main() -> None:
    """Print a line a measurement, and one last line `SCALE {json}`."""
    found: dict[str, float] = {}
    for measure in (_catalogue, _broker, _plans, _shards):
        for name, milliseconds in measure():
            found[name] = round(milliseconds, 3)
            print(f"{name:56s}{milliseconds:10.2f} ms", flush=True)
    print(f"load of the machine: {os.getloadavg()[0]:.1f}")
    print("SCALE", json.dumps(found))


def _ms(action: Callable[[], object], times: int = 1) -> float:
    begin = time.perf_counter()
    for _ in range(times):
        action()
    return (time.perf_counter() - begin) * 1e3 / times


def _record(job_id: str, kind: str) -> Part:
    source = {"shards": PARTS, "name": "bench"}
    cost = Cost(steps=0, memory_bytes=0, seconds=1.0)
    record = transitions.new(job_id=job_id, kind=kind, submitter="bench", source=source, cost=cost, now=1.0)
    return Part(record=record, request={})


def _catalogue() -> Iterator[tuple[str, float]]:
    with tempfile.TemporaryDirectory() as folder:
        database = engine.connect(f"sqlite:///{Path(folder) / 'c.sqlite'}")
        schema.create_schema(database)
        catalogue = SqlCatalogue(database)
        parts = [_record(f"s{k}", SHARD) for k in range(PARTS)]
        insert = _ms(lambda: catalogue.parts.put(_record("d", DATASET), _same, parts, _same))
        yield "catalogue: accept, a shard", insert / PARTS
        ids = (part.record.id for part in parts)
        yield "catalogue: take a shard", _ms(lambda: _take(catalogue, next(ids)), TIMES)
        fractions = itertools.count(1)
        yield "catalogue: report progress", _ms(lambda: _report(catalogue, next(fractions) / 1e3), TIMES)
        yield "catalogue: look whether to go on", _ms(lambda: catalogue.get("s0"), TIMES)
        yield f"catalogue: settle {PARTS} shards", _ms(lambda: settle(catalogue, time.time, "d"), 10)
        database.dispose()


def _same(record: JobRecord) -> JobRecord:
    return record


def _take(catalogue: SqlCatalogue, job_id: str) -> None:
    catalogue.change(job_id, lambda r: transitions.start(r, attempt=1, worker="w", lease_s=30, now=2.0))


def _report(catalogue: SqlCatalogue, fraction: float) -> None:
    progress = Progress(fraction=fraction, stage="simulating")
    catalogue.change("s0", lambda r: transitions.advance(r, attempt=1, progress=progress, lease_s=30, now=2.0))


@contextmanager
def _queue() -> Iterator[RqQueue]:
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "workers.broker", folder]
        pipe = subprocess.PIPE
        guard = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True, cwd=ROOT)
        assert guard.stdin is not None and guard.stdout is not None
        try:
            yield RqQueue(connect(json.loads(guard.stdout.readline())["url"]))
        finally:
            guard.stdin.close()
            guard.wait(20)
            guard.stdout.close()


def _broker() -> Iterator[tuple[str, float]]:
    with _queue() as queue:
        tickets = [Ticket(job_id=f"s{k}", attempt=1, timeout_s=60, lane=Lane.BULK) for k in range(TICKETS)]
        given, asked = iter(tickets), iter(tickets)
        yield "broker: hand over a ticket", _ms(lambda: queue.submit(next(given)), TICKETS)
        yield "broker: ask for a ticket", _ms(lambda: queue.holds(next(asked)), TICKETS)


def _request(count: int, shard: int, *, name: str = "small", machines: int | None = None) -> DatasetRequest:
    recipe: dict[str, Any] = {**document_of(recipe_named(name)), "count": count}
    if machines is not None:
        recipe["machines"] = [{**recipe["machines"][0], "instances": machines}]
    return DatasetRequest(recipe=recipe, format="parquet", shard_recordings=shard)


def _plans() -> Iterator[tuple[str, float]]:
    """Each accepted, then planned again as every shard does."""
    for name, count, machines in (("small", LARGE, 8), ("small", OF_MANY, MANY), ("bearing-rig", OF_MANY, MANY)):
        request = _request(count, 100, name=name, machines=machines)
        document = request.model_dump()
        what = f"{name}, {count} of {machines} machines"
        yield f"accept {what}", _ms(lambda asked=request: divide(asked))  # type: ignore[misc]
        yield f"plan a shard: {what}", _ms(lambda kept=document: division_again(kept))  # type: ignore[misc]


def _shards() -> Iterator[tuple[str, float]]:
    """Two shards of different size, each in a process forked from a warm one, as workers do; what both have besides."""
    PhysicsEngine().warm()
    _forked(8)
    small, large = min(_forked(8) for _ in range(3)), min(_forked(64) for _ in range(3))
    each = (large - small) / 56
    yield "shard: a recording of `small`", each
    yield "shard: besides", small - 8 * each


def _forked(recordings: int) -> float:
    def run() -> None:
        child = os.fork()
        if child == 0:
            _one_shard(recordings)
            os._exit(0)
        _, status = os.waitpid(child, 0)
        assert status == 0

    return _ms(run)


def _one_shard(recordings: int) -> None:
    request = _request(2 * recordings, recordings)
    plan, shards = division_again(divide(request).document)
    with tempfile.TemporaryDirectory() as name:
        for inner in (DATA, STATE):
            (Path(name) / inner).mkdir()
        largest = max(shards, key=lambda shard: len(shard.recordings))
        make_shard(plan, largest, Path(name), "parquet")


if __name__ == "__main__":
    main()
