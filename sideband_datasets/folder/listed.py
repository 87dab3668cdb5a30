"""Files of a dataset against the checksums in its manifest: damaged, missing, surplus."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import MANIFEST, STATE, files_below, sha256
from sideband_datasets.formats import FORMATS
from sideband_datasets.recipe.read import checksum


def checksums(manifest: Mapping[str, Any]) -> dict[str, str]:
    """Of every file (or folder of a shard) that a manifest lists; KeyError, TypeError when it is no manifest."""
    return {entry["file"]: entry["sha256"] for entry in manifest["shards"]} | dict(manifest["files"])


def file_findings(out: Path, manifest: Mapping[str, Any]) -> Iterator[Finding]:
    """What is damaged, missing or surplus in the folder `out`."""
    if manifest.get("recipe_sha256") != checksum(manifest["recipe"]):
        yield Finding(where=MANIFEST, what="the recipe is not the one that was made (its checksum differs)")
    for file, wanted in checksums(manifest).items():
        if not (out / file).exists():
            yield Finding(where=file, what="is missing")
        elif sha256(out / file) != wanted:
            yield Finding(where=file, what="differs from what was written (its checksum is another)")
    yield from surplus(out, manifest)


def surplus(out: Path, manifest: Mapping[str, Any], *, made: bool = False) -> Iterator[Finding]:
    """Files that the manifest does not list; `made`: those of the making are no surplus yet."""
    expected = checksums(manifest)
    folders = tuple(f"{file}/" for file in expected) if FORMATS[manifest["format"]].suffix == ".zarr" else ()
    ours = (*folders, f"{STATE}/") if made else folders
    for path in files_below(out):
        name = path.relative_to(out).as_posix()
        if name not in expected and name != MANIFEST and not name.startswith(ours):
            yield Finding(where=name, what="is surplus: the manifest does not list it")
