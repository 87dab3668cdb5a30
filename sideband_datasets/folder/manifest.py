"""The manifest: what a dataset is, what it was made with, and the checksum of everything in it."""

from __future__ import annotations

import hashlib
import importlib.metadata
import json
import platform
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from functools import cache
from pathlib import Path

import numpy as np

import sideband_datasets
import signals
import sim
from sideband_datasets.folder.layout import DATA
from sideband_datasets.folder.shards import Receipt
from sideband_datasets.plan.plan import Plan
from sideband_datasets.recipe.read import document_of, identity
from sideband_datasets.row import COLUMNS
from sim.version import PHYSICS_VERSION

SCHEMA_VERSION = 1
PACKAGES = ("numpy", "scipy", "numba", "pyarrow")
"""Whose versions may change a bit."""
SOURCES = (".py", ".json", ".csv")


@cache
def code_sha256() -> str:
    """Of every source and table of the rooms that make rows: any change of them may change a row."""
    found = hashlib.sha256()
    for room in (sim, signals, sideband_datasets):
        assert room.__file__ is not None
        root = Path(room.__file__).parent
        for path in sorted(p for p in root.rglob("*") if p.suffix in SOURCES):
            found.update(f"{root.name}/{path.relative_to(root).as_posix()}\0".encode())
            found.update(path.read_bytes())
    return found.hexdigest()


@cache
def versions() -> dict[str, str]:
    """Of everything that rows depend on."""
    packages = {name: importlib.metadata.version(name) for name in PACKAGES}
    return {"physics": PHYSICS_VERSION, "code": code_sha256()[:16], "python": platform.python_version(), **packages}


def failures_text(receipts: Sequence[Receipt]) -> str:
    """One line of JSON for every recording that could not be made."""
    found = sorted((f for receipt in receipts for f in receipt.failures), key=lambda failure: failure.recording)
    return "".join(json.dumps(asdict(failure), sort_keys=True) + "\n" for failure in found)


def rows_by_class(plan: Plan, receipts: Sequence[Receipt]) -> dict[str, int]:
    """Rows that are there, by class."""
    size = plan.rows_per_recording
    counts = Counter({name: int(np.sum(plan.kind == k)) * size for k, name in enumerate(plan.recipe.classes)})
    for receipt in receipts:
        for failure in receipt.failures:
            counts[failure.fault_type] -= len(failure.rows)
    return {name: counts[name] for name in plan.recipe.classes}


def doubted_rows(receipts: Sequence[Receipt]) -> dict[str, int]:
    """Rows that carry a warning of the simulation, by class; a class without any is left out."""
    counts: Counter[str] = Counter()
    for receipt in receipts:
        counts.update(receipt.doubted)
    return dict(sorted(counts.items()))


def _splits(plan: Plan, receipts: Sequence[Receipt]) -> dict[str, dict[str, int]]:
    return {
        split: {
            "machines": int(np.sum(plan.split_of == number)),
            "recordings": int(plan.of_split(split).size),
            "rows": sum(receipt.rows for receipt in receipts if receipt.split == split),
        }
        for number, split in enumerate(plan.splits)
    }


def manifest(plan: Plan, receipts: Sequence[Receipt], kind: str, others: Mapping[str, str]) -> dict[str, object]:
    """The document; a pure function of what was made, so that the same dataset has the same manifest."""
    return {
        "schema_version": SCHEMA_VERSION,
        "name": plan.recipe.name,
        "recipe": document_of(plan.recipe),
        "recipe_sha256": identity(plan.recipe),
        "format": kind,
        "versions": versions(),
        "rows": sum(receipt.rows for receipt in receipts),
        "failed_recordings": sum(len(receipt.failures) for receipt in receipts),
        "failed_rows": sum(len(failure.rows) for receipt in receipts for failure in receipt.failures),
        "bytes": sum(receipt.bytes for receipt in receipts),
        "classes": rows_by_class(plan, receipts),
        "splits": _splits(plan, receipts),
        "doubted_rows": doubted_rows(receipts),
        "warnings": list(plan.warnings),
        "machines": {plan.machine_id(m): plan.splits[s] for m, s in enumerate(plan.split_of.tolist())},
        "columns": [{"name": c.name, "unit": c.unit, "description": c.sentence} for c in COLUMNS],
        "shards": [
            {"file": f"{DATA}/{r.name}", "split": r.split, "rows": r.rows, "bytes": r.bytes, "sha256": r.sha256}
            for r in receipts
        ],
        "files": dict(others),
    }
