"""Making a dataset's folder, and taking one up again where it stopped."""

from __future__ import annotations

import contextlib
import fcntl
import json
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

from sideband_datasets.folder.card import card
from sideband_datasets.folder.croissant import croissant
from sideband_datasets.folder.layout import (
    CARD,
    CROISSANT,
    DATA,
    FAILURES,
    LOCK,
    MANIFEST,
    SETTINGS,
    STATE,
    json_text,
    remove,
    sha256,
    synced,
    unfinished,
    write_text,
)
from sideband_datasets.folder.manifest import failures_text, manifest, versions
from sideband_datasets.folder.pool import Job, made_by_workers
from sideband_datasets.folder.shards import Receipt, Shard, finished, make_shard, shards_of
from sideband_datasets.folder.space import check_space
from sideband_datasets.formats import format_named
from sideband_datasets.plan.estimate import estimate
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import check_shard
from sideband_datasets.plan.tried import make_plan
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import canonical, document_of, read_recipe
from sim.core.errors import Problem, SpecError

MOST_WORKERS = 256
MOST_IN_A_SHARD = 100_000


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
    if out.exists() and (not out.is_dir() or any(out.iterdir())):
        raise SpecError(Problem(field="--out", message="is there already", given=str(out), allowed="a new folder"))
    folder = unfinished(out)
    if (folder / STATE / SETTINGS).exists():
        message = "was begun already"
        allowed = f"`sideband dataset resume {out}`, or another --out"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed=allowed))
    check_space(expected.bytes, out)
    for name in (DATA, STATE):
        (folder / name).mkdir(parents=True, exist_ok=True)
    document = {
        "recipe": document_of(recipe),
        "format": settings.format,
        "shard_recordings": settings.shard_recordings,
        "versions": versions(),
    }
    write_text(folder / STATE / SETTINGS, json_text(document))
    return _carry_on(plan, out, settings, told)


def resume(out: Path, workers: int, told: Callable[[Progress], None]) -> dict[str, object]:
    """Finish a dataset that was interrupted: the same bytes as if it had not been. Returns its manifest."""
    folder = unfinished(out)
    if not folder.is_dir():
        if (out / MANIFEST).is_file():
            return _manifest(out)
        message = "holds no dataset that was begun"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed="`sideband dataset make`"))
    if (folder / MANIFEST).is_file():
        # Everything was written; only the name was missing.
        _publish(folder, out)
        return _manifest(out)
    if not (folder / STATE / SETTINGS).is_file():
        message = f"nothing was begun in {folder.name} yet; remove it and make the dataset"
        raise SpecError(Problem(field="--out", message=message, given=str(out)))
    document = json.loads((folder / STATE / SETTINGS).read_text(encoding="utf-8"))
    now = versions()
    if document["versions"] != now:
        changed = [
            f"{k} {document['versions'].get(k)} -> {now.get(k)}" for k in now if document["versions"].get(k) != now[k]
        ]
        message = f"was begun with other versions ({', '.join(changed)}): its rows would not be of one kind"
        raise SpecError(Problem(field="--out", message=message, given=str(out), allowed="make it anew"))
    settings = Settings(format=document["format"], workers=workers, shard_recordings=document["shard_recordings"])
    _check(settings)
    return _carry_on(make_plan(read_recipe(document["recipe"])), out, settings, told)


def check_size(plan: Plan, shard_recordings: int | None) -> None:
    """SpecError when so many recordings are no shard, or more than one may hold; None is what fits."""
    if shard_recordings is not None:
        _check_number("--shard-recordings", shard_recordings, MOST_IN_A_SHARD)
        largest = min(shard_recordings, max(plan.of_split(split).size for split in plan.splits))
        check_shard(plan, largest, "--shard-recordings", shard_recordings)


def _manifest(out: Path) -> dict[str, object]:
    found: dict[str, object] = json.loads((out / MANIFEST).read_text(encoding="utf-8"))
    return found


def _check(settings: Settings) -> None:
    format_named(settings.format)
    _check_number("--workers", settings.workers, MOST_WORKERS)
    if settings.shard_recordings is not None:
        _check_number("--shard-recordings", settings.shard_recordings, MOST_IN_A_SHARD)


def _check_number(field: str, value: int, most: int) -> None:
    if not 1 <= value <= most:
        raise SpecError(Problem(field=field, message="is out of bounds", given=value, allowed=f"1 to {most}"))


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """One command at a time; the lock goes with its process, however that ends."""
    with (folder / STATE / LOCK).open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            message = "is being made by another command"
            raise SpecError(Problem(field="--out", message=message, given=folder.name)) from error
        yield


def _carry_on(plan: Plan, out: Path, settings: Settings, told: Callable[[Progress], None]) -> dict[str, object]:
    folder = unfinished(out)
    shards = shards_of(plan, format_named(settings.format).suffix, settings.shard_recordings)
    with _alone(folder):
        _sweep(folder)
        receipts = {shard: receipt for shard in shards if (receipt := finished(folder, shard)) is not None}
        # The largest first: workers then end together.
        left = sorted((s for s in shards if s not in receipts), key=lambda shard: -len(shard.recordings))
        kept = sum(len(shard.recordings) for shard in receipts) * plan.rows_per_recording
        told(Progress(rows=kept, kept=kept, total=plan.rows))

        def count(rows: int) -> None:
            told(Progress(rows=min(kept + rows, plan.rows), kept=kept, total=plan.rows))

        receipts |= dict(_made(plan, left, folder, settings, count))
        told(Progress(rows=plan.rows, kept=kept, total=plan.rows))
        document = _finish(plan, [receipts[shard] for shard in shards], folder, settings.format)
        _publish(folder, out)
    return document


def _sweep(folder: Path) -> None:
    """What killed workers left under no name of its own."""
    for left in [*(folder / DATA).glob(".*"), *(folder / STATE).glob(".*")]:
        remove(left)


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


def _publish(folder: Path, out: Path) -> None:
    """The finished folder takes its name, whole."""
    remove(folder / STATE)
    folder.replace(out.absolute())
    synced(out.absolute())
