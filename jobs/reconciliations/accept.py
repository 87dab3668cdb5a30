"""Accepting a reconciliation: checked, durable before the reply, shared by everyone who asks the same."""

from __future__ import annotations

from jobs import transitions
from jobs.accept import Acceptance, Desk, charged, check_queue, hand_over, needs_work, replayed, reserve
from jobs.errors import RecordingsNotReady
from jobs.identity import digest, job_id
from jobs.reconciliations.chosen import Chosen, choose
from jobs.reconciliations.machine import Known, read_known, stored_form
from jobs.reconciliations.request import ReconciliationRequest
from jobs.reconciliations.together import check_together
from jobs.reconciliations.words import RECONCILIATION
from jobs.record import Cost
from jobs.validation import Findings
from reconcile.kinematics import KinematicSpec
from reconcile.origin import METHOD_VERSION

KINEMATIC_S, DRIVEN_S = 5.0, 60.0
"""Core-seconds: a recording at the level of kinematics, a machine that is driven by a measured input."""
ATLAS_S = 300.0
"""An operating point of an atlas that is not kept yet; more than that for machines with many parts."""
BUDGET_S = {"quick": 120.0, "full": 600.0}
COPIES = 6
"""Of the samples, held while they are looked at."""


def accept_reconciliation(
    desk: Desk, request: ReconciliationRequest, *, submitter: str, scope: str, key: str | None
) -> Acceptance:
    """Accept a request for `submitter`; `scope` is whose idempotency keys these are.

    SpecError names the fields that must change, ResultNotReady a recording that is still being read.
    """
    body = digest({"kind": RECONCILIATION, **request.model_dump(mode="json")})
    if key is not None:
        earlier = replayed(desk, scope, key, body)
        if earlier is not None:
            return earlier
    known, chosen = _understood(desk, request)
    settings = request.model_dump(mode="json", exclude={"machine"})
    document = {"machine": stored_form(known), **settings}
    identifier = job_id(RECONCILIATION, document, f"{desk.engine.version} {METHOD_VERSION}")
    new_work = needs_work(desk.catalogue, identifier)
    if new_work:
        check_together(known, *chosen.described())
        check_queue(desk)
    now = desk.clock()
    name = known.name or "kinematics"
    preset = request.machine if isinstance(request.machine, str) else None
    cost = _cost(known, request, chosen.samples)
    with charged(desk, identifier, cost.seconds if new_work else None):
        if key is not None:
            reserve(desk, scope, key, body, identifier)
        record, created = desk.catalogue.put(
            identifier,
            document,
            first=lambda: transitions.new(
                job_id=identifier,
                kind=RECONCILIATION,
                submitter=submitter,
                source={"preset": preset, "machine": name, **settings},
                cost=cost,
                now=now,
            ),
            again=lambda present: transitions.submit_again(present, submitter, now),
        )
    return Acceptance(record=hand_over(desk, record), created=created, replayed=False)


def _understood(desk: Desk, request: ReconciliationRequest) -> tuple[Known, Chosen]:
    """The machine and the recordings; what is wrong with either is told together, before what is not ready yet."""
    findings = Findings()
    known: Known | None = None
    chosen: Chosen | None = None
    late: RecordingsNotReady | None = None
    with findings.step():
        known = read_known(request.machine, desk.engine)
    with findings.step():
        try:
            chosen = choose(desk.catalogue, desk.artefacts, request.recordings, request.baselines)
        except RecordingsNotReady as error:
            late = error
    findings.settle()
    if late is not None:
        raise late
    assert known is not None and chosen is not None
    return known, chosen


def _cost(known: Known, request: ReconciliationRequest, samples: int) -> Cost:
    """A rough figure for the list: an atlas that is kept costs nothing, every other part is in it."""
    if isinstance(known, KinematicSpec):
        seconds = KINEMATIC_S * (len(request.recordings) + len(request.baselines))
    elif not known.shafts:
        seconds = DRIVEN_S
    else:
        seconds = ATLAS_S * len(request.recordings) + BUDGET_S[request.budget]
    return Cost(steps=0, memory_bytes=8 * COPIES * samples, seconds=seconds)
