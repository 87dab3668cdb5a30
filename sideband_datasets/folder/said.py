"""What a dataset says of itself beside its rows: manifest, list of failures, card. Held against rows and plan."""

from __future__ import annotations

import json
import re
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import Any

from sideband_datasets.folder.card import card
from sideband_datasets.folder.croissant import croissant
from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import CARD, CROISSANT, DATA, FAILURES, MANIFEST, json_text, size_of
from sideband_datasets.folder.manifest import manifest, versions
from sideband_datasets.folder.seen import Seen
from sideband_datasets.folder.shards import Receipt, failure_from
from sideband_datasets.formats import FORMATS
from sideband_datasets.make.batch import Failure
from sideband_datasets.plan.plan import Plan

WORDED = ("warnings", "columns", "recipe", "recipe_sha256", "doubted_rows")
"""Of the manifest: in the words of the version that made it, or unknown to others: compared with the same one only."""
OF_FAILURES = ("failed_rows", "failed_recordings", "classes")
LONGEST = 120
MADE_WITH = re.compile(r"Made with (.+)\.$", re.MULTILINE)


def failures_in(out: Path, plan: Plan, seen: Seen) -> tuple[list[Failure], list[Finding]]:
    """Recordings that are listed as failed, and what of the list contradicts plan or rows."""
    found: list[Failure] = []
    wrong: list[Finding] = []
    size = plan.rows_per_recording
    try:
        lines = (out / FAILURES).read_text(encoding="utf-8").splitlines()
        found = [failure_from(json.loads(line)) for line in lines]
        for failure in found:
            number = failure.recording
            if not 0 <= number < plan.recipe.count or failure.rows != tuple(range(number * size, number * size + size)):
                wrong.append(Finding(where=FAILURES, what=f"recording {number} and its rows are not of this dataset"))
                continue
            planned = {
                "recording_id": f"{plan.recipe.name}-{number:06d}",
                "machine_id": plan.machine_id(int(plan.machine[number])),
                "fault_type": plan.recipe.classes[int(plan.kind[number])],
                "split": plan.split(number),
            }
            for name, value in planned.items():
                if getattr(failure, name) != value:
                    what = f"recording {number} has {name} {getattr(failure, name)!r}, planned {value!r}"
                    wrong.append(Finding(where=FAILURES, what=what))
            if seen.there[list(failure.rows)].any():
                wrong.append(Finding(where=FAILURES, what=f"recording {number} is listed as failed, and is there"))
    except (OSError, ValueError, KeyError, TypeError) as error:
        return [], [Finding(where=FAILURES, what=f"cannot be read: {error!r}")]
    return found, wrong


def receipts_of(out: Path, document: Mapping[str, Any], seen: Seen, failures: Collection[Failure]) -> list[Receipt]:
    """What a maker would have signed for the shards as they are; for those that cannot be read, what is said."""
    found = []
    for number, entry in enumerate(document["shards"]):
        file = entry["file"]
        found.append(
            Receipt(
                name=file.removeprefix(f"{DATA}/"),
                split=entry["split"],
                rows=seen.rows_of.get(file, int(entry["rows"])),
                bytes=size_of(out / file) if file in seen.rows_of else int(entry["bytes"]),
                sha256=entry["sha256"],
                machines=tuple(sorted(seen.machines_of.get(file, ()))),
                paths=tuple(sorted(seen.paths_of.get(file, ()))),
                failures=() if number else tuple(failures),
                doubted=dict(seen.doubted_of.get(file, {})),
            )
        )
    return found


def said_findings(
    out: Path, document: Mapping[str, Any], seen: Seen, receipts: list[Receipt], broken: Collection[str]
) -> Iterator[Finding]:
    """Where the manifest differs from the one that rows and plan give. `broken`: files that differ already."""
    expected = manifest(seen.plan, receipts, str(document["format"]), document["files"])
    if seen.rows_of.keys() == {entry["file"] for entry in document["shards"]}:
        expected["classes"] = {name: seen.classes[name] for name in seen.plan.recipe.classes}
    skipped = {"versions", "shards"} | ({*OF_FAILURES} if FAILURES in broken else set())
    if document["versions"] != versions():
        skipped |= {*WORDED}
        yield from _names_of_columns(document, expected)
    for key in sorted((expected.keys() | document.keys()) - skipped):
        if key not in expected:
            yield Finding(where=MANIFEST, what=f"{key} is surplus")
        elif document.get(key) != expected[key]:
            what = f"{key} is {_short(document.get(key))}; rows and plan give {_short(expected[key])}"
            yield Finding(where=MANIFEST, what=what)
    yield from _shards(document, seen.plan, receipts)
    if CARD not in broken:
        yield from _card(out, document)


def _short(value: object) -> str:
    text = json.dumps(value, sort_keys=True)
    return text if len(text) <= LONGEST else f"{text[:LONGEST]} ..."


def _names_of_columns(document: Mapping[str, Any], expected: Mapping[str, Any]) -> Iterator[Finding]:
    listed = document.get("columns")
    columns = listed if isinstance(listed, list) else []
    names = [(c.get("name"), c.get("unit")) if isinstance(c, Mapping) else None for c in columns]
    if names != [(c["name"], c["unit"]) for c in expected["columns"]]:
        yield Finding(where=MANIFEST, what="columns are not those of the rows")


def _shards(document: Mapping[str, Any], plan: Plan, receipts: list[Receipt]) -> Iterator[Finding]:
    """Sizes of shards, and their names: loaders take the split from them."""
    suffix = re.escape(FORMATS[str(document["format"])].suffix)
    for entry, receipt in zip(document["shards"], receipts, strict=True):
        file, split = entry["file"], entry["split"]
        if entry["bytes"] != receipt.bytes:
            yield Finding(where=file, what=f"has {receipt.bytes} bytes; the manifest says {entry['bytes']}")
        if split not in plan.splits:
            yield Finding(where=file, what=f"is said to be of {split!r}, which is no split")
        elif not re.fullmatch(rf"{DATA}/{re.escape(split)}-\d+-of-\d+{suffix}", file):
            yield Finding(where=file, what=f"is not named as a shard of {split}")


def _card(out: Path, document: Mapping[str, Any]) -> Iterator[Finding]:
    """Versions, recipe and checksums stand in manifest and card."""
    text = (out / CARD).read_text(encoding="utf-8", errors="replace")
    made = MADE_WITH.search(text)
    wanted = {f"{name} {version}" for name, version in dict(document["versions"]).items()}
    if made is None or set(made.group(1).split(", ")) != wanted:
        told = made.group(1) if made is not None else "nothing"
        yield Finding(where=MANIFEST, what=f"versions are not those that {CARD} says it was made with: {told}")
    if f"recipe {str(document.get('recipe_sha256'))[:16]})" not in text:
        yield Finding(where=MANIFEST, what=f"the recipe is not the one that {CARD} names")
    for entry in document["shards"]:
        if str(entry["sha256"]) not in text:
            yield Finding(where=entry["file"], what=f"has another checksum in {CARD}")


def written_findings(out: Path, document: Mapping[str, Any], plan: Plan, receipts: list[Receipt]) -> Iterator[Finding]:
    """Card and Croissant against what the same version writes; nothing where another version made them."""
    if document["versions"] != versions():
        return
    kind = str(document["format"])
    texts = {CARD: card(plan, receipts, kind), CROISSANT: json_text(croissant(plan, receipts, kind))}
    for name, text in texts.items():
        if (out / name).is_file() and (out / name).read_text(encoding="utf-8", errors="replace") != text:
            yield Finding(where=name, what="is not what rows and plan give")
