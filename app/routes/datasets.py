"""`/v1/datasets`: estimate, ask for, follow and list datasets."""

from __future__ import annotations

import importlib.util
import time
import uuid
from typing import Annotated, Any, cast

from fastapi import APIRouter, Query, Request, Response

from app.dataset_views import (
    ADDRESS,
    Balance,
    DatasetEstimate,
    DatasetView,
    FormatView,
    ReadyRecipe,
    RecipesView,
    dataset_view,
)
from app.reading import stored
from app.routes.estimate import limits
from app.routes.jobs import JobId, Sort, list_jobs
from app.routes.responses import problems
from app.routes.simulations import KeyName, SubmitterName, named
from app.schemas import JobPage, SubmittedView, submitted_view
from app.state import AppState, HolderBudget, Principal, State
from jobs.datasets.accept import accept_dataset, divided
from jobs.datasets.divide import balance_of
from jobs.datasets.planning import planning
from jobs.datasets.request import DatasetRequest
from jobs.datasets.stored import StoredDataset
from jobs.datasets.words import DATASET
from jobs.errors import JobGone, UnknownJob
from jobs.kinds import Kind
from jobs.record import JobRecord
from jobs.status import Status
from sideband_datasets import Recipe
from sideband_datasets.formats import FORMATS
from sideband_datasets.recipe import RECIPES
from sideband_datasets.recipe.read import document_of
from store.catalogue import workers

router = APIRouter(tags=["datasets"])


@router.post(
    ADDRESS,
    status_code=202,
    response_model=SubmittedView,
    responses=problems(400, 401, 413, 415, 422, 429, 503, 507),
)
def submit(
    request: DatasetRequest,
    state: State,
    principal: Principal,
    budget: HolderBudget,
    response: Response,
    submitter: SubmitterName = None,
    key: KeyName = None,
) -> SubmittedView:
    """Ask for a dataset. Its shards are made by all workers that have nothing else to do.

    The same request shares one dataset. One that failed or was cancelled is taken up where it stopped.
    """
    name = named(principal, submitter) or f"anonymous-{uuid.uuid4().hex[:12]}"
    taken = accept_dataset(state.desk(budget), request, submitter=name, scope=principal, key=key)
    response.headers["Location"] = f"{ADDRESS}/{taken.record.id}"
    if taken.replayed:
        response.headers["Idempotency-Replayed"] = "true"
    return submitted_view(taken.record, submitter=name, created=taken.created)


@router.post(f"{ADDRESS}/estimate", response_model=DatasetEstimate, responses=problems(400, 401, 413, 415, 422, 429))
def estimate(request: DatasetRequest, state: State) -> DatasetEstimate:
    """Check a request as `POST /v1/datasets` would, and say what it would take. Nothing is simulated."""
    present = _workers(state)
    with planning():
        division = divided(request, state.settings.limits)
        cost = division.expected(present)
    plan = division.plan
    return DatasetEstimate(
        recordings=cost.recordings,
        rows=cost.rows,
        bytes=cost.bytes,
        shards=len(division.shards),
        shard_recordings=division.shard_recordings,
        core_seconds=cost.core_seconds,
        workers=present,
        wall_s=cost.wall_s,
        classes=list(plan.recipe.classes),
        balance=balance_of(plan),
        machines={split: int((plan.split_of == k).sum()) for k, split in enumerate(plan.splits)},
        warnings=list(plan.warnings),
        limits=limits(state),
    )


def _workers(state: AppState) -> int:
    found = workers.present(state.stores.catalogue.engine, time.time(), state.settings.worker_silent_s)
    return max(1, len(found))


@router.get(ADDRESS, response_model=JobPage, responses=problems(401, 422, 503))
def list_datasets(
    request: Request,
    response: Response,
    state: State,
    status: Annotated[list[Status] | None, Query()] = None,
    sort: Annotated[Sort, Query()] = "-created_at",
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(max_length=300)] = None,
) -> JobPage:
    """Jobs of datasets, a page at a time; `next` is the address of the following page."""
    return list_jobs(request, response, state, status, None, Kind.DATASET, sort, limit, cursor)


@router.get(f"{ADDRESS}/recipes", response_model=RecipesView, responses=problems(401))
def recipes() -> RecipesView:
    """Ready recipes as a whole, the formats, and the JSON schema of a recipe."""
    return RecipesView(
        recipes=[
            ReadyRecipe(name=ready.name, sentence=ready.sentence, recipe=document_of(ready.read()))
            for ready in RECIPES.values()
        ],
        formats=[
            FormatView(name=found.name, sentence=found.sentence, installed=_installed(found.package))
            for found in FORMATS.values()
        ],
        recipe_schema=Recipe.model_json_schema(),
    )


def _installed(package: str) -> bool:
    return not package or importlib.util.find_spec(package) is not None


@router.get(f"{ADDRESS}/{{job_id}}", response_model=DatasetView, responses=problems(401, 404, 410, 503))
def get_dataset(job_id: JobId, state: State, response: Response) -> DatasetView:
    """How a dataset stands; its manifest once it is successful."""
    record = dataset_record(state, job_id)
    response.headers["Cache-Control"] = "no-store"
    manifest: dict[str, Any] | None = None
    balance: Balance | None = None
    if record.status is Status.SUCCESSFUL:
        found = stored(state, job_id)
        manifest = StoredDataset(state.stores.artefacts, found.prefix).manifest()
        balance = cast(Balance, found.reader.document("summary")["balance"])
    return dataset_view(state.stores.catalogue, record, manifest, balance)


def dataset_record(state: AppState, job_id: str) -> JobRecord:
    """The dataset's job; raises UnknownJob, JobGone."""
    record = state.stores.catalogue.get(job_id)
    if record.kind != DATASET:
        raise UnknownJob(job_id)
    if record.gone is not None:
        raise JobGone(job_id, record.gone)
    return record
