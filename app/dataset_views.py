"""What the API replies about datasets."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from app.routes.estimate import LimitsView
from app.schemas import JobView, Reply, job_view
from jobs.datasets.settle import shards_of
from jobs.datasets.words import SHARD
from jobs.ports import JobCatalogue
from jobs.record import JobRecord
from jobs.status import Status

ADDRESS = "/v1/datasets"
Balance = dict[str, dict[str, int]]
"""Rows by split and class."""


class DatasetEstimate(Reply):
    """What a dataset would take; nothing is kept of it."""

    recordings: int
    rows: int
    bytes: int
    """Samples and columns before compression."""
    shards: int
    shard_recordings: int
    """Most recordings in a shard."""
    core_seconds: float
    workers: int
    """Present now; one when none is."""
    wall_s: float
    """With these workers, if they have nothing else to do."""
    classes: list[str]
    balance: Balance
    """Rows by split and class."""
    machines: dict[str, int]
    """Machines by split; no machine is in two."""
    warnings: list[str]
    limits: LimitsView


class ShardCounts(Reply):
    """How the shards stand."""

    total: int
    waiting: int
    running: int
    successful: int
    failed: int


class DatasetLinks(Reply):
    """Where to go from here."""

    self: str
    job: str
    events: str
    cancel: str
    files: str | None
    rows: str | None
    archive: str | None


class DatasetView(Reply):
    """A dataset: its job, its shards, and its manifest once it is there."""

    id: str
    status: Status
    job: JobView
    shards: ShardCounts
    balance: Balance | None
    """Rows by split and class that are there."""
    manifest: dict[str, object] | None
    """`manifest.json`: recipe, versions, rows, columns, shards with checksums."""
    links: DatasetLinks


class FileView(Reply):
    """A file of a dataset."""

    path: str
    bytes: int
    sha256: str
    href: str


class FileList(Reply):
    """Every file of a dataset, by its path in the dataset's folder."""

    files: list[FileView]


class RowView(Reply):
    """A row: `columns` as in the files, without the samples."""

    columns: dict[str, object]
    signal: dict[str, object] | None = None
    """`unit`, `t_s`, `values`."""
    spectrum: dict[str, object] | None = None
    """Line amplitudes: `unit`, `amplitude`, `window`, `frequency_hz`, `values`."""
    envelope: dict[str, object] | None = None
    """The same of the envelope, and its `band_hz`, where a peak of it is labelled."""


class RowPage(Reply):
    """Some rows, in the order of the shards."""

    rows: list[RowView]
    total: int
    offset: Annotated[int, Field(ge=0)]


class ReadyRecipe(Reply):
    """A recipe to start from."""

    name: str
    sentence: str
    recipe: dict[str, object]


class FormatView(Reply):
    """A format of the shards."""

    name: str
    sentence: str
    installed: bool
    """False: this server refuses it, for want of a package."""


class RecipesView(Reply):
    """Ready recipes, the formats there are, and what a recipe may hold."""

    recipes: list[ReadyRecipe]
    formats: list[FormatView]
    recipe_schema: dict[str, object]


def dataset_view(
    catalogue: JobCatalogue, record: JobRecord, manifest: dict[str, object] | None, balance: Balance | None
) -> DatasetView:
    """The dataset as it stands."""
    base, job = f"{ADDRESS}/{record.id}", job_view(record)
    there = manifest is not None
    return DatasetView(
        id=record.id,
        status=record.status,
        job=job,
        shards=_counts(catalogue, record),
        balance=balance,
        manifest=manifest,
        links=DatasetLinks(
            self=base,
            job=job.links.self,
            events=job.links.events,
            cancel=job.links.cancel,
            files=f"{base}/files" if there else None,
            rows=f"{base}/rows" if there else None,
            archive=f"{base}/archive.tar" if there else None,
        ),
    )


def _counts(catalogue: JobCatalogue, record: JobRecord) -> ShardCounts:
    tally = catalogue.parts.tally(record.id, 0.0)
    return ShardCounts(
        total=shards_of(record),
        waiting=tally.of(SHARD, Status.ACCEPTED),
        running=tally.of(SHARD, Status.RUNNING),
        successful=tally.of(SHARD, Status.SUCCESSFUL),
        failed=tally.of(SHARD, Status.FAILED),
    )
