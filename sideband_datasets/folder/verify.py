"""Whether a dataset is what its manifest says, free of leaks, and what its recipe makes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import DATA, FAILURES, MANIFEST
from sideband_datasets.folder.listed import file_findings
from sideband_datasets.folder.manifest import versions
from sideband_datasets.folder.opened import opened
from sideband_datasets.folder.said import failures_in, receipts_of, said_findings, written_findings
from sideband_datasets.folder.seen import Seen, row_hash
from sideband_datasets.formats import record_of
from sideband_datasets.make.batch import Failure
from sideband_datasets.make.stream import rows
from sideband_datasets.plan.seeds import Stream, generator
from sideband_datasets.plan.tried import make_plan
from sideband_datasets.recipe.read import read_recipe
from sim.core.errors import SidebandError

Told = Callable[[str], object]


def verify(out: Path, *, remake: int = 0, seed: int = 0, told: Told = str) -> list[Finding]:
    """Everything that is wrong with a dataset; empty when nothing is. `remake`: rows made again, drawn by `seed`.

    SpecError when there is no dataset to look at.
    """
    manifest = opened(out)
    if isinstance(manifest, Finding):
        return [manifest]
    listed = {e["file"]: {key: e[key] for key in ("sha256", "split", "rows")} for e in manifest["shards"]}
    try:
        plan = make_plan(read_recipe(manifest["recipe"]))
    except SidebandError as error:
        return [Finding(where=MANIFEST, what=f"its recipe is refused: {error}")]
    told("checksums")
    found = list(file_findings(out, manifest))
    told("rows")
    broken = {finding.where for finding in found}
    seen = Seen(plan=plan)
    for file, entry in listed.items():
        if file not in broken:
            found += seen.shard(out, file, entry, manifest["format"])
    found += seen.signals.repeated()
    found += _said(out, manifest, seen, broken, clean=not found)
    if remake:
        told("rows made again")
        found += _remade(dict(manifest["versions"]), seen, remake, seed)
    return found


def _said(out: Path, manifest: Mapping[str, Any], seen: Seen, broken: set[str], *, clean: bool) -> list[Finding]:
    """What the files beside the shards say; of missing rows only where every shard could be read. `clean`: nothing
    was found in files and rows.
    """
    failures: list[Failure] = []
    found: list[Finding] = []
    if FAILURES not in broken:
        failures, found = failures_in(out, seen.plan, seen)
        if not broken & {entry["file"] for entry in manifest["shards"]}:
            found += _missing(seen, failures)
    receipts = receipts_of(out, manifest, seen, failures)
    found += said_findings(out, manifest, seen, receipts, broken)
    if clean and not found:
        found += written_findings(out, manifest, seen.plan, receipts)
    return found


def _missing(seen: Seen, failures: Iterable[Failure]) -> Iterator[Finding]:
    """Rows that are neither there nor listed as failed."""
    left = ~seen.there
    for failure in failures:
        left[[row for row in failure.rows if 0 <= row < left.size]] = False
    gone = np.flatnonzero(left)
    if gone.size:
        some = ", ".join(map(str, gone[:5].tolist()))
        yield Finding(where=DATA, what=f"{gone.size} rows are missing and not listed as failed: {some} ...")


def _remade(made: Mapping[str, Any], seen: Seen, count: int, seed: int) -> Iterator[Finding]:
    there = np.flatnonzero(seen.there)
    chosen = generator(seed, Stream.REMAKE).choice(there, size=min(count, there.size), replace=False)
    now = versions()
    changed = [f"{key} {made.get(key)}, now {now[key]}" for key in now if made.get(key) != now[key]]
    why = f" (it was made with other versions: {'; '.join(changed)})" if changed else ""
    for row in rows(seen.plan.recipe, sorted(chosen.tolist())):
        if not np.array_equal(row_hash(record_of(row)), seen.fingerprints[row.row]):
            yield Finding(where=row.signal_id, what=f"differs from the row made again{why}")
