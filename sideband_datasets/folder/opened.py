"""A finished dataset's folder as it is met: its manifest, and the files that it lists."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Any

from sideband_datasets.folder.finding import Finding
from sideband_datasets.folder.layout import MANIFEST, files_below, sha256, unfinished
from sideband_datasets.folder.listed import checksums
from sideband_datasets.formats import FORMATS
from sideband_datasets.recipe.read import read_recipe
from sim.core.errors import Problem, SpecError


@dataclass(frozen=True, kw_only=True)
class ListedFile:
    """`name`: below the folder, with `/`. `digest`: SHA-256, hexadecimal; none for a file of a shard that is a folder,
    whose files have one checksum together.
    """

    name: str
    path: Path
    size: int
    digest: str | None

    def sha256(self) -> str:
        """Of its bytes, hexadecimal: the manifest's, or read."""
        return self.digest or sha256(self.path)


def opened(out: Path) -> dict[str, Any] | Finding:
    """The manifest, or what is wrong with it. SpecError when there is no dataset to look at."""
    if not (out / MANIFEST).is_file():
        hint = "it is unfinished: `sideband dataset resume`" if unfinished(out).exists() else "a finished dataset"
        message = f"has no {MANIFEST}"
        raise SpecError(Problem(field="DIR", message=message, given=str(out), allowed=hint))
    try:
        manifest: dict[str, Any] = json.loads((out / MANIFEST).read_text(encoding="utf-8"))
        _check(manifest)
    except KeyError as error:
        return Finding(where=MANIFEST, what=f"lacks {error}: it was emptied or cut")
    except (ValueError, TypeError, AttributeError) as error:
        return Finding(where=MANIFEST, what=f"cannot be read: {error}")
    return manifest


def _check(manifest: dict[str, Any]) -> None:
    """Raises what indexing and reading raise where something is missing or of another type."""
    read_recipe(manifest["recipe"])
    kind = manifest["format"]
    if kind not in FORMATS:
        raise ValueError(f"its format is {kind!r}, not one of {', '.join(FORMATS)}")
    for entry in manifest["shards"]:
        _ = {entry["file"]: [entry[key] for key in ("sha256", "split", "rows")]}
    numbers = [e[key] for e in manifest["shards"] for key in ("rows", "bytes")]
    if not all(type(number) is int for number in numbers):
        raise ValueError("rows and bytes of shards are whole numbers")
    dict(manifest["versions"])
    dict(manifest["files"])


def listed_files(out: Path, manifest: dict[str, Any]) -> list[ListedFile] | Finding:
    """Every file that a manifest lists, of folders one by one; the small ones that describe come first.

    Or the first that is not there, or that is none of this folder.
    """
    found = []
    for listed, digest in reversed(checksums(manifest).items()):
        path = out / listed
        if PurePosixPath(listed).is_absolute() or ".." in PurePosixPath(listed).parts:
            return Finding(where=MANIFEST, what=f"lists {listed}, which is no file of this folder")
        if not path.exists():
            return Finding(where=listed, what="is missing")
        for file in files_below(path):
            name, known = file.relative_to(out).as_posix(), digest if file == path else None
            found.append(ListedFile(name=name, path=file, size=file.stat().st_size, digest=known))
    return found
