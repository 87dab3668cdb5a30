"""`POST /v1/simulations`: durable before the reply, shared by everyone who asks the same."""

from __future__ import annotations

import uuid
from typing import Annotated

from fastapi import APIRouter, Header, Response

from app.routes.responses import problems
from app.schemas import SubmittedView, submitted_view
from app.state import HolderBudget, Principal, State
from jobs.accept import accept
from jobs.request import SimulationRequest

router = APIRouter(tags=["simulations"])

SubmitterName = Annotated[
    str | None,
    Header(alias="X-Submitter", min_length=1, max_length=64, pattern=r"^[A-Za-z0-9._-]+$"),
]
KeyName = Annotated[
    str | None, Header(alias="Idempotency-Key", min_length=1, max_length=255, pattern=r"^[\x21-\x7e ]+$")
]


@router.post(
    "/v1/simulations",
    status_code=202,
    response_model=SubmittedView,
    responses=problems(400, 401, 413, 415, 422, 429, 503, 507),
)
def submit(
    request: SimulationRequest,
    state: State,
    principal: Principal,
    budget: HolderBudget,
    response: Response,
    submitter: SubmitterName = None,
    key: KeyName = None,
) -> SubmittedView:
    """Ask for a simulation.

    The same request shares one job and one result. Who asks is the API key's holder, or `X-Submitter`, or a name
    made for this request; cancelling withdraws one of them.
    """
    name = named(principal, submitter) or f"anonymous-{uuid.uuid4().hex[:12]}"
    taken = accept(state.desk(budget), request, submitter=name, scope=principal, key=key)
    response.headers["Location"] = f"/v1/jobs/{taken.record.id}"
    if taken.replayed:
        response.headers["Idempotency-Replayed"] = "true"
    return submitted_view(taken.record, submitter=name, created=taken.created)


def named(principal: str, submitter: str | None) -> str:
    """Who asks: the key's holder, with the name given beneath it; a name cannot reach into another holder's."""
    if principal and submitter:
        return f"{principal}/{submitter}"
    return principal or submitter or ""
