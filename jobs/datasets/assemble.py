"""After the last shard: manifest, card, Croissant and list of failures, and where every file of the dataset lies."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from jobs.datasets.divide import balance_of, division_of
from jobs.datasets.shard import check_versions, put_manifest, receipt_of, stored_name
from jobs.datasets.words import SHARD
from jobs.errors import ResultNotReady
from jobs.ports import ArtefactStore, JobCatalogue
from jobs.record import ResultRef
from jobs.reporter import Reporter
from jobs.results import FileEntry, json_bytes, put_file
from sideband_datasets.folder.card import card
from sideband_datasets.folder.croissant import croissant
from sideband_datasets.folder.layout import CARD, CROISSANT, DATA, FAILURES, MANIFEST, json_text
from sideband_datasets.folder.manifest import failures_text, manifest
from sideband_datasets.folder.shards import Receipt
from sideband_datasets.plan import Plan

STORED_MANIFEST = "dataset.json"
"""The dataset's manifest among the files of the result, which has a table of contents of another kind."""
PLACES = "places.json"
"""Path in the dataset to key in the artefact store; the only file that attempts differ in, so outside the contents."""


def assemble_dataset(
    catalogue: JobCatalogue,
    artefacts: ArtefactStore,
    reporter: Reporter,
    request: Mapping[str, object],
    *,
    attempt: int,
    expires_at: Callable[[], float | None],
) -> ResultRef:
    """Describe the shards under the dataset's own prefix. Nobody reads that before the dataset is successful."""
    dataset_id = str(request["dataset"])
    reporter.stage("reading receipts", 0.0)
    document = catalogue.request_of(dataset_id)
    check_versions(document)
    plan, shards = division_of(document)
    prefix = f"{dataset_id}/{catalogue.get(dataset_id).attempt}"
    places: dict[str, dict[str, object]] = {}
    receipts: list[Receipt] = []
    parts = [part for part in catalogue.parts.of(dataset_id) if part.kind == SHARD]
    for done, part in enumerate(parts):
        if part.result is None or part.gone is not None:
            raise ResultNotReady(part.id, part.status)
        reporter.simulating(done / len(shards))
        receipt, files = receipt_of(artefacts, f"{part.id}/{part.result.attempt}")
        receipts.append(receipt)
        for path, entry in files.items():
            key = f"{part.id}/{part.result.attempt}/{stored_name(path)}"
            places[f"{DATA}/{path}"] = {"key": key, **entry.model_dump()}
    reporter.stage("describing", 0.9)
    texts = _texts(plan, receipts, str(document["format"]))
    stored = {name: put_file(artefacts, f"{prefix}/{name}", [text.encode()]) for name, text in texts.items()}
    own = dict(stored)
    own[STORED_MANIFEST] = _put_manifest(artefacts, prefix, plan, receipts, str(document["format"]), stored)
    for name, entry in own.items():
        path = MANIFEST if name == STORED_MANIFEST else name
        places[path] = {"key": f"{prefix}/{name}", **entry.model_dump()}
    own["summary.json"] = put_file(artefacts, f"{prefix}/summary.json", [json_bytes(_summary(plan, receipts))])
    put_file(artefacts, f"{prefix}/{PLACES}", [json_bytes(places)])
    return put_manifest(artefacts, prefix, attempt, plan, own, expires_at())


def _texts(plan: Plan, receipts: Sequence[Receipt], kind: str) -> dict[str, str]:
    """Everything beside the shards and the manifest."""
    return {
        FAILURES: failures_text(receipts),
        CARD: card(plan, receipts, kind),
        CROISSANT: json_text(croissant(plan, receipts, kind)),
    }


def _put_manifest(
    artefacts: ArtefactStore,
    prefix: str,
    plan: Plan,
    receipts: Sequence[Receipt],
    kind: str,
    others: Mapping[str, FileEntry],
) -> FileEntry:
    document = manifest(plan, receipts, kind, {name: entry.sha256 for name, entry in others.items()})
    return put_file(artefacts, f"{prefix}/{STORED_MANIFEST}", [json_text(document).encode()])


def _summary(plan: Plan, receipts: Sequence[Receipt]) -> dict[str, object]:
    """Rows that are there by split and class, and how many are not."""
    balance = balance_of(plan)
    failures = [failure for receipt in receipts for failure in receipt.failures]
    for failure in failures:
        balance[failure.split][failure.fault_type] -= len(failure.rows)
    return {
        "dataset": plan.recipe.name,
        "rows": sum(receipt.rows for receipt in receipts),
        "failed_recordings": len(failures),
        "balance": balance,
    }
