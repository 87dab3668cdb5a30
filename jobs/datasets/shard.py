"""What a worker does with a shard: makes it on its own disk, keeps its files and a receipt in the artefact store."""

from __future__ import annotations

import json
import re
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

from jobs.datasets.divide import division_again
from jobs.errors import DatasetRefused
from jobs.ports import ArtefactStore, JobCatalogue
from jobs.record import ResultRef
from jobs.reporter import Reporter
from jobs.results import FileEntry, Manifest, json_bytes, put_file
from sideband_datasets.folder.layout import DATA, STATE, files_below
from sideband_datasets.folder.manifest import versions
from sideband_datasets.folder.shards import Receipt, make_shard, receipt_from
from sideband_datasets.plan import Plan
from sim.core.errors import Problem, SpecError
from sim.version import PHYSICS_VERSION

RECEIPT = "receipt.json"
STORING = 0.95
_PIECE = 1 << 20


def make_part(
    catalogue: JobCatalogue,
    artefacts: ArtefactStore,
    reporter: Reporter,
    request: Mapping[str, object],
    *,
    prefix: str,
    attempt: int,
    expires_at: Callable[[], float | None],
) -> ResultRef:
    """Make the shard that the request names; DatasetRefused when this worker would make other rows than the rest."""
    reporter.stage("planning", 0.0)
    document = catalogue.request_of(str(request["dataset"]))
    check_versions(document)
    kind = str(document["format"])
    with tempfile.TemporaryDirectory(prefix="sideband-") as name:
        folder = Path(name)
        for inner in (DATA, STATE):
            (folder / inner).mkdir()
        try:
            plan, shards = division_again(document)
            shard = shards[cast(int, request["shard"])]
            count = _counting(reporter, len(shard.recordings) * plan.rows_per_recording)
            receipt = make_shard(plan, shard, folder, kind, made=count, cancelled=reporter.cancelled)
        except SpecError as error:
            raise DatasetRefused(error.problems) from error
        reporter.stage("storing", STORING)
        files = _kept(artefacts, prefix, folder / DATA)
    return _described(artefacts, prefix, attempt, plan, receipt, files, expires_at())


def check_versions(document: Mapping[str, object], own: Mapping[str, str] | None = None) -> None:
    """Raise DatasetRefused unless this process, of the `own` versions, makes the rows that were asked for."""
    wanted, here = cast(Mapping[str, str], document["versions"]), versions() if own is None else own
    if wanted != here:
        other = [f"{name} {here.get(name)}, not {wanted.get(name)}" for name in here if here[name] != wanted.get(name)]
        message = f"a worker has other versions ({'; '.join(other)}): its rows would not be of one kind with the rest"
        raise DatasetRefused([Problem(field="versions", message=message, allowed="the same versions everywhere")])


def receipt_of(artefacts: ArtefactStore, prefix: str) -> tuple[Receipt, dict[str, FileEntry]]:
    """What a stored shard holds, and its files by their path below the dataset's `data`."""
    document: dict[str, Any] = json_loaded(artefacts, f"{prefix}/{RECEIPT}")
    files = {path: FileEntry(**entry) for path, entry in document.pop("files").items()}
    return receipt_from(document), files


def json_loaded(artefacts: ArtefactStore, key: str) -> dict[str, Any]:
    """A stored document."""
    found: dict[str, Any] = json.loads(artefacts.read(key))
    return found


def stored_name(path: str) -> str:
    """A file's path as an artefact may be called: none of its parts begins with a dot."""
    return re.sub(r"(^|/)\.", r"\1dot.", path)


def _counting(reporter: Reporter, total: int) -> Callable[[int], None]:
    done = 0

    def count(rows: int) -> None:
        nonlocal done
        done += rows
        reporter.simulating(done / total)

    return count


def _pieces(path: Path) -> Iterator[bytes]:
    with path.open("rb") as stream:
        while piece := stream.read(_PIECE):
            yield piece


def _kept(artefacts: ArtefactStore, prefix: str, data: Path) -> dict[str, FileEntry]:
    names = {file: file.relative_to(data).as_posix() for file in files_below(data)}
    return {path: put_file(artefacts, f"{prefix}/{stored_name(path)}", _pieces(file)) for file, path in names.items()}


def _described(
    artefacts: ArtefactStore,
    prefix: str,
    attempt: int,
    plan: Plan,
    receipt: Receipt,
    files: Mapping[str, FileEntry],
    expires_at: float | None,
) -> ResultRef:
    """As a simulation's result is kept (`jobs.results`); the receipt tells the rest."""
    listed = {path: entry.model_dump() for path, entry in files.items()}
    summary = {"shard": receipt.name, "rows": receipt.rows, "failed_recordings": len(receipt.failures)}
    own = {
        RECEIPT: put_file(artefacts, f"{prefix}/{RECEIPT}", [json_bytes({**asdict(receipt), "files": listed})]),
        "summary.json": put_file(artefacts, f"{prefix}/summary.json", [json_bytes(summary)]),
    }
    return put_manifest(artefacts, prefix, attempt, plan, {**files, **own}, expires_at)


def put_manifest(
    artefacts: ArtefactStore,
    prefix: str,
    attempt: int,
    plan: Plan,
    files: Mapping[str, FileEntry],
    expires_at: float | None,
) -> ResultRef:
    """The table of contents, last: with it the result is there."""
    manifest = Manifest(
        physics_version=PHYSICS_VERSION,
        seed=plan.recipe.seed,
        sampling_rate_hz=plan.recipe.sampling_rate_hz,
        samples=0,
        channels=(),
        spectra=(),
        files=dict(files),
    )
    table = put_file(artefacts, f"{prefix}/manifest.json", [json_bytes(manifest.model_dump(mode="json"))])
    size = table.bytes + sum(entry.bytes for entry in files.values())
    return ResultRef(attempt=attempt, size_bytes=size, sha256=table.sha256, expires_at=expires_at)
