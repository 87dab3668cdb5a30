"""Making a dataset's folder, and taking one up again where it stopped."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sideband_datasets.folder.card import card
from sideband_datasets.folder.croissant import croissant
from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import (
    CARD,
    CROISSANT,
    DATA,
    FAILURES,
    MANIFEST,
    SETTINGS,
    STATE,
    json_text,
    sha256,
    unfinished,
    write_text,
)
from sideband_datasets.folder.manifest import failures_text, manifest, versions
from sideband_datasets.folder.pool import Job, made_by_workers
from sideband_datasets.folder.publish import (
    alone,
    check_free,
    check_not_begun,
    damage,
    manifest_of,
    publish,
    refused,
    sweep,
)
from sideband_datasets.folder.shards import Receipt, Shard, finished, make_shard, shards_of
from sideband_datasets.folder.space import check_space
from sideband_datasets.formats import format_named
from sideband_datasets.plan.estimate import estimate
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import check_shard
from sideband_datasets.plan.tried import make_plan
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import canonical, document_of, identity, read_recipe
from sim.core.errors import Problem, SpecError

MOST_WORKERS = 256
MOST_IN_A_SHARD = 100_000
WRITTEN = {"recipe", "format", "shard_recordings", "versions"}
"""Of what was begun."""
SAID_TWICE = ("recipe", "format", "versions")
"""In the manifest and in what was begun."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How a folder is made. Neither number changes a row; the second changes which file it is in."""

    format: str = "parquet"
    workers: int = 1
    shard_recordings: int | None = None
    """None: as many as are worked on at once."""


@dataclass(frozen=True, kw_only=True)
class Progress:
    """`rows` done of `total`; `kept` of them were there already when this run began."""

    rows: int
    kept: int
    total: int


def make(recipe: Recipe, out: Path, settings: Settings, told: Callable[[Progress], None]) -> dict[str, object]:
    """Make a dataset in the new folder `out`; returns its manifest.

    SpecError for a recipe that cannot be made, shards or a dataset too large for memory or disk, a folder that is
    there, or an unfinished one, which `resume` takes up.
    """
    _check(settings)
    plan = make_plan(recipe)
    check_size(plan, settings.shard_recordings)
    expected = estimate(plan, settings.workers, settings.shard_recordings)
    check_free(out)
    folder = unfinished(out)
    check_not_begun(folder, out)
    check_space(expected.bytes, out)
    document = {
        "recipe": document_of(recipe),
        "format": settings.format,
        "shard_recordings": settings.shard_recordings,
        "versions": versions(),
    }
    folder.mkdir(parents=True, exist_ok=True)
    with alone(folder):
        # Another command may have been faster.
        check_not_begun(folder, out)
        for name in (DATA, STATE):
            (folder / name).mkdir(exist_ok=True)
        write_text(folder / STATE / SETTINGS, json_text(document))
        return _carry_on(plan, out, settings, told)


def resume(out: Path, workers: int, told: Callable[[Progress], None]) -> dict[str, object]:
    """Finish a dataset that was interrupted: the same bytes as if it had not been. Returns its manifest.

    SpecError where none was begun, another command is making it, versions changed since, or a folder that had all its
    files has lost one, or has a damaged one, and nothing is left to make it again from.
    """
    folder = unfinished(out)
    if not folder.is_dir():
        if (manifest := manifest_of(out)) is not None:
            return manifest
        message = "holds no dataset that was begun"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed="`sideband dataset make`"))
    check_free(out)
    with alone(folder):
        sweep(folder)
        return _resume(folder, out, workers, told)


def _resume(folder: Path, out: Path, workers: int, told: Callable[[Progress], None]) -> dict[str, object]:
    begun = _begun(folder)
    if (folder / MANIFEST).is_file():
        # Everything was written; what is sound lacks but its name.
        manifest = manifest_of(folder)
        same = manifest is not None and (begun is None or all(begun[k] == manifest.get(k) for k in SAID_TWICE))
        found = [] if manifest is None else damage(folder, manifest)
        if manifest is not None and same and not found:
            publish(folder, out, manifest)
            return manifest
        if begun is None:
            raise refused(out, found or [Finding(where=MANIFEST, what="cannot be read")])
    if begun is None:
        message = f"nothing was begun in {folder.name} yet; remove it and make the dataset"
        raise SpecError(Problem(field="--out", message=message, given=str(out)))
    now = versions()
    if begun["versions"] != now:
        changed = [f"{k} {begun['versions'].get(k)} -> {now.get(k)}" for k in now if begun["versions"].get(k) != now[k]]
        message = f"was begun with other versions ({', '.join(changed)}): its rows would not be of one kind"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed="make it anew"))
    settings = Settings(format=begun["format"], workers=workers, shard_recordings=begun["shard_recordings"])
    _check(settings)
    (folder / DATA).mkdir(exist_ok=True)
    return _carry_on(make_plan(read_recipe(begun["recipe"])), out, settings, told)


