"""From a recipe to a dataset, to a trained classifier, to its test on a recording that no simulation made.

    python examples/dataset_to_classifier.py --recording R.json    # R.json: docs/recordings.md
    python examples/dataset_to_classifier.py                       # without one: tested on simulated machines left out

Two to four core-minutes. All 24 simulated recordings left out were named rightly, and of four measured ones (CWRU,
7 mil) all but the ball fault, which it calls healthy (read off once). So small a model is no match for the shipped
one (`sideband classify`), which has seen livelier backgrounds (docs/sim2real.md).
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq

from learn import features, unknown
from learn.bank import bank
from learn.classify import classify
from learn.describe import sites
from learn.model import Model, save
from learn.orders import FaultOrders
from learn.train import fit_head
from reconcile.kinematics import described_kinematics
from sideband_datasets import Recipe, read_recipe, recipe_named
from sideband_datasets.folder import Progress, Settings, make, resume, unfinished
from sideband_datasets.recipe.read import document_of
from signals.ingest.file import load_description, read_recording
from sim.core.errors import SidebandError


def small_recipe() -> Recipe:
    """The ready bearing rig with fewer recordings, and without labelled peaks, which training does not need."""
    changes = {"name": "example", "count": 160, "peaks": {"spectra": []}}
    return read_recipe({**document_of(recipe_named("bearing-rig")), **changes})


def rows_of(folder: Path, split: str) -> list[dict[str, Any]]:
    """Rows of one split. Machines never are in two: what `test` holds, training has not seen."""
    return [row for path in sorted(folder.glob(f"data/{split}-*.parquet")) for row in pq.read_table(path).to_pylist()]


def features_of(row: dict[str, Any]) -> tuple[Any, Any]:
    """Features where the bearing is known and where it is not, from orders and shapes only: no level, no unit."""
    speed = row["speed_hz"]
    outer, inner, ball, cage = (row[name] / speed for name in ("bpfo_hz", "bpfi_hz", "bsf_hz", "ftf_hz"))
    orders = FaultOrders(outer=outer, inner=inner, ball=2 * ball, cage=cage)
    spectra = bank([np.asarray(row["signal"], dtype=np.float64)], row["sampling_rate_hz"], speed)
    return features.vector(spectra, orders)[0], unknown.vector(spectra)[0]


def trained(rows: list[dict[str, Any]]) -> Model:
    """Two small classifiers: one for bearings whose geometry is told, one for all others."""
    labels = [row["fault_type"] for row in rows]
    classes = tuple(sorted(set(labels), key=lambda label: (label != "healthy", label)))
    machines = [int(m) for m in np.unique([row["machine_id"] for row in rows], return_inverse=True)[1]]
    known, plain = (np.stack(side) for side in zip(*map(features_of, rows), strict=True))
    heads = {"known": fit_head(known, labels, machines, features.NAMES, classes)}
    heads["unknown"] = fit_head(plain, labels, machines, unknown.NAMES, classes)
    return Model(heads=heads, made_by={"rows": len(rows), "machines": len(set(machines)), "real_samples": 0})


def tested_on_simulations(model: Model, rows: list[dict[str, Any]]) -> None:
    """How often each class of the machines left out is named rightly."""
    head = model.heads["known"]
    p = head.probabilities(np.stack([features_of(row)[0] for row in rows]))
    said = [head.classes[k] for k in np.argmax(p, axis=1)]
    for label in head.classes:
        answers = [s for s, row in zip(said, rows, strict=True) if row["fault_type"] == label]
        print(f"  {label:<12} {answers.count(label)} of {len(answers)} named rightly")


def tested_on_recording(model: Model, path: Path) -> None:
    """What the model says of a measured recording; its bearing is taken from the description, where that tells it."""
    recording = read_recording(path)
    drawn = described_kinematics(load_description(path))
    shaft = recording.operating.shaft if recording.operating is not None else None
    found = classify(recording, model, sites(drawn, shaft) if drawn is not None else ())
    print(f"  {path.name}: {found['label']} (geometry {found['geometry']}, {found['turns']:.0f} turns)")
    print("  " + ", ".join(f"{label} {p:.2f}" for label, p in found["probabilities"].items()))


def dataset(recipe: Recipe, out: Path, workers: int) -> None:
    """Make it, or go on with what an interrupted run left; one of another recipe is refused."""
    if not out.is_dir() and not unfinished(out).is_dir():
        make(recipe, out, Settings(workers=workers), told)
    elif resume(out, workers, told)["recipe"] != json.loads(json.dumps(document_of(recipe))):
        raise ValueError(f"{out} holds a dataset of another recipe: give another --out, or remove it")


def told(progress: Progress) -> None:
    """Rows done, on one line."""
    print(f"\r   {progress.rows} of {progress.total} rows", end="", flush=True)


def main(argv: Sequence[str] | None = None) -> int:
    """Make, train, test."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--recording", type=Path, metavar="R.json", help="description of a measured recording")
    parser.add_argument("--recipe", type=Path, help="another recipe, JSON (default: a small bearing rig)")
    parser.add_argument(
        "--out", type=Path, default=Path("out/example"), help="folder of the dataset; one that is begun is gone on with"
    )
    parser.add_argument("--workers", type=int, default=2)
    given = parser.parse_args(argv)
    try:
        recipe = small_recipe() if given.recipe is None else read_recipe(json.loads(given.recipe.read_text()))
        print(f"1. simulating {recipe.count} recordings into {given.out} (what is there is kept)")
        dataset(recipe, given.out, given.workers)
        print("\n2. training on the split `train`")
        model = trained(rows_of(given.out, "train"))
        save(model, given.out.parent / f"{given.out.name}.model.json")
        print("3. tested on simulated machines that training has not seen, which are no real ones")
        tested_on_simulations(model, rows_of(given.out, "test"))
        if given.recording is not None:
            print("4. tested on a recording")
            tested_on_recording(model, given.recording)
    except (SidebandError, OSError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
