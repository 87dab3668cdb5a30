"""Changes to a finished dataset by someone who keeps every checksum and size in step."""

from __future__ import annotations

import hashlib
import json
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from sideband_datasets.folder import verify
from sideband_datasets.folder.layout import json_text


def told(out: Path, **settings: Any) -> str:
    """Everything that is found, a line each."""
    return "\n".join(map(str, verify(out, **settings)))


def manifest_of(out: Path) -> dict[str, Any]:
    """The manifest."""
    found: dict[str, Any] = json.loads((out / "manifest.json").read_text())
    return found


def shards(out: Path, split: str) -> list[Path]:
    """Files of a split."""
    return sorted((out / "data").glob(f"{split}-*"))


def changed(table: Any, column: str, values: list[Any]) -> Any:
    """A table with other values in a column."""
    at = table.column_names.index(column)
    return table.set_column(at, table.schema.field(column), pa.array(values, table.schema.field(column).type))


def rewrite(out: Path, path: Path, table: Any) -> None:
    """Another table in a shard; manifest, card and Croissant say what they would of it."""
    pq.write_table(table, path)
    document, croissant = manifest_of(out), json.loads((out / "croissant.json").read_text())
    entry = next(e for e in document["shards"] if e["file"] == f"data/{path.name}")
    before, size = entry["sha256"], path.stat().st_size
    document["bytes"] += size - entry["bytes"]
    entry |= {"sha256": hashlib.sha256(path.read_bytes()).hexdigest(), "rows": table.num_rows, "bytes": size}
    listed = next(e for e in croissant["distribution"] if e["@id"] == path.name)
    listed |= {"sha256": entry["sha256"], "contentSize": f"{size} B"}
    card = (out / "README.md").read_text().replace(before, entry["sha256"])
    for name, text in (("README.md", card), ("croissant.json", json_text(croissant))):
        (out / name).write_text(text)
        document["files"][name] = hashlib.sha256(text.encode()).hexdigest()
    (out / "manifest.json").write_text(json_text(document))
