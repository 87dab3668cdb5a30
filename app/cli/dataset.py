"""Datasets to train classifiers on: planned, labelled, no machine in two splits, every row reproducible alone.

RECIPE is a JSON file or the name of a ready recipe (`sideband dataset recipes`). An interrupted dataset is
DIR.partial beside its later place; `resume` finishes it with the bytes it would have had.

Example: sideband dataset make bearing-rig --out rig --workers 2 && sideband dataset verify rig --remake 8
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path

from tqdm import tqdm

from app.cli import dataset_upload
from app.cli.files import json_text, local_path, read_json
from app.cli.seed import seed
from sideband_datasets import Recipe, make_plan, read_recipe, recipe_named
from sideband_datasets.folder import Progress, Settings, check_size, free_bytes, make, resume, unfinished, verify
from sideband_datasets.folder.layout import CARD
from sideband_datasets.folder.pool import WorkersDied
from sideband_datasets.formats import FORMATS
from sideband_datasets.plan import Estimate, Plan, estimate
from sideband_datasets.recipe import RECIPES
from sideband_datasets.recipe.read import document_of
from sim.core.errors import Problem, SpecError

FAILED = 1


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the actions."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    plan = actions.add_parser("plan", help="what a recipe makes: rows, splits, classes, size, time", allow_abbrev=False)
    begun = actions.add_parser("make", help="make a dataset in a new folder", allow_abbrev=False)
    for action in (plan, begun):
        action.add_argument("recipe", metavar="RECIPE", help="a JSON file, or the name of a ready recipe")
        action.add_argument("--count", metavar="N", type=int, help="recordings, instead of the recipe's")
        action.add_argument("--seed", metavar="N", type=int, help="instead of the recipe's")
        action.add_argument("--shard-recordings", metavar="N", type=int, help="recordings in a shard")
    begun.add_argument("--out", metavar="DIR", type=local_path, required=True, help="a new folder")
    begun.add_argument("--format", default="parquet", help=f"{', '.join(FORMATS)} (default parquet)")
    resumed = actions.add_parser("resume", help="finish an interrupted dataset", allow_abbrev=False)
    resumed.add_argument("out", metavar="DIR", type=local_path, help="the folder that `make` was given")
    for action in (plan, begun, resumed):
        action.add_argument("--workers", metavar="N", type=int, default=2, help="processes (default 2)")
    checked = actions.add_parser("verify", help="look for damage, leaks and rows that differ", allow_abbrev=False)
    checked.add_argument("out", metavar="DIR", type=Path)
    checked.add_argument("--remake", metavar="K", type=int, default=0, help="make K rows again and compare every bit")
    checked.add_argument("--seed", metavar="N", type=seed, default=0, help="which rows are made again")
    card = actions.add_parser("card", help="print the card of a dataset", allow_abbrev=False)
    card.add_argument("out", metavar="DIR", type=Path)
    sent = actions.add_parser("upload", help="put a dataset into a bucket, whole or not at all", allow_abbrev=False)
    dataset_upload.configure(sent)
    ready = actions.add_parser("recipes", help="list the ready recipes, or print one", allow_abbrev=False)
    ready.add_argument("name", metavar="NAME", nargs="?")
    for action in (plan, checked):
        action.add_argument("--json", action="store_true", help="print the answer as JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run an action."""
    return {
        "plan": _plan,
        "make": _make,
        "resume": _resume,
        "verify": _verify,
        "card": _card,
        "upload": dataset_upload.run,
        "recipes": _recipes,
    }[arguments.action](arguments)


def _recipe(arguments: argparse.Namespace) -> Recipe:
    path = Path(arguments.recipe)
    recipe = read_recipe(read_json(path)) if path.suffix or path.exists() else recipe_named(arguments.recipe)
    changes = {key: getattr(arguments, key) for key in ("count", "seed") if getattr(arguments, key) is not None}
    return read_recipe({**document_of(recipe), **changes}) if changes else recipe


def _workers(arguments: argparse.Namespace) -> int:
    if not 1 <= arguments.workers <= 256:
        raise SpecError(Problem(field="--workers", message="must fit", given=arguments.workers, allowed="1 to 256"))
    return int(arguments.workers)


def _plan(arguments: argparse.Namespace) -> int:
    plan = make_plan(_recipe(arguments))
    check_size(plan, arguments.shard_recordings)
    expected = estimate(plan, _workers(arguments), arguments.shard_recordings)
    warnings = [*plan.warnings, *_space_warnings(expected)]
    if arguments.json:
        splits = {name: int(plan.of_split(name).size) for name in plan.splits}
        classes = {name: int((plan.kind == k).sum()) for k, name in enumerate(plan.recipe.classes)}
        answer = {**asdict(expected), "splits": splits, "classes": classes, "warnings": warnings}
        print(json_text(answer), end="")
    else:
        print(_told(plan, expected, warnings))
    return 0