def _begun(folder: Path) -> dict[str, Any] | None:
    """What is made in the folder; None when that is not said, or no more."""
    path = folder / STATE / SETTINGS
    if not path.is_file():
        return None
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if set(found) == WRITTEN and isinstance(found["versions"], dict):
            return dict(found)
    except (ValueError, TypeError):
        pass
    place, given = f"{folder.name}/{STATE}/{SETTINGS}", f"{path.stat().st_size} bytes"
    message = "is damaged; remove the unfinished folder and make the dataset again"
    raise SpecError(Problem(field=place, message=message, given=given))


def check_size(plan: Plan, shard_recordings: int | None) -> None:
    """SpecError when so many recordings are no shard, or more than one may hold; None is what fits."""
    if shard_recordings is not None:
        _check_number("--shard-recordings", shard_recordings, MOST_IN_A_SHARD)
        largest = min(shard_recordings, max(plan.of_split(split).size for split in plan.splits))
        check_shard(plan, largest, "--shard-recordings", shard_recordings)


def _check(settings: Settings) -> None:
    format_named(settings.format)
    _check_number("--workers", settings.workers, MOST_WORKERS)
    if settings.shard_recordings is not None:
        _check_number("--shard-recordings", settings.shard_recordings, MOST_IN_A_SHARD)


def _check_number(field: str, value: int, most: int) -> None:
    if not 1 <= value <= most:
        raise SpecError(Problem(field=field, message="is out of bounds", given=value, allowed=f"1 to {most}"))


def _carry_on(plan: Plan, out: Path, settings: Settings, told: Callable[[Progress], None]) -> dict[str, object]:
    """Make what is left, and publish it; the caller is alone in the folder."""
    folder = unfinished(out)
    shards = shards_of(plan, format_named(settings.format).suffix, settings.shard_recordings)
    recipe = identity(plan.recipe)
    receipts = {shard: receipt for shard in shards if (receipt := finished(folder, shard, recipe)) is not None}
    # The largest first: workers then end together.
    left = sorted((s for s in shards if s not in receipts), key=lambda shard: -len(shard.recordings))
    kept = sum(len(shard.recordings) for shard in receipts) * plan.rows_per_recording
    told(Progress(rows=kept, kept=kept, total=plan.rows))

    def count(rows: int) -> None:
        told(Progress(rows=min(kept + rows, plan.rows), kept=kept, total=plan.rows))

    receipts |= dict(_made(plan, left, folder, settings, count))
    told(Progress(rows=plan.rows, kept=kept, total=plan.rows))
    document = _finish(plan, [receipts[shard] for shard in shards], folder, settings.format)
    publish(folder, out, document)
    return document


def _made(
    plan: Plan, left: list[Shard], folder: Path, settings: Settings, told: Callable[[int], None]
) -> Iterator[tuple[Shard, Receipt]]:
    if settings.workers > 1 and left:
        job = Job(recipe=canonical(plan.recipe), folder=folder, kind=settings.format)
        yield from made_by_workers(job, left, settings.workers, told)
        return
    done = 0

    def count(rows: int) -> None:
        nonlocal done
        done += rows
        told(done)

    for shard in left:
        yield shard, make_shard(plan, shard, folder, settings.format, made=count)


def _finish(plan: Plan, receipts: list[Receipt], folder: Path, kind: str) -> dict[str, object]:
    """Everything beside the shards; the manifest last."""
    write_text(folder / FAILURES, failures_text(receipts))
    write_text(folder / CARD, card(plan, receipts, kind))
    write_text(folder / CROISSANT, json_text(croissant(plan, receipts, kind)))
    others = {name: sha256(folder / name) for name in (FAILURES, CARD, CROISSANT)}
    document = manifest(plan, receipts, kind, others)
    write_text(folder / MANIFEST, json_text(document))
    return document
