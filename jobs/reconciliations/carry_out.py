"""What a worker does with a reconciliation: loads the recordings, runs the engine, keeps report, page and machine."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from jobs.atlas.lead import Lead
from jobs.errors import NotReconcilable
from jobs.ports import ArtefactStore, JobCatalogue
from jobs.reconciliations.chosen import choose
from jobs.reconciliations.machine import restored_known
from jobs.reconciliations.pace import Pace
from jobs.reconciliations.request import ReconciliationRequest
from jobs.reconciliations.words import MACHINE, PAGE, REPORT
from jobs.record import Answer, ResultRef
from jobs.reporter import Reporter
from jobs.results import Manifest, json_bytes, put_file
from reconcile.atlas.bank import Task, run_task
from reconcile.atlas.keep import Keeper
from reconcile.entry import reconcile_recordings
from reconcile.kinematics import KinematicSpec
from reconcile.machine.budget import BUDGETS
from reconcile.machine.meter import Timed
from reconcile.report import page, strict_json
from reconcile.report.words import cause_key
from reconcile.verdict import Report
from sim.core.errors import Cancelled, SpecError
from sim.version import PHYSICS_VERSION

LOADED, STORING = 0.02, 0.97
"""Shares of the whole at which the engine begins and ends."""
ATLAS_END, ATLAS_SPAN, REFINED_SPAN = 0.6, 0.5, 0.05
"""In the engine's own share: where the atlas ends, what it takes together, what a later round shows at most."""


class Watched:
    """Hears the engine's stages, and stands between its simulations to ask whether the work is still wanted.

    `paced`: shares of the engine are shares of its time, so they tell how long it still takes; where an atlas may be
    there already they are not, and the pace of what is simulated for one tells.
    """

    def __init__(self, reporter: Reporter, points: int, lead: Lead | None = None, *, paced: bool = False) -> None:
        self._reporter, self._points, self._lead = reporter, max(points, 1), lead
        self._share, self._stage = 0.0, ""
        self._paced, self._started_s = paced, time.monotonic()
        self._pace = Pace(begins=ATLAS_END - ATLAS_SPAN, ends=ATLAS_END)

    def stage(self, share: float, stage: str) -> None:
        """A stage of the engine begins; raises Cancelled."""
        self._share, self._stage = share, stage
        self._tell(share, stage, self._left_s(share, stage))

    def _left_s(self, share: float, stage: str) -> float | None:
        if self._paced:
            return (time.monotonic() - self._started_s) * (1.0 - share) / share if share > 0.0 else None
        return self._pace.left_s(stage, share) if share >= ATLAS_END else None

    def map(self, run: Callable[[Task], Any], tasks: Iterable[Task]) -> Iterator[Any]:
        """`map` that tells how far it is and ends with Cancelled between two tasks; with a lead other workers help."""
        todo = list(tasks)
        metered = isinstance(run, Timed) and run.work is run_task
        if metered and self._lead is not None and todo:
            shared = self._lead.shared(todo, lambda done: self._heard(done, len(todo)))
            if shared is not None:
                yield from shared
                return
        for done, task in enumerate(todo):
            self._heard(done, len(todo))
            yield run.here(task) if isinstance(run, Timed) else run(task)

    def _heard(self, done: int, total: int) -> None:
        if self._reporter.cancelled():
            self._reporter.raise_if_stale()
            raise Cancelled("cancelled")
        span = ATLAS_SPAN / self._points if self._share < ATLAS_END else REFINED_SPAN
        part, share = min(done + 1, total), self._share + span * done / total
        left_s = self._pace.left_s(self._stage, share)
        self._tell(share, f"{self._stage}, part {part} of {total}", left_s)

    def _tell(self, share: float, stage: str, left_s: float | None = None) -> None:
        self._reporter.stage(stage, LOADED + (STORING - LOADED) * share, left_s)


def reconcile_stored(
    catalogue: JobCatalogue,
    artefacts: ArtefactStore,
    keeper: Keeper,
    reporter: Reporter,
    document: Mapping[str, object],
    *,
    prefix: str,
    attempt: int,
    expires_at: Callable[[], float | None],
    lead: Lead | None = None,
) -> ResultRef:
    """Carry out the stored request; NotReconcilable says which field or recording stands in the way."""
    reporter.stage("loading recordings", 0.0)
    request = ReconciliationRequest.model_validate(document)
    try:
        known = restored_known(document["machine"])
        chosen = choose(catalogue, artefacts, request.recordings, request.baselines)
        tests, baselines = chosen.loaded()
        paced = isinstance(known, KinematicSpec)
        watched = Watched(reporter, len({r.operating for r in tests}), lead, paced=paced)
        report = reconcile_recordings(
            known,
            tests,
            baselines,
            budget=BUDGETS[request.budget],
            keeper=keeper,
            mapper=watched.map,
            seed=request.seed,
            progress=watched.stage,
        )
    except SpecError as error:
        raise NotReconcilable(error.problems) from error
    report = replace(report, where=replace(report.where, limits=(*report.where.limits, *chosen.notes())))
    reporter.stage("storing", STORING)
    return _kept(artefacts, prefix, attempt, report, request.seed, tests[0].sampling_rate_hz, expires_at())


def _kept(
    artefacts: ArtefactStore,
    prefix: str,
    attempt: int,
    report: Report,
    seed: int,
    sampling_rate_hz: float,
    expires_at: float | None,
) -> ResultRef:
    """As a simulation's result is kept (`jobs.results`), without signals of its own."""
    texts = {
        f"{REPORT}.json": strict_json(report).encode(),
        PAGE: page(report).encode(),
        "summary.json": json_bytes({"verdict": report.verdict, "sentence": report.sentence, "level": report.level}),
    }
    if report.machine is not None:
        texts[f"{MACHINE}.json"] = json_bytes(report.machine)
    files = {name: put_file(artefacts, f"{prefix}/{name}", [text]) for name, text in texts.items()}
    manifest = Manifest(
        physics_version=PHYSICS_VERSION,
        seed=seed,
        sampling_rate_hz=sampling_rate_hz,
        samples=0,
        channels=(),
        spectra=(),
        files=files,
    )
    table = put_file(artefacts, f"{prefix}/manifest.json", [json_bytes(manifest.model_dump(mode="json"))])
    size = table.bytes + sum(entry.bytes for entry in files.values())
    causes = tuple(cause_key(cause) for cause in report.causes if cause.named)
    answer = Answer(verdict=report.verdict, causes=causes)
    return ResultRef(attempt=attempt, size_bytes=size, sha256=table.sha256, expires_at=expires_at, answer=answer)
