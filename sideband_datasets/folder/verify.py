"""Whether a dataset is what its manifest says, free of leaks, and what its recipe makes."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from tarfile import TarError
from typing import Any
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from sideband_datasets.folder.layout import DATA, FAILURES, MANIFEST, files_below, sha256, unfinished
from sideband_datasets.folder.manifest import versions
from sideband_datasets.formats import FORMATS, Record, fingerprint, record_of
from sideband_datasets.make.stream import rows
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.seeds import Stream, generator
from sideband_datasets.plan.tried import make_plan
from sideband_datasets.recipe.read import checksum, read_recipe
from sim.core.errors import Problem, SpecError

Told = Callable[[str], object]


@dataclass(frozen=True, kw_only=True)
class Finding:
    """One thing wrong: the file or row, and what."""

    where: str
    what: str

    def __str__(self) -> str:
        return f"{self.where}: {self.what}"


def verify(out: Path, *, remake: int = 0, seed: int = 0, told: Told = str) -> list[Finding]:
    """Everything that is wrong with a dataset; empty when nothing is. `remake`: rows made again, drawn by `seed`.

    SpecError when there is no dataset to look at.
    """
    if not (out / MANIFEST).is_file():
        hint = "it is unfinished: `sideband dataset resume`" if unfinished(out).exists() else "a finished dataset"
        message = f"has no {MANIFEST}"
        raise SpecError(Problem(field="DIR", message=message, given=str(out), allowed=hint))
    try:
        manifest = json.loads((out / MANIFEST).read_text(encoding="utf-8"))
        plan = make_plan(read_recipe(manifest["recipe"]))
        suffix = FORMATS[manifest["format"]].suffix
        listed = {e["file"]: {key: e[key] for key in ("sha256", "split", "rows")} for e in manifest["shards"]}
        versions_then, others = dict(manifest["versions"]), dict(manifest["files"])
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        return [Finding(where=MANIFEST, what=f"cannot be read: {error!r}")]
    told("checksums")
    found = list(_files(out, manifest, listed, others, suffix))
    told("rows")
    broken = {finding.where for finding in found}
    seen = _Seen(plan=plan)
    for file, entry in listed.items():
        if file not in broken:
            found += seen.shard(out, file, entry, manifest["format"])
    found += seen.missing(out, complete=not broken & {*listed, FAILURES})
    if remake:
        told("rows made again")
        found += _remade(versions_then, seen, remake, seed)
    return found


def _files(
    out: Path, manifest: Mapping[str, Any], listed: Mapping[str, Any], others: Mapping[str, Any], suffix: str
) -> Iterator[Finding]:
    if manifest.get("recipe_sha256") != checksum(manifest["recipe"]):
        yield Finding(where=MANIFEST, what="the recipe is not the one that was made (its checksum differs)")
    expected = {file: entry["sha256"] for file, entry in listed.items()} | dict(others)
    for file, wanted in expected.items():
        if not (out / file).exists():
            yield Finding(where=file, what="is missing")
        elif sha256(out / file) != wanted:
            yield Finding(where=file, what="differs from what was written (its checksum is another)")
    for path in files_below(out):
        name = path.relative_to(out).as_posix()
        inside = any(name.startswith(f"{file}/") for file in listed) if suffix == ".zarr" else False
        if name not in expected and name != MANIFEST and not inside:
            yield Finding(where=name, what="is surplus: the manifest does not list it")


class _Seen:
    """What the rows of all shards say, gathered row by row."""

    def __init__(self, *, plan: Plan) -> None:
        self.plan = plan
        # Arrays, not dictionaries: a dataset may have millions of rows.
        self.there = np.zeros(plan.rows, dtype=np.bool_)
        self.fingerprints = np.zeros((plan.rows, 32), dtype=np.uint8)
        self._split_of: dict[tuple[str, str], str] = {}
        self._told: set[tuple[str, str]] = set()

    def shard(self, out: Path, file: str, entry: Mapping[str, Any], kind: str) -> list[Finding]:
        """Findings of one shard."""
        found: list[Finding] = []
        count = 0
        try:
            for record in FORMATS[kind].read(out / file):
                count += 1
                found += self._row(file, entry["split"], record)
        except (OSError, ValueError, KeyError, BadZipFile, TarError) as error:
            return [*found, Finding(where=file, what=f"cannot be read: {error}")]
        if count != entry["rows"]:
            found.append(Finding(where=file, what=f"has {count} rows; the manifest says {entry['rows']}"))
        return found

    def _row(self, file: str, split: str, record: Mapping[str, Any]) -> Iterator[Finding]:
        number, name = int(record["row"]), str(record["signal_id"])
        if not 0 <= number < self.plan.rows:
            yield Finding(where=file, what=f"row {name} is not of this dataset")
            return
        if self.there[number]:
            yield Finding(where=file, what=f"row {name} occurs twice")
        self.there[number] = True
        self.fingerprints[number] = _bytes(dict(record))
        if record["split"] != split:
            yield Finding(where=file, what=f"row {name} is of split {record['split']} in a file of {split}")
        for what in ("machine_id", "path_id"):
            key = what, str(record[what])
            first = self._split_of.setdefault(key, split)
            if first != split and key not in self._told:
                self._told.add(key)
                yield Finding(where=file, what=f"leak: {what} {key[1]} occurs in {first} and in {split}")
        planned = self.plan.machines[int(self.plan.machine[number // self.plan.rows_per_recording])]
        if record["machine_id"] != planned.machine_id:
            yield Finding(where=file, what=f"row {name} is of {record['machine_id']}; planned {planned.machine_id}")

    def missing(self, out: Path, *, complete: bool) -> Iterator[Finding]:
        """Rows that are neither there nor listed as failed; told only where every shard could be read."""
        path = out / FAILURES
        if not complete or not path.is_file():
            return
        lines = path.read_text(encoding="utf-8").splitlines()
        left = ~self.there
        left[[row for line in lines for row in json.loads(line)["rows"]]] = False
        gone = np.flatnonzero(left)
        if gone.size:
            some = ", ".join(map(str, gone[:5].tolist()))
            yield Finding(where=DATA, what=f"{gone.size} rows are missing and not listed as failed: {some} ...")


def _bytes(record: Record) -> NDArray[np.uint8]:
    """The fingerprint of a row, shape (32,)."""
    return np.frombuffer(bytes.fromhex(fingerprint(record)), dtype=np.uint8)


def _remade(made: Mapping[str, Any], seen: _Seen, count: int, seed: int) -> Iterator[Finding]:
    there = np.flatnonzero(seen.there)
    chosen = generator(seed, Stream.REMAKE).choice(there, size=min(count, there.size), replace=False)
    now = versions()
    changed = [f"{key} {made.get(key)}, now {now[key]}" for key in now if made.get(key) != now[key]]
    why = f" (it was made with other versions: {'; '.join(changed)})" if changed else ""
    for row in rows(seen.plan.recipe, sorted(chosen.tolist())):
        if not np.array_equal(_bytes(record_of(row)), seen.fingerprints[row.row]):
            yield Finding(where=row.signal_id, what=f"differs from the row made again{why}")
