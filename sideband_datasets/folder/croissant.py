"""Croissant metadata (MLCommons, format version 1.0): files with checksums, columns with types and meanings."""

from __future__ import annotations

from collections.abc import Sequence

from sideband_datasets.folder.layout import DATA
from sideband_datasets.folder.shards import Receipt
from sideband_datasets.formats import FORMATS
from sideband_datasets.plan.plan import Plan
from sideband_datasets.recipe.read import identity
from sideband_datasets.row import COLUMNS, Column, Kind

CONFORMS_TO = "http://mlcommons.org/croissant/1.0"
CONTEXT: dict[str, object] = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "citeAs": "cr:citeAs",
    "column": "cr:column",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "equivalentProperty": "cr:equivalentProperty",
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "extract": "cr:extract",
    "field": "cr:field",
    "fileProperty": "cr:fileProperty",
    "fileObject": "cr:fileObject",
    "fileSet": "cr:fileSet",
    "format": "cr:format",
    "includes": "cr:includes",
    "isLiveDataset": "cr:isLiveDataset",
    "jsonPath": "cr:jsonPath",
    "key": "cr:key",
    "md5": "cr:md5",
    "parentField": "cr:parentField",
    "path": "cr:path",
    "recordSet": "cr:recordSet",
    "references": "cr:references",
    "regex": "cr:regex",
    "repeated": "cr:repeated",
    "replace": "cr:replace",
    "samplingRate": "cr:samplingRate",
    "sc": "https://schema.org/",
    "separator": "cr:separator",
    "source": "cr:source",
    "subField": "cr:subField",
    "transform": "cr:transform",
}
TYPES: dict[Kind, str] = {
    "text": "sc:Text",
    "whole": "sc:Integer",
    "number": "sc:Float",
    "truth": "sc:Boolean",
    "texts": "sc:Text",
    "numbers": "sc:Float",
    "signal": "sc:Float",
}
"""Of columns by kind; peaks, objects in a list, have a field for each key."""
PEAK: dict[str, Kind] = {
    "label": "text",
    "frequency_hz": "number",
    "amplitude": "number",
    "status": "text",
    "component": "text",
    "spectrum": "text",
}
REPEATED = ("texts", "numbers", "signal", "peaks")
SHARDS, ROWS = "shards", "rows"


def croissant(plan: Plan, receipts: Sequence[Receipt], kind: str) -> dict[str, object]:
    """The document as JSON-LD. Columns are described where they can be read by name: in Parquet."""
    recipe = plan.recipe
    media = FORMATS[kind].media_type
    shards: list[dict[str, object]] = [
        {
            "@type": "cr:FileObject",
            "@id": receipt.name,
            "name": receipt.name,
            "contentUrl": f"{DATA}/{receipt.name}",
            "contentSize": f"{receipt.bytes} B",
            "encodingFormat": media,
            "sha256": receipt.sha256,
        }
        for receipt in receipts
    ]
    document: dict[str, object] = {
        "@context": CONTEXT,
        "@type": "sc:Dataset",
        "conformsTo": CONFORMS_TO,
        "name": recipe.name,
        "description": recipe.notes or f"Simulated, labelled vibration: {', '.join(recipe.classes)}.",
        "license": f"https://spdx.org/licenses/{recipe.licence}.html",
        "version": "1.0.0",
        "citeAs": f"{recipe.author or 'the maker of this dataset'}: {recipe.name}, recipe {identity(recipe)[:16]}",
        "distribution": shards,
    }
    if kind == "parquet":
        every = {
            "@type": "cr:FileSet",
            "@id": SHARDS,
            "name": SHARDS,
            "description": "All shards; each is listed with its checksum besides.",
            "encodingFormat": media,
            "includes": f"{DATA}/*{FORMATS[kind].suffix}",
        }
        document["distribution"] = [every, *shards]
        fields = [_field(column) for column in COLUMNS]
        document["recordSet"] = [{"@type": "cr:RecordSet", "@id": ROWS, "name": ROWS, "field": fields}]
    return document


def _field(column: Column) -> dict[str, object]:
    unit = f" Unit: {column.unit}." if column.unit else ""
    at = f"{ROWS}/{column.name}"
    found: dict[str, object] = {"@type": "cr:Field", "@id": at, "name": column.name}
    found["description"] = column.sentence + unit
    if column.kind == "peaks":
        found["subField"] = [_key(at, column.name, key, kind) for key, kind in PEAK.items()]
    else:
        found |= {"dataType": TYPES[column.kind], "source": _source(column.name)}
    if column.kind in REPEATED:
        found["repeated"] = True
    return found


def _key(at: str, column: str, key: str, kind: Kind) -> dict[str, object]:
    """A key of the objects in a column."""
    source = _source(column) | {"transform": {"jsonPath": key}}
    return {"@type": "cr:Field", "@id": f"{at}/{key}", "name": key, "dataType": TYPES[kind], "source": source}


def _source(column: str) -> dict[str, object]:
    return {"fileSet": {"@id": SHARDS}, "extract": {"column": column}}
