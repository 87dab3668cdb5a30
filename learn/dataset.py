"""Recordings to train on, from the folders of datasets."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from learn.orders import FaultOrders, from_geometry
from sideband_datasets import make_plan, read_recipe
from sideband_datasets.folder.layout import MANIFEST
from sideband_datasets.formats import format_named
from sideband_datasets.recipe.bearings import CLASSES
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError
from sim.core.spec import MachineSpec
from sim.parts.bearing.from_spec import geometry_from_spec


@dataclass(frozen=True, kw_only=True)
class Row:
    """One recording, `samples` of shape (n,). `machine` is one number in all folders that are read together.

    `orders` are those of the bearing's drawing, without the slip that it has.
    """

    machine: int
    label: str
    samples: FloatArray
    rate_hz: float
    speed_hz: float
    orders: FaultOrders


def machines_of(folders: Sequence[Path]) -> list[str]:
    """Names of the machines of folders that are read together, by their numbers."""
    return [name for folder in folders for name in sorted(_manifest(folder)["machines"])]


def rows_of(folders: Sequence[Path], part: int = 0, parts: int = 1) -> Iterator[Row]:
    """Rows of every `parts`-th machine, from `part` on. A row with no speed or bearing is left out.

    SpecError for a folder that holds no dataset, or one of other classes than healthy, outer, inner and ball.
    """
    before = 0
    for folder in folders:
        document = _manifest(folder)
        numbers = {name: before + k for k, name in enumerate(sorted(document["machines"]))}
        before += len(numbers)
        specs = _machines(json.dumps(document["recipe"]))
        read = format_named(document["format"]).read
        for shard in document["shards"]:
            for record in read(folder / shard["file"]):
                machine = numbers[record["machine_id"]]
                if machine % parts != part or not record["speed_hz"] or not record["bearing_id"]:
                    continue
                yield Row(
                    machine=machine,
                    label=record["fault_type"],
                    samples=np.asarray(record["signal"], dtype=np.float64),
                    rate_hz=record["sampling_rate_hz"],
                    speed_hz=record["speed_hz"],
                    orders=_orders(specs[record["machine_id"]], record["bearing_id"]),
                )


@lru_cache(maxsize=4)
def _machines(recipe: str) -> dict[str, MachineSpec]:
    """Machines of a recipe by name: planned once in a process, whatever number of parts it reads."""
    return {m.machine_id: m.spec for m in make_plan(read_recipe(json.loads(recipe))).machines}


def _manifest(folder: Path) -> dict[str, Any]:
    path = folder / MANIFEST
    if not path.is_file():
        message, allowed = f"holds no {MANIFEST}", "the folder of `sideband dataset make`"
        raise SpecError(Problem(field="--dataset", message=message, given=str(folder), allowed=allowed))
    document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    other = sorted(set(document["classes"]) - set(CLASSES))
    if other:
        message = f"has classes that are none of a bearing's: {', '.join(other)}"
        raise SpecError(Problem(field="--dataset", message=message, given=str(folder), allowed=", ".join(CLASSES)))
    return document


def _orders(machine: MachineSpec, bearing: str) -> FaultOrders:
    return from_geometry(geometry_from_spec(next(b for b in machine.bearings if b.name == bearing)))
