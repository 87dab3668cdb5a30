"""The datasets that the bearings' classifier is trained on, made as `sideband dataset make` makes them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

from sideband_datasets.folder import Progress, Settings, make, resume
from sideband_datasets.folder.layout import MANIFEST, unfinished
from sideband_datasets.recipe import Recipe
from sideband_datasets.recipe.bearings import FULL, MACHINES, SHARE_FAST, Variant, bearings_recipe


def recipes(machines: int = MACHINES, seed: int = 1, variant: Variant = FULL) -> tuple[Recipe, Recipe]:
    """Recipes of about so many machines in all; by default the ready ones `bearings-fast` and `bearings-slow`."""
    fast = round(machines * SHARE_FAST)
    return (
        bearings_recipe(fast, fast=True, seed=seed, variant=variant),
        bearings_recipe(machines - fast, fast=False, seed=seed, variant=variant),
    )


@contextmanager
def made(wanted: tuple[Recipe, ...], folder: Path | None, processes: int) -> Iterator[list[Path]]:
    """Their folders, each made below `folder` unless it is there already; of a temporary one, gone afterwards."""
    with TemporaryDirectory() as temporary:
        found = []
        for recipe in wanted:
            out = (folder or Path(temporary)) / recipe.name
            out.parent.mkdir(parents=True, exist_ok=True)
            if unfinished(out).is_dir():
                resume(out, processes, _untold)
            elif not (out / MANIFEST).is_file():
                make(recipe, out, Settings(workers=processes), _untold)
            found.append(out)
        yield found


def _untold(progress: Progress) -> None:
    """Nobody watches."""