def _space_warnings(expected: Estimate) -> Iterator[str]:
    free = free_bytes(Path())
    if expected.bytes > free:
        yield f"the disk of this folder has {free} bytes free, the dataset is estimated at {expected.bytes}"


def _told(plan: Plan, expected: Estimate, warnings: Sequence[str]) -> str:
    each = f"{plan.rows_per_recording} of each of {expected.recordings} recordings"
    time = f"{expected.core_seconds:.3g} core-seconds, {expected.wall_s:.3g} s with {expected.workers} workers"
    lines = [
        f"{plan.recipe.name}: {expected.rows} rows, {each}",
        f"about {expected.bytes / 1e6:.3g} MB before compression, {time}",
    ]
    for k, name in enumerate(plan.recipe.classes):
        lines.append(f"class {name}: {int((plan.kind == k).sum())} recordings")
    for k, name in enumerate(plan.splits):
        machines = int((plan.split_of == k).sum())
        lines.append(f"split {name}: {int(plan.of_split(name).size)} recordings of {machines} machines")
    return "\n".join([*lines, *(f"warning: {told}" for told in warnings)])


@contextmanager
def _progress() -> Iterator[tqdm]:  # type: ignore[type-arg]
    text = "{n_fmt}/{total_fmt} rows {bar} {rate_fmt} [{elapsed}<{remaining}]"
    # `disable=None`: a bar on a terminal only, not in a file or a pipe.
    with tqdm(total=0, unit="row", disable=None, bar_format=text, file=sys.stderr) as bar:
        yield bar


def _show(bar: tqdm, progress: Progress) -> None:  # type: ignore[type-arg]
    if not bar.total:
        # Rows that were there already say nothing of the rate.
        bar.reset(total=progress.total)
        bar.initial = bar.n = progress.kept
    bar.update(max(0, progress.rows - int(bar.n)))


def _make(arguments: argparse.Namespace) -> int:
    settings = Settings(
        format=arguments.format, workers=_workers(arguments), shard_recordings=arguments.shard_recordings
    )
    recipe = _recipe(arguments)
    with _interruptible(arguments.out), _progress() as bar:
        manifest = make(recipe, arguments.out, settings, lambda progress: _show(bar, progress))
    return _done(arguments.out, manifest)


def _resume(arguments: argparse.Namespace) -> int:
    with _interruptible(arguments.out), _progress() as bar:
        manifest = resume(arguments.out, _workers(arguments), lambda progress: _show(bar, progress))
    return _done(arguments.out, manifest)


@contextmanager
def _interruptible(out: Path) -> Iterator[None]:
    try:
        yield
    except (KeyboardInterrupt, WorkersDied):
        if unfinished(out).exists():
            print(f"to go on: sideband dataset resume {out}", file=sys.stderr)
        raise


def _done(out: Path, manifest: dict[str, object]) -> int:
    print(f"{out}: {manifest['rows']} rows, {manifest['failed_rows']} failed, {manifest['bytes']} bytes")
    splits, warnings = manifest["splits"], manifest["warnings"]
    assert isinstance(splits, dict) and isinstance(warnings, list)
    for told in warnings:
        print(f"warning: {told}", file=sys.stderr)
    doubted = manifest.get("doubted_rows")
    if isinstance(doubted, dict) and doubted:
        found = ", ".join(f"{count} of {name}" for name, count in doubted.items())
        print(f"rows whose numbers the simulation doubts (column `warnings`): {found}", file=sys.stderr)
    empty = [name for name, found in splits.items() if not found["rows"]]
    for name in empty:
        print(f"split {name} has no row: `{out}/failures.jsonl` says why", file=sys.stderr)
    return FAILED if empty else 0


def _verify(arguments: argparse.Namespace) -> int:
    if arguments.remake < 0:
        raise SpecError(Problem(field="--remake", message="must not be negative", given=arguments.remake))
    found = verify(arguments.out, remake=arguments.remake, seed=arguments.seed, told=_stage)
    if arguments.json:
        print(json_text({"sound": not found, "findings": [asdict(finding) for finding in found]}), end="")
    else:
        print("\n".join(map(str, found)) or f"{arguments.out}: nothing is wrong")
    return FAILED if found else 0


def _stage(stage: str) -> None:
    if sys.stderr.isatty():
        print(f"{stage} ...", file=sys.stderr)


def _card(arguments: argparse.Namespace) -> int:
    print((arguments.out / CARD).read_text(encoding="utf-8"), end="")
    return 0


def _recipes(arguments: argparse.Namespace) -> int:
    if arguments.name is not None:
        print(json_text(document_of(recipe_named(arguments.name))), end="")
        return 0
    width = max(map(len, RECIPES))
    print("\n".join(f"{ready.name:<{width}}  {ready.sentence}" for ready in RECIPES.values()))
    return 0
