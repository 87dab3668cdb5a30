"""The datasets that the bearings' classifier is trained on, made as `sideband dataset make` makes them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, wait
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from learn.sim2real.pools import AtOnce, pool_of
from sideband_datasets.folder import Progress, Settings, make, resume
from sideband_datasets.folder.layout import MANIFEST, SETTINGS, STATE, unfinished
from sideband_datasets.recipe import Recipe
from sideband_datasets.recipe.bearings import FULL, MACHINES, SHARE_FAST, Variant, bearings_recipe
from sideband_datasets.recipe.read import identity, read_recipe
from sim.core.errors import Problem, SpecError


def recipes(machines: int = MACHINES, seed: int = 1, variant: Variant = FULL) -> tuple[Recipe, Recipe]:
    """Recipes of about so many machines in all; by default the ready ones `bearings-fast` and `bearings-slow`."""
    fast = round(machines * SHARE_FAST)
    return (
        bearings_recipe(fast, fast=True, seed=seed, variant=variant),
        bearings_recipe(machines - fast, fast=False, seed=seed, variant=variant),
    )


@contextmanager
def begun(
    wanted: tuple[Recipe, ...], folder: Path | None, processes: int, pool: Executor
) -> Iterator[Callable[[], list[Path]]]:
    """As `made`, by a pool that may have other work too: what is given waits for the folders."""
    with TemporaryDirectory() as temporary:
        outs = [(folder or Path(temporary)) / recipe.name for recipe in wanted]
        shares = _shared(processes, len(wanted))
        jobs = [pool.submit(_made, *one) for one in zip(wanted, outs, shares, strict=True)]

        def folders() -> list[Path]:
            for job in jobs:
                job.result()
            return outs

        try:
            yield folders
        finally:
            wait([job for job in jobs if not job.cancel()])  # what runs would make its folder anew after that is gone


@contextmanager
def made(wanted: tuple[Recipe, ...], folder: Path | None, processes: int) -> Iterator[list[Path]]:
    """Their folders, side by side: each made below `folder` unless it is there; of a temporary one, gone afterwards."""
    side_by_side = processes > 1 and len(wanted) > 1
    with (
        pool_of(min(processes, len(wanted)) if side_by_side else 1) as pool,
        begun(wanted, folder, processes if side_by_side else processes * len(wanted), pool or AtOnce()) as folders,
    ):
        yield folders()


def _shared(processes: int, among: int) -> list[int]:
    """So many for each: a small dataset is one shard, at which others would wait."""
    return [max(1, processes // among + (k < processes % among)) for k in range(among)]


def _made(recipe: Recipe, out: Path, processes: int) -> None:
    """One folder, made, made to the end, or there already."""
    out.parent.mkdir(parents=True, exist_ok=True)
    _check_same(recipe, out)
    if unfinished(out).is_dir():
        resume(out, processes, _untold)
    elif not (out / MANIFEST).is_file():
        make(recipe, out, Settings(workers=processes), _untold)


def _check_same(recipe: Recipe, out: Path) -> None:
    """SpecError for a folder that holds another dataset, or was begun as one, under the same name."""
    for path in (out / MANIFEST, unfinished(out) / STATE / SETTINGS):
        if path.is_file():
            there = read_recipe(json.loads(path.read_text(encoding="utf-8"))["recipe"])
            if identity(there) != identity(recipe):
                given = f"seed {there.seed}, {there.count} recordings"
                wanted = f"seed {recipe.seed}, {recipe.count} recordings, or another folder"
                message = f"{out.name} is there, of another recipe"
                raise SpecError(Problem(field="--keep", message=message, given=given, allowed=wanted))


def _untold(progress: Progress) -> None:
    """Nobody watches."""
